// Meshes whose triangles face the wrong way. Expected volumes are those of the shapes before they were turned.
#include <cmath>
#include <random>

#include "host/scene/mesh/mesh.hpp"
#include "host/scene/mesh/orientation.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;

namespace {

const glm::dvec3 outside(1000.0);

Mesh moved_box(double size, const glm::dvec3& to, bool inward) {
    Mesh mesh = make_box(glm::dvec3(size));
    for (glm::vec3& p : mesh.positions_mm) p += glm::vec3(to);
    if (inward) turn_over(mesh);
    return mesh;
}

void append(Mesh& mesh, const Mesh& more) {
    const auto first = static_cast<std::uint32_t>(mesh.positions_mm.size());
    mesh.positions_mm.insert(mesh.positions_mm.end(), more.positions_mm.begin(), more.positions_mm.end());
    for (const glm::uvec3& t : more.triangles) mesh.triangles.push_back(t + first);
}

// To 1e-6 mm^3.
std::vector<double> volumes_of_boxes(const Mesh& mesh) {
    std::vector<double> volumes;
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 12) {
        Mesh part = mesh;
        part.triangles.assign(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(i),
                              mesh.triangles.begin() + static_cast<std::ptrdiff_t>(i + 12));
        volumes.push_back(std::round(1e6 * mesh_volume_mm3(part)) / 1e6);
    }
    return volumes;
}

}  // namespace

TEST_CASE("A closed mesh that faces inward is turned over, texture coordinates with it; one that faces outward stays") {
    Mesh box = make_box({2, 3, 4});
    CHECK(turn_outward({&box}, outside).turned == 0);
    CHECK(mesh_volume_mm3(box) == Approx(24));
    turn_over(box);
    for (const glm::uvec3& t : box.triangles)  // u and v of a corner: its x and y
        box.uv.push_back(
            {glm::vec2(box.positions_mm[t.x]), glm::vec2(box.positions_mm[t.y]), glm::vec2(box.positions_mm[t.z])});
    const Orientation found = turn_outward({&box}, outside);
    CHECK(found.turned == 12);
    CHECK(found.inconsistent == 0);
    CHECK(mesh_volume_mm3(box) == Approx(24));
    for (std::size_t i = 0; i < box.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k)
            CHECK(box.uv[i][static_cast<std::size_t>(k)] == glm::vec2(box.positions_mm[box.triangles[i][k]]));
}

TEST_CASE("Each part of a mesh is judged by itself, vertices of one place taken as one") {
    Mesh both = moved_box(2, {0, 0, 0}, false);
    append(both, moved_box(3, {10, 0, 0}, true));
    // As STL-like exporters write it: every triangle has vertices of its own.
    Mesh loose;
    for (const glm::uvec3& t : both.triangles) {
        for (int k = 0; k < 3; ++k) loose.positions_mm.push_back(both.positions_mm[t[k]]);
        const auto n = static_cast<std::uint32_t>(loose.positions_mm.size());
        loose.triangles.push_back({n - 3, n - 2, n - 1});
    }
    for (Mesh* mesh : {&both, &loose}) {
        CHECK(turn_outward({mesh}, outside).turned == 12);
        CHECK(volumes_of_boxes(*mesh) == std::vector<double>{8.0, 27.0});
    }
}

TEST_CASE("A cavity faces into itself, and stays so; a whole body inside out is turned with its cavities") {
    for (const bool inside_out : {false, true}) {
        Mesh body = moved_box(10, {0, 0, 0}, inside_out);
        append(body, moved_box(2, {2, 1, 0}, !inside_out));
        append(body, moved_box(1, {-2, 1, 0}, !inside_out));
        CHECK(turn_outward({&body}, outside).turned == (inside_out ? 36 : 0));
        CHECK(volumes_of_boxes(body) == std::vector<double>{1000.0, -8.0, -1.0});
    }
}

TEST_CASE("Many parts in one are told apart from many beside it") {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-40.0, 40.0);
    Mesh ball = make_sphere(50.0, 64);
    Mesh body = ball;
    int within = 0, beside = 0;
    for (int i = 0; i < 400; ++i) {
        const glm::dvec3 at(uniform(random), uniform(random), uniform(random));
        const double from_middle = glm::length(at);
        if (from_middle > 48.0 && from_middle < 52.0) continue;  // would cross the ball
        append(body, moved_box(0.5, at, true));
        ++(from_middle < 50.0 ? within : beside);
    }
    REQUIRE(within > 100);
    REQUIRE(beside > 40);
    CHECK(turn_outward({&body}, outside).turned == static_cast<std::size_t>(12 * beside));
}

TEST_CASE("A body whose surface is several meshes is judged as one") {
    const Mesh box = make_box({2, 2, 2});
    Mesh lower, upper;
    lower.positions_mm = upper.positions_mm = box.positions_mm;
    for (std::size_t i = 0; i < box.triangles.size(); ++i)
        (i < 5 ? lower : upper).triangles.push_back(box.triangles[i]);
    turn_over(lower);
    turn_over(upper);
    CHECK(turn_outward({&lower, &upper}, outside).turned == 12);
    CHECK(lower.triangles[0] == box.triangles[0]);
}

TEST_CASE("A room around the eye stays as it is, what stands in it does not") {
    Mesh room = moved_box(100, {0, 0, 0}, true);
    append(room, moved_box(2, {20, 0, 0}, true));
    CHECK(turn_outward({&room}, {1, 2, 3}).turned == 12);
    CHECK(volumes_of_boxes(room) == std::vector<double>{-1e6, 8.0});
}

TEST_CASE("An open mesh is not turned; where its triangles face opposite sides is told") {
    Mesh sheet = make_rectangle(4, 2);
    turn_over(sheet);
    Orientation found = turn_outward({&sheet}, outside);
    CHECK(found.turned == 0);
    CHECK(found.inconsistent == 0);
    std::swap(sheet.triangles[0].y, sheet.triangles[0].z);
    found = turn_outward({&sheet}, outside);
    CHECK(found.inconsistent == 1);
    CHECK(found.place_mm == glm::dvec3(0.0));  // the diagonal's middle
    Mesh box = make_box({2, 2, 2});
    std::swap(box.triangles[3].y, box.triangles[3].z);
    found = turn_outward({&box}, outside);
    CHECK(found.turned == 0);
    CHECK(found.inconsistent == 3);
}
