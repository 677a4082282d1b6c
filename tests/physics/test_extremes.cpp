#include <cmath>

#include "host/render/renderer.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

// The first radius follows from where photons fall, not from whether a wavelength of the trial pass meets the lamp.
TEST_CASE("a lamp of one wavelength gives about the same first radius as a white one", "[radius]") {
    Scene scene = small_scene();
    scene.render.photons_per_pass = 20000;
    scene.lights[0].flux = {{300.0, 780.0}, {1e-3, 1e-3}, Outside::zero};
    const double white = Renderer(test_device(), scene).first_radius();
    scene.lights[0].flux = {{403.0, 405.0, 407.0}, {0.0, 1.0, 0.0}, Outside::zero};
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        scene.render.seed = seed;
        CHECK(Renderer(test_device(), scene).first_radius() == Approx(white).epsilon(0.1));
    }
}

// Inside a closed body whose tables exceed one, the paper's model multiplies light without end. What grows beyond all
// numbers is cut and counted, and never reaches the picture.
TEST_CASE("light that grows without bound is cut and counted", "[overflow]") {
    Scene scene = slab_scene(0.0, 0.0);
    scene.media[0].sigma_s = Spectrum::constant(12.0);
    scene.shapes[0].mesh = turned_over(make_sphere(30.0, 32));
    std::get<DiskBeam>(scene.lights[0].kind).position_mm = {0.0, 5.0, 0.0};
    scene.camera.position_mm = {0.0, 0.0, 10.0};
    scene.camera.target_mm = {0.0, -20.0, 0.0};
    scene.render.photons_per_pass = 2000;
    Renderer renderer(test_device(), scene);
    renderer.render_pass(0);
    const Balance ledger = renderer.book().ledger().power;
    CHECK(renderer.book().dropped().at("overflow") + renderer.book().dropped().at("event_limit") > 0);
    CHECK(ledger.created > ledger.emitted);
    for (const double v :
         {ledger.absorbed, ledger.stokes_loss, ledger.dropped, ledger.roulette, ledger.created, ledger.stored})
        CHECK(std::isfinite(v));
    CHECK(count_non_finite(renderer.image()) == 0);
}
