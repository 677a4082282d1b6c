#include "host/scene/scene_keys.hpp"

namespace stokes {
namespace keys {

const ObjectKeys scene{
    "scene",
    {"format", "version", "camera", "materials", "lights"},
    {"$schema", "comment", "transport", "render", "film", "spectra", "media", "fluorophores", "shapes"}};
const ObjectKeys render{"render",
                        {},
                        {"passes", "photons_per_pass", "alpha", "radius_mm", "seed", "lambda_min_nm", "lambda_max_nm",
                         "sampling", "wavelengths", "branches", "distances", "exits", "emission", "direct", "radii"}};
const ObjectKeys film{"film", {}, {"width", "height", "exposure_ev"}};
const ObjectKeys camera{"camera", {"position_mm", "target_mm"}, {"up", "vertical_fov_deg", "crop"}};
const ObjectKeys crop{"crop", {"left", "top", "width", "height"}, {}};

const ObjectKeys spectrum_file{"spectrum_file", {"file", "column"}, {"scale", "outside"}};
const ObjectKeys spectrum_illuminant{"spectrum_illuminant", {"illuminant"}, {}};
const ObjectKeys spectrum_pairs{"spectrum_pairs", {"pairs"}, {"outside"}};
const ObjectKeys spectrum_constant{"spectrum_constant", {"constant"}, {}};

const ObjectKeys medium{
    "medium", {"sigma_s_per_mm", "sigma_a_per_mm"}, {"scale_sigma_s", "scale_sigma_a", "eta", "dipole_eta"}};
const ObjectKeys fluorophore{"fluorophore", {"excitation", "emission"}, {"conversion_per_nm", "quantum_yield"}};

const ObjectKeys reflectance_texture{"reflectance_texture", {"texture", "black", "white"}, {}};
const ObjectKeys material_diffuse{"material_diffuse", {"type", "reflectance"}, {}};
const ObjectKeys material_black{"material_black", {"type"}, {}};
const ObjectKeys material_translucent{
    "material_translucent",
    {"type"},
    {"medium", "fluorophore", "fluorescent_fraction", "fluorophores", "subsurface", "fresnel"}};
const ObjectKeys dye{"dye", {"fluorophore", "fraction"}, {}};

const ObjectKeys beam_disk{
    "beam_disk", {"type", "section", "position_mm", "direction", "radius_mm", "spectrum", "irradiance_W_m2"}, {"name"}};
const ObjectKeys beam_rectangle{
    "beam_rectangle",
    {"type", "section", "position_mm", "direction", "width_mm", "height_mm", "spectrum", "irradiance_W_m2"},
    {"name", "up"}};
const ObjectKeys emitter_rectangle{
    "emitter_rectangle",
    {"type", "center_mm", "normal", "width_mm", "height_mm", "spectrum"},
    {"name", "up", "power_W", "radiance_W_m2_sr", "radiance_scale_W_m2_sr_nm", "material"}};
const ObjectKeys emitter_disk{"emitter_disk",
                              {"type", "center_mm", "normal", "radius_mm", "spectrum"},
                              {"name", "power_W", "radiance_W_m2_sr", "radiance_scale_W_m2_sr_nm", "material"}};
const ObjectKeys emitter_sphere{"emitter_sphere",
                                {"type", "center_mm", "radius_mm", "spectrum"},
                                {"name", "power_W", "radiance_W_m2_sr", "radiance_scale_W_m2_sr_nm", "material"}};

const ObjectKeys shape_mesh{"shape_mesh", {"type", "material", "file"}, {"name", "body", "transform"}};
const ObjectKeys shape_box{"shape_box", {"type", "material", "size_mm"}, {"name", "body", "transform"}};
const ObjectKeys shape_sphere{
    "shape_sphere", {"type", "material", "radius_mm"}, {"name", "body", "transform", "segments"}};
const ObjectKeys shape_rectangle{
    "shape_rectangle", {"type", "material", "width_mm", "height_mm"}, {"name", "body", "transform"}};
const ObjectKeys shape_disk{"shape_disk", {"type", "material", "radius_mm"}, {"name", "body", "transform", "segments"}};
const ObjectKeys shape_prism{
    "shape_prism", {"type", "material", "sides", "radius_mm", "height_mm"}, {"name", "body", "transform"}};
const ObjectKeys shape_cylinder{
    "shape_cylinder", {"type", "material", "radius_mm", "height_mm"}, {"name", "body", "transform", "segments"}};
const ObjectKeys shape_mask{"shape_mask",
                            {"type", "material", "width_mm", "height_mm", "file"},
                            {"name", "body", "transform", "threshold", "invert"}};
const ObjectKeys shape_tiles{"shape_tiles", {"type", "materials", "columns", "rows", "size_mm"}, {"name", "transform"}};
const ObjectKeys shape_sectors{
    "shape_sectors", {"type", "materials", "radius_mm", "height_mm"}, {"name", "transform", "segments", "start_deg"}};

const ObjectKeys transform_scale{"transform_scale", {"scale"}, {}};
const ObjectKeys transform_rotate{"transform_rotate", {"rotate_axis", "angle_deg"}, {}};
const ObjectKeys transform_translate{"transform_translate", {"translate_mm"}, {}};

}  // namespace keys

std::vector<ObjectKeys> all_object_keys() {
    using namespace keys;
    return {scene,
            render,
            film,
            camera,
            crop,
            spectrum_file,
            spectrum_illuminant,
            spectrum_pairs,
            spectrum_constant,
            medium,
            fluorophore,
            reflectance_texture,
            material_diffuse,
            material_black,
            material_translucent,
            dye,
            beam_disk,
            beam_rectangle,
            emitter_rectangle,
            emitter_disk,
            emitter_sphere,
            shape_mesh,
            shape_box,
            shape_sphere,
            shape_rectangle,
            shape_disk,
            shape_prism,
            shape_cylinder,
            shape_mask,
            shape_tiles,
            shape_sectors,
            transform_scale,
            transform_rotate,
            transform_translate};
}

}  // namespace stokes
