// Shapes of several materials: their parts make one closed surface.
#include <cmath>
#include <cstring>

#include "host/render/assumptions.hpp"
#include "host/scene/mesh/mesh.hpp"
#include "host/scene/mesh/mesh_thickness.hpp"
#include "host/scene/mesh/mesh_topology.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/triangle_meshes.hpp"

using namespace stokes;

namespace {

std::vector<Mesh> meshes_of(const Scene& scene) {
    std::vector<Mesh> meshes;
    for (const Shape& shape : scene.shapes)
        if (shape.light < 0) meshes.push_back(shape.mesh);
    return meshes;
}

Scene read(const std::string& shape, const std::string& transport = "conserving") {
    return parse_scene(R"({"format": "stokes-scene", "version": 1, "transport": ")" + transport + R"(",
"camera": {"position_mm": [0, 9, 90], "target_mm": [0, 0, 0]},
"media": {"m": {"sigma_s_per_mm": 2, "sigma_a_per_mm": 0.5}, "n": {"sigma_s_per_mm": 3, "sigma_a_per_mm": 0.4}},
"materials": {"a": {"type": "translucent", "medium": "m"}, "b": {"type": "translucent", "medium": "n"},
  "c": {"type": "diffuse", "reflectance": 0.5}, "d": {"type": "black"}},
"lights": [{"type": "sphere", "center_mm": [0, 200, 0], "radius_mm": 1, "spectrum": 1, "power_W": 1}],
"shapes": [)" + shape + "]}",
                       "s.json");
}

}  // namespace

TEST_CASE("The parts of tiles are one closed box of exact volume and area, and divide its top as a checkerboard") {
    for (const int parts : {1, 2, 3}) {
        const std::vector<Mesh> tiles = make_tiles({12, 5, 6}, 4, 3, parts);
        REQUIRE(tiles.size() == static_cast<std::size_t>(parts));
        CHECK(are_watertight(tiles));
        double area = 0.0, volume = 0.0;
        for (const Mesh& mesh : tiles) {
            area += mesh_area_mm2(mesh);
            volume += mesh_volume_mm3(mesh);
            for (const glm::uvec3& t : mesh.triangles) {
                const glm::vec3 a = mesh.positions_mm[t.x], b = mesh.positions_mm[t.y], c = mesh.positions_mm[t.z];
                CHECK(glm::dot(glm::cross(b - a, c - a), a + b + c) > 0.0f);
                if (!(a.y == 2.5f && b.y == 2.5f && c.y == 2.5f)) continue;
                const glm::vec3 middle = (a + b + c) / 3.0f;
                const int column = static_cast<int>((middle.x + 6.0f) / 3.0f),
                          row = static_cast<int>((middle.z + 3.0f) / 2.0f);
                CHECK(&mesh == &tiles[static_cast<std::size_t>((column + row) % parts)]);
            }
        }
        CHECK(area == Approx(2 * (12 * 5 + 12 * 6 + 5 * 6)));
        if (parts == 1) CHECK(volume == Approx(12 * 5 * 6));
    }
}

TEST_CASE("The parts of sectors are one closed cylinder in equal shares, counter-clockwise from where they start") {
    for (const int sectors : {1, 2, 6, 7}) {
        CAPTURE(sectors);
        const std::vector<Mesh> parts = make_sectors(5, 8, sectors, 40, 90.0);
        REQUIRE(parts.size() == static_cast<std::size_t>(sectors));
        CHECK(are_watertight(parts));
        const int sides = 40 + (sectors - 40 % sectors) % sectors;
        const double side = 2 * 5 * std::sin(M_PI / sides), polygon = 0.5 * sides * 25 * std::sin(2 * M_PI / sides);
        for (int k = 0; k < sectors; ++k) {
            const Mesh& mesh = parts[static_cast<std::size_t>(k)];
            CHECK(mesh_area_mm2(mesh) * sectors == Approx(2 * polygon + sides * side * 8));
            for (const glm::uvec3& t : mesh.triangles) {
                const glm::vec3 middle =
                    (mesh.positions_mm[t.x] + mesh.positions_mm[t.y] + mesh.positions_mm[t.z]) / 3.0f;
                const double from_start = std::fmod(std::atan2(-middle.z, middle.x) / (2 * M_PI) + 1.75, 1.0);
                CHECK(static_cast<int>(from_start * sectors) == k);
            }
        }
    }
}

