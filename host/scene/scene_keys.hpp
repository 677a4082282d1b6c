// The keys of every kind of object in a scene file. The readers check against these lists, and a test holds
// scenes/scene.schema.json to them.
#pragma once

#include <string>
#include <vector>

namespace stokes {

struct ObjectKeys {
    std::string kind;  // the object's name under $defs of the schema
    std::vector<std::string> required;
    std::vector<std::string> optional;
};

namespace keys {

extern const ObjectKeys scene, render, film, camera, crop;
extern const ObjectKeys spectrum_file, spectrum_illuminant, spectrum_pairs, spectrum_constant;
extern const ObjectKeys medium, fluorophore;
extern const ObjectKeys reflectance_texture;
extern const ObjectKeys material_diffuse, material_black, material_translucent, dye;
extern const ObjectKeys beam_disk, beam_rectangle, emitter_rectangle, emitter_disk, emitter_sphere;
extern const ObjectKeys shape_mesh, shape_box, shape_sphere, shape_rectangle, shape_disk, shape_prism, shape_cylinder,
    shape_mask, shape_tiles, shape_sectors;
extern const ObjectKeys transform_scale, transform_rotate, transform_translate;

}  // namespace keys

// Every list above.
std::vector<ObjectKeys> all_object_keys();

}  // namespace stokes
