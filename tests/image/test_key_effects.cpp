// Every key of a scene changes the picture where it is changed, or a warning says that it does not.
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "host/render/ignored_keys.hpp"
#include "host/render/renderer.hpp"
#include "host/scene/readers/scene_reader.hpp"
#include "host/scene/settings/objects.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/paths.hpp"

using namespace stokes;
using Json = nlohmann::ordered_json;

namespace {

// tests/image/kinds.json holds every kind of object but these.
Json base() {
    Json scene = Json::parse(std::ifstream(source_path("tests/image/kinds.json")));
    scene["film"] = {{"width", 20}, {"height", 15}};
    scene["render"] = {{"photons_per_pass", 1500}, {"sampling", "plain"}, {"radius_mm", 6}, {"seed", 3}};
    scene["shapes"][7]["material"] = "grey";
    scene["lights"][3]["material"] = "black";
    scene["materials"]["soap"] = scene["materials"]["wax"];
    scene["spectra"]["scaled"] = {{"constant", 0.5}};
    scene["shapes"].push_back({{"type", "prism"},
                               {"sides", 5},
                               {"radius_mm", 6},
                               {"height_mm", 9},
                               {"material", "soap"},
                               {"transform", Json::array({{{"rotate_axis", {0, 1, 0}}, {"angle_deg", 20}},
                                                          {{"scale", 1.1}},
                                                          {{"translate_mm", {-12, 0.3, 32}}}})}});
    scene["shapes"].push_back({{"type", "sectors"},
                               {"materials", {"wax", "glossy milk"}},
                               {"radius_mm", 6},
                               {"height_mm", 8},
                               {"transform", Json::array({{{"translate_mm", {25, 0.3, 20}}}})}});
    return scene;
}

std::vector<float> picture(const Json& json, std::vector<std::string>& warnings) {
    const Scene scene = parse_scene(json.dump(), source_path("tests/image/kinds.json"));
    warnings = ignored_keys(scene);
    Renderer renderer(test_device(), scene);
    for (std::uint32_t pass = 0; pass < 1; ++pass) renderer.render_pass(pass);
    std::vector<float> values;
    for (const std::vector<float>& layer : renderer.image().xyz)
        values.insert(values.end(), layer.begin(), layer.end());
    return values;
}

// A place in the scene and another value for it; object, key: as declared.
struct Change {
    std::string object, key, place;
    Json value;
};

const std::vector<Change> changes = {
    {"camera", "position_mm", "/camera/position_mm/0", 10},
    {"camera", "target_mm", "/camera/target_mm/1", 12},
    {"camera", "up", "/camera/up", {0.2, 1, 0}},
    {"camera", "vertical_fov_deg", "/camera/vertical_fov_deg", 30},
    {"camera", "crop", "/camera/crop", {{"left", 0.2}, {"top", 0.1}, {"width", 0.7}, {"height", 0.9}}},
    {"medium", "sigma_s_per_mm", "/media/milk/sigma_s_per_mm", 2},
    {"medium", "sigma_a_per_mm", "/media/milk/sigma_a_per_mm", 0.3},
    {"medium", "scale_sigma_s", "/media/wax/scale_sigma_s", 0.4},
    {"medium", "scale_sigma_a", "/media/wax/scale_sigma_a", 20},
    {"medium", "eta", "/media/wax/eta", 1.33},
    {"medium", "dipole_eta", "/media/wax/dipole_eta", 1.5},
    {"fluorophore", "excitation", "/fluorophores/blue/excitation", 1},
    {"fluorophore", "emission", "/fluorophores/blue/emission", 1},
    {"fluorophore", "stokes_rule", "/fluorophores/blue/stokes_rule", "keep_yield"},
    {"fluorophore", "conversion_per_nm", "/fluorophores/blue/conversion_per_nm", 0.001},
    {"fluorophore", "quantum_yield", "/fluorophores/blue/quantum_yield", 0.1},
    {"material_diffuse", "reflectance", "/materials/grey/reflectance", 0.9},
    {"material_translucent", "medium", "/materials/wax/medium", "milk"},
    {"material_translucent", "fluorophore", "/materials/wax/fluorophore", "orange"},
    {"material_translucent", "fluorescent_fraction", "/materials/wax/fluorescent_fraction", 0.1},
    {"material_translucent", "fluorophores", "/materials/plain wax/fluorophores",
     Json::array({{{"fluorophore", "blue"}, {"fraction", 0.5}}})},
    {"material_translucent", "subsurface", "/materials/soap/subsurface", false},
    {"material_translucent", "fresnel", "/materials/wax/fresnel", true},
    {"reflectance_texture", "texture", "/materials/chart/reflectance/texture", "../../scenes/textures/cat.png"},
    {"reflectance_texture", "black", "/materials/chart/reflectance/black", 0.5},
    {"reflectance_texture", "white", "/materials/chart/reflectance/white", 0.5},
    {"beam_disk", "position_mm", "/lights/0/position_mm/0", -25},
    {"beam_disk", "direction", "/lights/0/direction/0", 0.4},
    {"beam_disk", "radius_mm", "/lights/0/radius_mm", 20},
    {"beam_disk", "spectrum", "/lights/0/spectrum", {{"illuminant", "D65"}}},
    {"beam_disk", "irradiance_W_m2", "/lights/0/irradiance_W_m2", 40},
    {"beam_rectangle", "position_mm", "/lights/1/position_mm/0", 30},
    {"beam_rectangle", "direction", "/lights/1/direction/0", -0.3},
    {"beam_rectangle", "width_mm", "/lights/1/width_mm", 40},
    {"beam_rectangle", "height_mm", "/lights/1/height_mm", 20},
    {"beam_rectangle", "up", "/lights/1/up", {0, 1, 1}},
    {"beam_rectangle", "spectrum", "/lights/1/spectrum", {{"illuminant", "D65"}}},
    {"beam_rectangle", "irradiance_W_m2", "/lights/1/irradiance_W_m2", 40},
    {"emitter_rectangle", "center_mm", "/lights/2/center_mm/1", 60},
    {"emitter_rectangle", "normal", "/lights/2/normal/2", 0.1},
    {"emitter_rectangle", "up", "/lights/2/up", {1, 0, 1}},
    {"emitter_rectangle", "width_mm", "/lights/2/width_mm", 60},
    {"emitter_rectangle", "height_mm", "/lights/2/height_mm", 20},
    {"emitter_rectangle", "spectrum", "/lights/2/spectrum", {{"illuminant", "A"}}},
    {"emitter_rectangle", "radiance_W_m2_sr", "/lights/2/radiance_W_m2_sr", 8},
    {"emitter_disk", "center_mm", "/lights/3/center_mm/1", 25},
    {"emitter_disk", "normal", "/lights/3/normal/2", 0},
    {"emitter_disk", "radius_mm", "/lights/3/radius_mm", 6},
    {"emitter_disk", "spectrum", "/lights/3/spectrum", {{"illuminant", "A"}}},
    {"emitter_disk", "power_W", "/lights/3/power_W", 0.1},
    {"emitter_sphere", "center_mm", "/lights/4/center_mm/1", 20},
    {"emitter_sphere", "radius_mm", "/lights/4/radius_mm", 6},
    {"emitter_sphere", "spectrum", "/lights/4/spectrum", {{"illuminant", "A"}}},
    {"emitter_sphere", "power_W", "/lights/4/power_W", 0.1},
    {"emitter_sphere", "material", "/lights/4/material", "black"},
    {"shape_rectangle", "material", "/shapes/0/material", "grey"},
    {"shape_rectangle", "width_mm", "/shapes/0/width_mm", 60},
    {"shape_rectangle", "height_mm", "/shapes/0/height_mm", 60},
    {"shape_sphere", "radius_mm", "/shapes/1/radius_mm", 8},
    {"shape_sphere", "segments", "/shapes/1/segments", 6},
    {"shape_box", "size_mm", "/shapes/2/size_mm/1", 20},
    {"shape_disk", "radius_mm", "/shapes/4/radius_mm", 4},
    {"shape_disk", "segments", "/shapes/4/segments", 4},
    {"shape_mask", "file", "/shapes/5/file", "../../scenes/textures/star.png"},
    {"shape_mask", "invert", "/shapes/5/invert", true},
    {"shape_mask", "width_mm", "/shapes/5/width_mm", 10},
    {"shape_mask", "height_mm", "/shapes/5/height_mm", 10},
    {"shape_tiles", "materials", "/shapes/6/materials/0", "plain wax"},
    {"shape_tiles", "columns", "/shapes/6/columns", 1},
    {"shape_tiles", "rows", "/shapes/6/rows", 1},
    {"shape_tiles", "size_mm", "/shapes/6/size_mm/1", 9},
    {"shape_cylinder", "radius_mm", "/shapes/7/radius_mm", 6},
    {"shape_cylinder", "height_mm", "/shapes/7/height_mm", 40},
    {"shape_cylinder", "segments", "/shapes/7/segments", 4},
    {"shape_prism", "sides", "/shapes/8/sides", 3},
    {"shape_prism", "radius_mm", "/shapes/8/radius_mm", 8},
    {"shape_prism", "height_mm", "/shapes/8/height_mm", 14},
    {"transform_rotate", "rotate_axis", "/shapes/8/transform/0/rotate_axis", {0, 1, 1}},
    {"transform_rotate", "angle_deg", "/shapes/8/transform/0/angle_deg", 50},
    {"transform_scale", "scale", "/shapes/8/transform/1/scale", 1.6},
    {"transform_translate", "translate_mm", "/shapes/8/transform/2/translate_mm/1", 5},
    {"shape_sectors", "start_deg", "/shapes/9/start_deg", 70},
    {"shape_sectors", "radius_mm", "/shapes/9/radius_mm", 8},
    {"shape_sectors", "height_mm", "/shapes/9/height_mm", 14},
    {"shape_sectors", "segments", "/shapes/9/segments", 4},
    {"shape_sectors", "materials", "/shapes/9/materials/0", "plain wax"},
};

// Keys that are tested elsewhere, or mean the same as in another object: names and words, files, amounts of lights, and
// the threshold of a mask, whose picture here is black and white.
const std::set<std::string> not_here = {"type",
                                        "wrap",
                                        "section",
                                        "name",
                                        "transform",
                                        "body",
                                        "material",
                                        "file",
                                        "radiance_W_m2_sr",
                                        "radiance_scale_W_m2_sr_nm",
                                        "power_W",
                                        "threshold"};

bool is_physical(const std::string& object) {
    for (const char* prefix : {"beam_", "emitter_", "shape_", "transform_", "material_"})
        if (object.rfind(prefix, 0) == 0) return object != "shape_mesh";
    return object == "medium" || object == "fluorophore" || object == "reflectance_texture" || object == "camera";
}

// The key's warning names it: "transport "walk" ignores dipole_eta of ..".
bool says(const std::vector<std::string>& warnings, const std::string& key) {
    return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& line) {
        return line.find(" ignores " + key + " of ") != std::string::npos;
    });
}

}  // namespace