TEST_CASE("Tiles and sectors of a scene are shapes of one body, watertight wherever they are put") {
    const std::string transform =
        R"("transform": [{"rotate_axis": [1, 2, 3], "angle_deg": 33}, {"scale": [1.1, 0.7, -1]}, {"translate_mm": [71, -13, 29]}])";
    for (
        const std::string& shape :
        {R"({"type": "tiles", "materials": ["a", "b"], "columns": 5, "rows": 3, "size_mm": [61, 37, 41], )" +
             transform + "}",
         R"({"type": "sectors", "materials": ["a", "b", "a", "b", "a"], "radius_mm": 31, "height_mm": 33, "name": "pie", )" +
             transform + "}"}) {
        for (const char* transport : {"paper", "conserving", "walk"}) {
            const Scene scene = read(shape, transport);
            CHECK(are_watertight(meshes_of(scene)));
            const BodyTopology body = body_topology(scene, 0);
            CHECK(body.kind == BodyKind::closed);
            CHECK(body.volume_mm3 > 0.0);
            CHECK(check_walkable(scene)[0] == BodyKind::closed);
            CHECK(failed_assumptions(scene).empty());
            for (std::size_t i = 0; i + 1 < scene.shapes.size(); ++i) CHECK(scene.shapes[i].body == 0);
        }
    }
}

TEST_CASE("A body of several materials is judged as a whole, once for each of them") {
    const Scene scene =
        read(R"({"type": "tiles", "materials": ["a", "b"], "columns": 40, "rows": 40, "size_mm": [400, 0.5, 400]})");
    CHECK(median_thickness_mm(scene, 0) == Approx(0.5).epsilon(1e-4));
    const std::vector<std::string> lines = failed_assumptions(scene);
    REQUIRE(lines.size() == 2);
    CHECK_THAT(lines[0],
               Catch::Matchers::Contains("materials.a: shape \"shape 0 (a)\" is thinner than its light reaches"));
    CHECK_THAT(lines[1],
               Catch::Matchers::Contains("materials.b: shape \"shape 0 (b)\" is thinner than its light reaches"));
    const Scene thick =
        read(R"({"type": "tiles", "materials": ["a", "b"], "columns": 40, "rows": 40, "size_mm": [40, 40, 40]})");
    CHECK(failed_assumptions(thick).empty());
}

TEST_CASE("Mistakes in tiles and sectors are named") {
    const auto error = [](const std::string& shape) { return input_error([&] { read(shape); }); };
    CHECK(error(R"({"type": "tiles", "materials": ["a", "c"], "columns": 2, "rows": 1, "size_mm": [1, 1, 1]})") ==
          "s.json:7: shapes[0].materials[1]: expected materials all with light below their surfaces or all "
          "without, got "
          "\"a\" and \"c\"");
    CHECK(
        error(R"({"type": "tiles", "materials": ["c", "d"], "columns": 2, "rows": 1, "size_mm": [1, 1, 1]})").empty());
    CHECK(error(R"({"type": "tiles", "materials": ["a", "z"], "columns": 2, "rows": 1, "size_mm": [1, 1, 1]})") ==
          "s.json:7: shapes[0].materials[1]: no \"z\" in materials");
    CHECK(error(R"({"type": "tiles", "materials": ["a", "b", "a"], "columns": 2, "rows": 1, "size_mm": [1, 1, 1]})") ==
          "s.json:7: shapes[0].materials: expected at most 2 materials for 2 x 1 tiles, got an array of 3");
    CHECK(error(R"({"type": "tiles", "material": "a", "columns": 2, "rows": 1, "size_mm": [1, 1, 1]})") ==
          "s.json:7: shapes[0]: unknown key \"material\"; did you mean \"materials\"?");
    CHECK(error(R"({"type": "tiles", "materials": ["a"], "columns": 0, "rows": 1, "size_mm": [1, 1, 1]})") ==
          "s.json:7: shapes[0].columns: expected an integer in [1, 512], got 0");
    CHECK(error(R"({"type": "sectors", "materials": [], "radius_mm": 1, "height_mm": 1})") ==
          "s.json:7: shapes[0].materials: expected one or more names of materials, got an array of 0");
    CHECK(error(R"({"type": "sectors", "materials": ["a"], "radius_mm": 0, "height_mm": 1})") ==
          "s.json:7: shapes[0].radius_mm: expected a number in (0, 1e+07], got 0");
}
