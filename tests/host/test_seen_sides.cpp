// What `stokes render` says of meshes that show the camera their back, which is black. The camera looks down at boxes
// from a corner, whose faces it sees all look up or towards it; where they go round the other way, all of what it sees
// is back.
#include <nlohmann/json.hpp>

#include "host/render/seen_sides.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;
using Json = nlohmann::ordered_json;

namespace {

// Of a cube of 30 mm, without its lid (y = 15) where open; inward: turned over.
std::string box_obj(bool inward, bool open) {
    const std::string corners =
        "v -15 -15 -15\nv 15 -15 -15\nv 15 15 -15\nv -15 15 -15\nv -15 -15 15\nv 15 -15 15\nv 15 15 15\nv -15 15 15\n";
    std::string faces = inward ? "f 2 3 4 1\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 4 8 5 1\n"
                               : "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 1 5 8 4\n";
    if (!open) faces += inward ? "f 7 8 4 3\n" : "f 3 4 8 7\n";
    return corners + faces;
}

std::string told_of(const std::string& obj, const std::string& material, bool below = false) {
    const TemporaryFolder folder;
    put_file(folder.file("m.obj"), obj);
    Json scene = Json::parse(R"({
        "format": "stokes-scene", "version": 1,
        "camera": {"position_mm": [60, 90, 80], "target_mm": [0, 0, 0]},
        "media": {"milk": {"sigma_s_per_mm": 1.5, "sigma_a_per_mm": 0.05, "eta": 1.33}},
        "materials": {"white": {"type": "diffuse", "reflectance": 0.8}, "black": {"type": "black"},
                      "milk": {"type": "translucent", "medium": "milk"}},
        "lights": [{"type": "beam", "section": "disk", "position_mm": [0, 200, 0], "direction": [0, -1, 0],
                    "radius_mm": 60, "irradiance_W_m2": 10, "spectrum": {"illuminant": "D65"}}],
        "shapes": [{"type": "rectangle", "width_mm": 300, "height_mm": 300, "material": "white",
                    "transform": [{"translate_mm": [0, -20, 0]}]},
                   {"type": "mesh", "name": "thing", "file": "m.obj"}]})");
    scene["shapes"][1]["material"] = material;
    if (below) scene["camera"]["position_mm"] = {60, -190, 80};
    put_file(folder.file("s.json"), scene.dump());
    const Outcome run = run_stokes("render " + folder.file("s.json") + " -o " + folder.file("s.exr") +
                                   " --size 32x24 --passes 1 --photons 500 --sampling plain --quiet");
    CHECK(run.code == 0);
    return run.err;
}

const std::string told = "shape \"thing\": 100 % of what the camera sees of it is its back, which is black";

}  // namespace

// Closed but for a gap of 1e-5 mm at a corner: nothing can be said of its inside, but of what is seen.
TEST_CASE("a mesh inside out that is not closed is told", "[seen_sides]") {
    CHECK_THAT(told_of(box_obj(true, true), "white"), Contains("stokes: warning: shape \"thing\"") && Contains("back"));
    std::string loose = box_obj(true, false) + "v -15.00001 15 15\n";
    loose.replace(loose.find("f 8 7 6 5"), 9, "f 9 7 6 5");
    CHECK_THAT(told_of(loose, "white"), Contains(told));
    loose = box_obj(false, false) + "v -15.00001 15 15\n";
    loose.replace(loose.find("f 5 6 7 8"), 9, "f 5 6 7 9");
    CHECK_THAT(told_of(loose, "white"), !Contains("its back"));
}

TEST_CASE("a built-in shape seen from behind is told, a black or two-sided one not", "[seen_sides]") {
    CHECK_THAT(told_of(box_obj(false, false), "white", true),
               Contains("shape \"shape 0\": 100 % of what the camera sees of it is its back"));
    const std::string sheet = "v -15 0 -15\nv 15 0 -15\nv 15 0 15\nv -15 0 15\nf 1 2 3 4\n";
    CHECK_THAT(told_of(sheet, "white"), Contains(told));
    CHECK_THAT(told_of(sheet, "black"), !Contains(told));
    CHECK_THAT(told_of(sheet + "f 4 3 2 1\n", "white"), !Contains(told) && Contains("look alike from both sides"));
}

// A fifth or more is told, of four rays at least; the most seen first, and four lines for single shapes.
TEST_CASE("shares of black backs are told from a fifth on", "[seen_sides]") {
    Scene scene;
    scene.materials = {{"white", DiffuseMaterial{}}, {"black", BlackMaterial{}}};
    for (int i = 0; i < 9; ++i) {
        Shape shape;
        shape.name = std::string(1, static_cast<char>('a' + i));
        shape.material = i == 8 ? 1 : 0;
        shape.two_sided = i == 7;
        scene.shapes.push_back(shape);
    }
    std::vector<SeenSides> sides(9);
    CHECK(black_back_lines(scene, sides).empty());
    sides[0] = {80, 20};
    sides[1] = {81, 19};
    sides[2] = {0, 3};
    sides[3] = {0, 400};
    sides[7] = sides[8] = {0, 100};
    scene.shapes[6].light = 0;
    sides[6] = {0, 100};
    const std::vector<std::string> two = black_back_lines(scene, sides);
    REQUIRE(two.size() == 2);
    CHECK_THAT(two[0], Contains("shape \"d\": 100 %"));
    CHECK_THAT(two[1], Contains("shape \"a\": 20 %"));
    scene.shapes[6].light = -1;
    for (std::size_t i = 0; i < 7; ++i) sides[i] = {0, 10};
    const std::vector<std::string> many = black_back_lines(scene, sides);
    REQUIRE(many.size() == 5);
    CHECK(many[4] == "the camera sees the black back of 3 more shapes");
}
