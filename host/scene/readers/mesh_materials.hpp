// Materials that a mesh file names, and what the scene makes of them.
#pragma once

#include <string>
#include <vector>

#include "host/scene/mesh/file_mesh.hpp"
#include "host/scene/scene.hpp"
#include "host/scene/settings/object.hpp"

namespace stokes {

struct MaterialPart {
    FileMesh mesh;
    int material = -1;  // index into Scene::materials
    int body = -1;
};

// By the key "materials" of the shape: the mesh's parts of each of the scene's materials, and new bodies for them.
// Throws InputError where the key and the file do not fit.
std::vector<MaterialPart> read_material_parts(const ObjectReader& where, const FileMesh& mesh, Scene& scene);

// Warns of materials and objects of a file that a shape of one material does not tell apart.
void warn_of_one_material(const ObjectReader& where, const std::string& name, const FileMesh& mesh,
                          const Material& material);

}  // namespace stokes