TEST_CASE("every declared key of what a scene shows is changed here", "[key_effects]") {
    std::set<std::pair<std::string, std::string>> here;
    for (const Change& change : changes) here.insert({change.object, change.key});
    for (const ObjectDeclaration& object : scene_objects()) {
        if (!is_physical(object.kind)) continue;
        for (const Key& key : object.keys) {
            CAPTURE(object.kind, key.name);
            CHECK((not_here.count(key.name) != 0 || here.count({object.kind, key.name}) != 0));
        }
    }
}

namespace {

// Of media, fluorophores and translucent materials, which transports take or leave; or of all else.
void check_effects(Transport transport, bool inside) {
    Json scene = base();
    scene["transport"] = word_of(transport);
    std::vector<std::string> warnings;
    const std::vector<float> before = picture(scene, warnings);
    for (const Change& change : changes) {
        const bool is_inside =
            change.object == "medium" || change.object == "fluorophore" || change.object == "material_translucent";
        if (is_inside != inside) continue;
        Json changed = scene;
        changed[Json::json_pointer(change.place)] = change.value;
        if (change.key == "stokes_rule" && transport != Transport::paper)  // the others keep the yield by default
            changed[Json::json_pointer(change.place)] = "truncate";
        CAPTURE(word_of(transport), change.place);
        const bool same = picture(changed, warnings) == before;
        CHECK(same == says(warnings, change.key));
    }
}

}  // namespace

