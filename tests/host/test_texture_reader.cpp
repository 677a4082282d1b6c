#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/png_bytes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

// Line 3: the material; line 5: the shape that has it.
std::string scene_text(const std::string& reflectance, const std::string& shape) {
    return R"({"format": "stokes-scene", "version": 1, "camera": {"position_mm": [0, 9, 9], "target_mm": [0, 0, 0]},
"materials": {"plain": {"type": "diffuse", "reflectance": 0.5}, "wall": {"type": "diffuse", "reflectance":
)" + reflectance +
           R"(}}, "lights": [{"type": "sphere", "center_mm": [0, 9, 0], "radius_mm": 1, "spectrum": 1, "power_W": 1}],
"shapes": [{"type": "rectangle", "width_mm": 1, "height_mm": 1, "material": "plain"},
)" + shape +
           "]}";
}

const std::string good = R"({"texture": "t.png", "black": 0.1, "white": {"pairs": [[300, 0.5], [400, 1]]}})";
const std::string rectangle = R"({"type": "rectangle", "width_mm": 3, "height_mm": 2, "material": "wall"})";

struct Folder : TemporaryFolder {
    Folder() {
        put_file(file("t.png"), png_bytes(2, {std::string("\xff\x80\0\0", 4)}, {PNG_COLOR_TYPE_GRAY_ALPHA}));
        put_file(file("bad.png"), "no PNG");
        put_file(file("plain.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        put_file(file("uv.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    }
    Scene scene(const std::string& reflectance, const std::string& shape) const {
        return parse_scene(scene_text(reflectance, shape), file("s.json"));
    }
    std::string error(const std::string& reflectance, const std::string& shape = rectangle) const {
        const std::string text = input_error([&] { scene(reflectance, shape); });
        return text.empty() ? text : text.substr(path().size() + 1);
    }
};

}  // namespace

TEST_CASE("A texture is read with its two spectra; transparent parts are as on white paper") {
    const Folder folder;
    const Scene scene = folder.scene(good, rectangle);
    const auto& wall = std::get<DiffuseMaterial>(scene.materials[1].kind);
    REQUIRE(wall.texture);
    CHECK(wall.reflectance.at(500) == 0.1);
    CHECK(wall.white.at(350) == Approx(0.75));
    CHECK(wall.texture->luminance == std::vector<float>{1.0f, 1.0f});
    CHECK(wall.texture->opacity.empty());
    CHECK(texture_of(scene.materials[0]) == nullptr);
    CHECK(scene.shapes[0].mesh.uv.empty());
    CHECK(scene.shapes[1].mesh.uv.size() == 2);
}

TEST_CASE("A texture needs a shape with coordinates") {
    const Folder folder;
    const std::string end = ", \"material\": \"wall\"}";
    CHECK(folder.error(good, R"({"type": "disk", "radius_mm": 3)" + end).empty());
    CHECK(folder.error(good, R"({"type": "mesh", "file": "uv.obj")" + end).empty());
    for (const char* shape : {R"({"type": "mesh", "file": "plain.obj")", R"({"type": "sphere", "radius_mm": 3)",
                              R"({"type": "box", "size_mm": [1, 1, 1])",
                              R"({"type": "prism", "sides": 5, "radius_mm": 1, "height_mm": 1)"}) {
        INFO(shape);
        CHECK(folder.error(good, shape + end) ==
              "s.json:5: shapes[1]: the texture of material \"wall\" needs a shape with coordinates: a "
              "rectangle, a disk or "
              "a mesh with texture coordinates");
    }
}

// Rectangles lie within their picture, and do not blend its edges.
TEST_CASE("Textures of meshes repeat, unless they are clamped; coordinates keep the place in the picture") {
    const Folder folder;
    put_file(folder.file("tile.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 7.1 -2.75\nvt 8 -2\nvt 7 -3\nf 1/1 2/2 3/3\n");
    const std::string mesh = R"({"type": "mesh", "file": "tile.obj", "material": "wall"})";
    const std::string clamped = R"({"texture": "t.png", "black": 0, "white": 1, "wrap": "clamp"})";
    CHECK_FALSE(folder.scene(good, rectangle).shapes[1].texture_repeats);
    const Scene repeated = folder.scene(good, mesh);
    CHECK(repeated.shapes[1].texture_repeats);
    const auto& uv = repeated.shapes[1].mesh.uv[0];  // v from the top: 3.75, 3 and 4, less 3
    CHECK(uv[0].x == Approx(0.1f).epsilon(1e-6));
    CHECK(uv[0].y == 0.75f);
    CHECK(uv[1] == glm::vec2(1, 0));
    CHECK(uv[2] == glm::vec2(0, 1));
    const Scene ends = folder.scene(clamped, mesh);
    CHECK_FALSE(ends.shapes[1].texture_repeats);
    CHECK(ends.shapes[1].mesh.uv[0][1] == glm::vec2(8, 3));
}

TEST_CASE("Mistakes in textures are named") {
    const Folder folder;
    CHECK(folder.error(R"({"texture": "t.png", "black": 0.1})") ==
          "s.json:3: materials.wall.reflectance: missing key \"white\"");
    CHECK_THAT(folder.error(R"({"texture": "t.png", "black": 0, "wite": 1})"),
               Contains("s.json:3: materials.wall.reflectance: unknown key \"wite\"; did you mean \"white\"?"));
    CHECK_THAT(folder.error(R"({"texture": "t.png", "black": 0, "white": 1.5})"),
               Contains("s.json:3: materials.wall.reflectance.white: expected"));
    CHECK_THAT(folder.error(R"({"texture": "bad.png", "black": 0, "white": 1})"),
               Contains("s.json:3: materials.wall.reflectance.texture: ") && Contains("bad.png: not a PNG file"));
    CHECK_THAT(folder.error(R"({"texture": "no.png", "black": 0, "white": 1})"), Contains("no.png: cannot read"));
    CHECK_THAT(folder.error(R"({"texture": 5, "black": 0, "white": 1})"), Contains("expected a string, got 5"));
    CHECK_THAT(folder.error(R"({"texture": "t.png", "black": 0, "white": 1, "wrap": "mirror"})"),
               Contains("reflectance.wrap: expected \"repeat\" or \"clamp\", got \"mirror\""));
    for (const char* name : {"wood.<UDIM>.png", "wood_%(UDIM)d.png", "wood.<UVTILE>.png"}) {
        INFO(name);
        CHECK_THAT(folder.error(R"({"texture": ")" + std::string(name) + R"(", "black": 0, "white": 1})"),
                   Contains("expected one PNG file, got a name for UDIM tiles, which are not read"));
    }
}
