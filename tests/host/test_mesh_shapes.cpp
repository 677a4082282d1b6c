#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "host/scene/mesh/mesh.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/file_meshes.hpp"
#include "tests/support/triangle_meshes.hpp"

using namespace stokes;

namespace {

// For convex shapes: every triangle faces away from the point inside.
bool all_face_away_from(const Mesh& mesh, const glm::dvec3& inside) {
    for (const glm::uvec3& t : mesh.triangles) {
        if (!(glm::dot(area_vector_mm2(mesh, t), glm::dvec3(mesh.positions_mm[t.x]) - inside) > 0.0)) return false;
    }
    return true;
}

double polygon_area(int sides, double radius) { return 0.5 * sides * radius * radius * std::sin(2 * M_PI / sides); }

}  // namespace

TEST_CASE("A box is closed, outward, and of exact volume, area and bounds") {
    const Mesh box = make_box({2, 3, 4});
    CHECK(are_watertight({box}));
    CHECK(all_face_away_from(box, glm::dvec3(0)));
    CHECK(mesh_volume_mm3(box) == Approx(24));
    CHECK(mesh_area_mm2(box) == Approx(52));
    CHECK(mesh_bounds(box).low_mm == glm::dvec3(-1, -1.5, -2));
    CHECK(mesh_bounds(box).high_mm == glm::dvec3(1, 1.5, 2));
}

TEST_CASE("A sphere is closed and outward, its vertices on the sphere, volume and area just below") {
    for (const int segments : {4, 5, 16, default_segments}) {
        INFO(segments);
        const Mesh sphere = make_sphere(10, segments);
        CHECK(are_watertight({sphere}));
        CHECK(all_face_away_from(sphere, glm::dvec3(0)));
        for (const glm::vec3& p : sphere.positions_mm) CHECK(glm::length(p) == Approx(10).epsilon(1e-6));
    }
    const Mesh sphere = make_sphere(10);
    CHECK(sphere.triangles.size() == 2 * 128 * 63);
    const double volume = mesh_volume_mm3(sphere) / (4.0 / 3.0 * M_PI * 1000);
    const double area = mesh_area_mm2(sphere) / (4 * M_PI * 100);
    // The chord's sagitta is (angle/2)^2/2 of the radius: below 3e-4 here in each direction.
    CHECK((volume > 0.998 && volume < 1.0));
    CHECK((area > 0.9985 && area < 1.0));
}

TEST_CASE("Prisms and cylinders stand on y = 0, closed and outward, of the polygon's volume and area") {
    for (const int sides : {3, 4, 6, 7, 128}) {
        INFO(sides);
        const Mesh prism = sides == 128 ? make_cylinder(5, 8) : make_prism(sides, 5, 8);
        CHECK(are_watertight({prism}));
        CHECK(all_face_away_from(prism, {0, 4, 0}));
        CHECK(mesh_bounds(prism).low_mm.y == 0.0);
        CHECK(mesh_bounds(prism).high_mm.y == 8.0);
        CHECK(glm::dvec3(prism.positions_mm[0]) == glm::dvec3(5, 0, 0));
        CHECK(mesh_volume_mm3(prism) == Approx(8 * polygon_area(sides, 5)));
        const double side = 2 * 5 * std::sin(M_PI / sides);
        CHECK(mesh_area_mm2(prism) == Approx(2 * polygon_area(sides, 5) + sides * side * 8));
    }
}

TEST_CASE("Rectangles and disks face up") {
    const Mesh rectangle = make_rectangle(6, 4);
    CHECK(mesh_area_mm2(rectangle) == Approx(24));
    CHECK(mesh_bounds(rectangle).high_mm == glm::dvec3(3, 0, 2));
    const Mesh disk = make_disk(3, 12);
    CHECK(mesh_area_mm2(disk) == Approx(polygon_area(12, 3)));
    for (const Mesh& mesh : {rectangle, disk}) {
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::dvec3 n = area_vector_mm2(mesh, t);
            CHECK((n.y > 0 && n.x == 0 && n.z == 0));
        }
    }
}