TEST_CASE("a key of what is below surfaces changes the picture, or a warning says that it does not", "[key_effects]") {
    for (const Transport transport : {Transport::conserving, Transport::paper, Transport::walk})
        check_effects(transport, true);
}

TEST_CASE("every other key changes the picture", "[key_effects][.long]") {
    check_effects(Transport::conserving, false);
}

// Both keys of one dye serve both kinds of transports; where the yield is left out it follows from the other.
TEST_CASE("a key is said to be ignored where it differs from its default and nothing takes it", "[key_effects]") {
    Json scene = base();
    const auto lines = [&] { return ignored_keys(parse_scene(scene.dump(), source_path("tests/image/kinds.json"))); };
    CHECK(lines().empty());
    scene["media"]["wax"]["dipole_eta"] = 1;
    CHECK(lines().empty());
    scene["fluorophores"]["blue"]["conversion_per_nm"] = 0.01;
    REQUIRE(lines().size() == 1);
    CHECK_THAT(lines().front(), Catch::Matchers::EndsWith("fluorophores: transport \"conserving\" ignores "
                                                          "conversion_per_nm of \"blue\""));
    scene["fluorophores"]["blue"].erase("quantum_yield");
    CHECK(lines().empty());
}

TEST_CASE("what nothing uses is noted", "[key_effects]") {
    Json scene = base();
    const auto line = [&] { return unused_objects(parse_scene(scene.dump(), source_path("tests/image/kinds.json"))); };
    CHECK_THAT(line(), Catch::Matchers::EndsWith("nothing in the picture uses spectra \"scaled\""));
    scene["spectra"].erase("scaled");
    CHECK(line().empty());
    scene["materials"]["spare"] = {{"type", "black"}};
    scene["media"]["fog"] = {{"sigma_s_per_mm", 1}, {"sigma_a_per_mm", 1}};
    CHECK_THAT(line(), Catch::Matchers::EndsWith("nothing in the picture uses materials \"spare\"; media \"fog\""));
}
