// The picture of a thing does not depend on how its mesh is written, or how far from the origin all of it stands.
#include <array>
#include <cstdio>

#include "host/image/compare.hpp"
#include "host/render/renderer.hpp"
#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/png_bytes.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;

namespace {

using Place = std::array<double, 3>;

std::string vector_text(const Place& v, const Place& by) {
    std::string text = "[";
    for (std::size_t i = 0; i < 3; ++i) {
        char number[40];
        std::snprintf(number, sizeof number, "%s%.17g", i > 0 ? ", " : "", v[i] + by[i]);
        text += number;
    }
    return text + "]";
}

// A table with a translucent ball, a lamp, a beam and whatever else stands on it, all moved by this much.
std::string table(const Place& by, const std::string& more = "") {
    const auto at = [&](double x, double y, double z) { return vector_text({x, y, z}, by); };
    return R"({"format": "stokes-scene", "version": 1, "film": {"width": 40, "height": 30},
"render": {"passes": 2, "photons_per_pass": 8192, "seed": 3, "lambda_min_nm": 400, "lambda_max_nm": 700},
"camera": {"position_mm": )" +
           at(0, 60, 140) + R"(, "target_mm": )" + at(0, 18, 0) + R"(},
"media": {"milk": {"sigma_s_per_mm": 1.5, "sigma_a_per_mm": 0.005, "eta": 1.33}},
"materials": {"milk": {"type": "translucent", "medium": "milk"}, "white": {"type": "diffuse", "reflectance": 0.8},
 "checks": {"type": "diffuse", "reflectance": {"texture": "t.png", "black": 0.1, "white": 0.9}}},
"lights": [{"type": "disk", "center_mm": )" +
           at(40, 80, 30) + R"(, "normal": [-1, -2, -1], "radius_mm": 10, "spectrum": 1, "power_W": 5},
 {"type": "beam", "section": "disk", "position_mm": )" +
           at(-60, 100, 0) + R"(, "direction": [0.6, -1, 0], "radius_mm": 30, "irradiance_W_m2": 9, "spectrum": 1}],
"shapes": [{"type": "rectangle", "width_mm": 200, "height_mm": 200, "material": "white", "transform":
 [{"translate_mm": )" +
           at(0, 0, 0) + R"(}]},
 {"type": "sphere", "radius_mm": 18, "segments": 32, "material": "milk", "transform": [{"translate_mm": )" +
           at(0, 18.5, 0) + "}]}" + more + "]}";
}

RgbLayers render(const std::string& text, const TemporaryFolder& folder, int passes = 2) {
    Renderer renderer(test_device(), parse_scene(text, folder.file("s.json")));
    for (std::uint32_t pass = 0; pass < static_cast<std::uint32_t>(passes); ++pass) renderer.render_pass(pass);
    return film_layers(renderer.image());
}

double mean_of_whole(const RgbLayers& layers) {
    const std::vector<float>& rgb = layers.at("");
    double sum = 0.0;
    for (const float x : rgb) sum += static_cast<double>(x);
    return sum / static_cast<double>(rgb.size());
}

// A mesh that stands beside the ball.
std::string mesh(const std::string& file, const std::string& material, const std::string& keys = "") {
    return R"(, {"type": "mesh", "file": ")" + file + R"(", "material": ")" + material + "\"" + keys + "}";
}

// A box on the table from (-45, 0, 10) to (-25, 20, 30), and its faces turned the other way.
std::string box_obj(bool inward, double scale = 1.0, const Place& by = {0, 0, 0}) {
    std::string text;
    char line[120];
    for (int i = 0; i < 8; ++i) {
        std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", scale * (i & 1 ? -25 : -45) + by[0],
                      scale * (i & 2 ? 20 : 0) + by[1], scale * (i & 4 ? 30 : 10) + by[2]);
        text += line;
    }
    const int faces[6][4] = {{1, 5, 7, 3}, {2, 4, 8, 6}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 3, 4, 2}, {5, 6, 8, 7}};
    for (const auto& f : faces) {
        if (inward) std::snprintf(line, sizeof line, "f %d %d %d %d\n", f[0], f[3], f[2], f[1]);
        if (!inward) std::snprintf(line, sizeof line, "f %d %d %d %d\n", f[0], f[1], f[2], f[3]);
        text += line;
    }
    return text;
}

struct Files : TemporaryFolder {
    Files() {
        put_file(file("t.png"), png_bytes(2, {std::string("\x30\xc0\x80\xff", 4)}, {PNG_COLOR_TYPE_GRAY}));
        put_file(file("out.obj"), box_obj(false));
        put_file(file("in.obj"), box_obj(true));
    }
};

}  // namespace

// Every place is a multiple of 2^-2 mm, so that doubles hold all of them exactly.
TEST_CASE("a scene that is moved by a power of two has the same picture, bit by bit", "[mesh_places]") {
    const Files folder;
    const RgbLayers here = render(table({0, 0, 0}), folder);
    CHECK(mean_of_whole(here) > 0.0);
    for (const Place& by : {Place{1048576, 0, -2097152}, Place{1073741824, 1073741824, -1073741824}})
        CHECK(render(table(by), folder) == here);
}

// Rounding differs, so paths do: means agree within their noise. Those of six seeds spread by 0.3 %. Rounded about the
// file's origin, the picture at 1e6 mm was 5 % brighter.
TEST_CASE("a scene that is moved by anything has the same picture within its noise", "[mesh_places]") {
    const Files folder;
    const double here = mean_of_whole(render(table({0, 0, 0}), folder, 24));
    for (const double by : {1e6, 1e9}) {
        const double there = mean_of_whole(render(table({by, -by, 0.7 * by}), folder, 24));
        CHECK(there == Approx(here).epsilon(0.015));
    }
}

// The faces are quadrilaterals, cut from their first corner on either way: the same triangles.
TEST_CASE("a closed mesh that faces inward has the picture of one that faces outward", "[mesh_places]") {
    const Files folder;
    for (const char* material : {"white", "milk"}) {
        const RgbLayers out = render(table({0, 0, 0}, mesh("out.obj", material)), folder, 8);
        const RgbLayers in = render(table({0, 0, 0}, mesh("in.obj", material)), folder, 8);
        CHECK(mean_of_whole(in) == Approx(mean_of_whole(out)).epsilon(0.02));
    }
}

// A survey's file: metres, 4000 km from its origin. The transform brings it back.
TEST_CASE("a mesh far from its file's origin comes back in full precision", "[mesh_places]") {
    const Files folder;
    const Place survey = {4080928.0, -2048.0, 523776.0};
    put_file(folder.file("survey.obj"), box_obj(false, 1.0 / 1024, survey));
    const RgbLayers near = render(table({0, 0, 0}, mesh("out.obj", "white")), folder);
    const std::string back = R"(, "transform": [{"translate_mm": [-4080928, 2048, -523776]}, {"scale": 1024}])";
    CHECK(render(table({0, 0, 0}, mesh("survey.obj", "white", back)), folder) == near);
    const std::string first =
        R"(, "transform": [{"scale": 1024}, {"translate_mm": [-4178870272, 2097152, -536346624]}])";
    CHECK(render(table({0, 0, 0}, mesh("survey.obj", "white", first)), folder) == near);
}

// Two triangles beside the ball with the picture once, in another unit square, twice, and clamped.
TEST_CASE("texture coordinates of a mesh beyond 0 to 1 repeat, or end at the picture's edge", "[mesh_places]") {
    const Files folder;
    const auto quad = [&](const std::string& name, double u, double v, double size) {
        std::string text = "v -60 1 20\nv -30 1 20\nv -30 1 50\nv -60 1 50\nf 4/1 3/2 2/3 1/4\n";
        for (const auto& [x, y] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)})
            text += "vt " + std::to_string(u + size * x) + " " + std::to_string(v + size * y) + "\n";
        put_file(folder.file(name), text);
        return mesh(name, "checks");
    };
    const RgbLayers unit = render(table({0, 0, 0}, quad("unit.obj", 0, 0, 1)), folder);
    CHECK(render(table({0, 0, 0}, quad("tile.obj", 3, 1, 1)), folder) == unit);
    CHECK(render(table({0, 0, 0}, quad("below.obj", -7, -2, 1)), folder) == unit);
    CHECK_FALSE(render(table({0, 0, 0}, quad("twice.obj", 0, 0, 2)), folder) == unit);
    const std::string clamped = table({0, 0, 0}, quad("tile.obj", 3, 1, 1));
    const std::string at = "\"texture\": \"t.png\"";
    CHECK_FALSE(render(std::string(clamped).replace(clamped.find(at), at.size(), at + ", \"wrap\": \"clamp\""),
                       folder) == unit);
}