TEST_CASE("A transform moves positions; one that mirrors keeps the outside out") {
    Mesh box = make_box({2, 2, 2});
    transform_mesh(box, glm::translate(glm::dmat4(1.0), {10, 20, 30}));
    CHECK(mesh_bounds(box).low_mm == glm::dvec3(9, 19, 29));
    CHECK(mesh_volume_mm3(box) == Approx(8));
    transform_mesh(box, glm::scale(glm::dmat4(1.0), {-1, 1, 3}));
    CHECK(mesh_bounds(box).low_mm == glm::dvec3(-11, 19, 87));
    CHECK(mesh_volume_mm3(box) == Approx(24));
    CHECK(all_face_away_from(box, {-10, 20, 90}));
}

TEST_CASE("Volume is exact far from the origin and negative inside out") {
    Mesh box = make_box({2, 2, 2});
    transform_mesh(box, glm::translate(glm::dmat4(1.0), {1e6, -1e6, 1e6}));
    CHECK(mesh_volume_mm3(box) == Approx(8));
    for (glm::uvec3& t : box.triangles) std::swap(t.x, t.y);
    CHECK(mesh_volume_mm3(box) == Approx(-8));
}

TEST_CASE("Triangles without area are dropped, with the vertices that only they used") {
    Mesh mesh{{{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 0}},
              {{1, 2, 4}, {1, 2, 3}, {1, 1, 2}, {1, 4, 5}, {0, 0, 0}}};
    CHECK(drop_degenerate_triangles(mesh) == 4);
    REQUIRE(mesh.triangles.size() == 1);
    CHECK(mesh.positions_mm.size() == 3);
    CHECK(mesh.triangles[0] == glm::uvec3(0, 1, 2));
    CHECK(mesh.positions_mm[2] == glm::vec3(0, 1, 0));
    CHECK(drop_degenerate_triangles(mesh) == 0);
}

TEST_CASE("A triangle that rounding alone gives an area is dropped, a thin one is kept") {
    Mesh flat{{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, {{0, 1, 2}}};
    transform_mesh(flat, glm::rotate(glm::dmat4(1.0), 0.1, glm::dvec3(0.48, 0.6, 0.64)));
    CHECK(drop_degenerate_triangles(flat) == 1);
    Mesh thin{{{0, 0, 0}, {1, 1e-4F, 0}, {3, 0, 0}}, {{0, 1, 2}}};
    transform_mesh(thin, glm::rotate(glm::dmat4(1.0), 0.1, glm::dvec3(0.48, 0.6, 0.64)));
    CHECK(drop_degenerate_triangles(thin) == 0);
}

// (u, v) is an affine function of the place: check it at every corner.
TEST_CASE("Rectangles and disks have texture coordinates, from (0, 0) at the least x and z to (1, 1)") {
    Mesh disk = make_disk(3, 12), rectangle = make_rectangle(6, 6);
    for (const bool mirrored : {false, true}) {
        for (Mesh* mesh : {&disk, &rectangle}) {
            REQUIRE(mesh->uv.size() == mesh->triangles.size());
            for (std::size_t i = 0; i < mesh->triangles.size(); ++i)
                for (int k = 0; k < 3; ++k) {
                    const glm::vec3 p = mesh->positions_mm[mesh->triangles[i][k]];
                    const glm::vec2 uv = mesh->uv[i][static_cast<std::size_t>(k)];
                    CHECK(uv.x == Approx((mirrored ? -p.x : p.x) / 6 + 0.5).margin(1e-6));
                    CHECK(uv.y == Approx(p.z / 6 + 0.5).margin(1e-6));
                }
            transform_mesh(*mesh, glm::scale(glm::dmat4(1.0), {-1, 1, 1}));
        }
    }
}

TEST_CASE("Triangles that are dropped take their texture coordinates with them") {
    Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 2}}, {{}, {}}};
    mesh.uv[1][2] = {0.5f, 0.25f};
    CHECK(drop_degenerate_triangles(mesh) == 1);
    REQUIRE(mesh.uv.size() == 1);
    CHECK(mesh.uv[0][2] == glm::vec2(0.5f, 0.25f));
}
