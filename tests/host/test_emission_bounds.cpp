#include <cmath>

#include "host/render/emission_bounds.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

// A floor of 400 x 200 mm with a ball on it.
Scene table() {
    Scene scene = empty_scene("table");
    scene.materials = {diffuse_material(0.5), {"black", BlackMaterial{}}};
    add_shape(scene, "floor", 0, make_rectangle(400.0, 200.0));
    add_shape(scene, "ball", 0, moved(make_sphere(20.0, 16), {0.0, 20.0, 0.0}));
    return scene;
}

Beam down(double half_mm) {
    Beam beam;
    beam.position_mm = {50.0, 1000.0, 0.0};
    beam.half_u_mm = {half_mm, 0.0, 0.0};
    beam.half_v_mm = {0.0, 0.0, half_mm};
    return beam;
}

void add_lamp(Scene& scene, const Mesh& mesh, int material = 1) {
    add_shape(scene, "lamp", material, mesh).light = static_cast<int>(scene.lights.size());
    scene.lights.push_back({"lamp", Spectrum::constant(1.0), SurfaceLight{static_cast<int>(scene.shapes.size()) - 1}});
}

}  // namespace

// Margins are a thousandth.
TEST_CASE("the window of a wide beam covers the scene and starts before it", "[emission_bounds]") {
    Scene scene = table();
    scene.lights = {{"sun", Spectrum::constant(1.0), DiskBeam{down(30000.0)}},
                    {"sky", Spectrum::constant(1.0), RectangleBeam{down(3000.0)}}};
    const std::vector<EmissionBounds> bounds = emission_bounds(scene);
    for (const EmissionBounds& of : bounds) {
        REQUIRE(of.window);
        CHECK(glm::length(of.window->half_u_mm) == Approx(200.0).epsilon(2e-3));
        CHECK(glm::length(of.window->half_v_mm) == Approx(100.0).epsilon(2e-3));
        CHECK(std::abs(of.window->centre_mm.x) < 0.5);
        CHECK(std::abs(of.window->centre_mm.z) < 0.5);
        CHECK(of.window->centre_mm.y > 40.0);
        CHECK(of.window->centre_mm.y < 41.0);
    }
    CHECK(bounds[0].part == Approx(400.0 * 200.0 / (M_PI * 9e8)).epsilon(4e-3));
    CHECK(bounds[1].part == Approx(400.0 * 200.0 / 36e6).epsilon(4e-3));
}

// A slanting beam sees the floor foreshortened along the slant.
TEST_CASE("a window lies across its beam", "[emission_bounds]") {
    Scene scene = table();
    scene.shapes.pop_back();
    Beam beam;
    beam.direction = glm::normalize(glm::dvec3(1.0, -1.0, 0.0));
    beam.position_mm = -800.0 * beam.direction;
    beam.half_u_mm = 5000.0 * glm::normalize(glm::dvec3(1.0, 1.0, 0.0));
    beam.half_v_mm = {0.0, 0.0, 5000.0};
    scene.lights = {{"beam", Spectrum::constant(1.0), DiskBeam{beam}}};
    const EmissionBounds bounds = emission_bounds(scene).front();
    REQUIRE(bounds.window);
    CHECK(glm::length(bounds.window->half_u_mm) == Approx(200.0 * std::sqrt(0.5)).epsilon(2e-3));
    CHECK(glm::length(bounds.window->half_v_mm) == Approx(100.0).epsilon(2e-3));
    CHECK(std::abs(glm::dot(bounds.window->centre_mm - beam.position_mm, beam.half_u_mm)) < 5000.0);
}

TEST_CASE("a light that shines no further than the scene has no bounds", "[emission_bounds]") {
    Scene scene = table();
    scene.lights = {{"beam", Spectrum::constant(1.0), DiskBeam{down(150.0)}}};
    Beam up = down(30000.0);  // and so has one that meets nothing
    up.direction = {0.0, 1.0, 0.0};
    scene.lights.push_back({"up", Spectrum::constant(1.0), DiskBeam{up}});
    Mesh lamp = turned_over(moved(make_rectangle(50.0, 50.0), {0.0, 300.0, 0.0}));
    add_lamp(scene, lamp);
    for (const EmissionBounds& bounds : emission_bounds(scene)) {
        CHECK(!bounds.window);
        CHECK(!bounds.ball);
        CHECK(bounds.part == 1.0);
    }
}

// The ball of the table has the radius of its half diagonal; half of a sphere faces it. A lamp sends the share
// (r/d)^2 cos of its light to a ball in front of it; over a sphere's front half, seen from far away, the mean cosine is
// 1/2, and half of its surface sees nothing.
TEST_CASE("the ball of a lamp far away covers the scene but not other lamps", "[emission_bounds]") {
    Scene scene = table();
    const double d = 50000.0;
    add_lamp(scene, moved(make_sphere(100.0, 32), {0.0, d, 0.0}));
    add_lamp(scene, turned_over(moved(make_rectangle(50.0, 50.0), {0.0, d, 0.0})));
    add_lamp(scene, moved(make_disk(50.0, 24), {0.0, d, 0.0}));  // which shines up
    const std::vector<EmissionBounds> bounds = emission_bounds(scene);
    for (const EmissionBounds& of : bounds) {
        REQUIRE(of.ball);
        CHECK(of.ball->radius_mm == Approx(std::hypot(200.0, 100.0, 20.0)).epsilon(2e-3));
        CHECK(glm::distance(of.ball->centre_mm, {0.0, 20.0, 0.0}) < 0.1);
    }
    const double share = (200.0 * 200.0 + 100.0 * 100.0 + 20.0 * 20.0) / (d * d);
    CHECK(bounds[0].part == Approx(share / 4.0).epsilon(0.02));
    CHECK(bounds[1].part == Approx(share).epsilon(0.01));
    CHECK(bounds[2].part > 0.0);
    CHECK(bounds[2].part < 0.1 * share);

    scene.shapes[3].material = 0;  // a white lamp is met like anything else
    CHECK(!emission_bounds(scene)[0].ball);
}
