// A two-sided sheet in a beam: it reflects from the side that is lit, whichever it is, and lets nothing
// through.
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

constexpr double reflectance = 0.6;

const Spectrum sloping = {{300.0, 780.0}, {0.5, 2.0}, Outside::zero};

// A sheet in the plane y = 0, larger than the beam that falls on its middle from one side (1: above, -1:
// below), seen from one side.
Scene lit_sheet(double light_side, double camera_side, bool two_sided) {
    Scene scene = empty_scene("sheet");
    scene.materials = {diffuse_material(reflectance)};
    add_shape(scene, "sheet", 0, make_rectangle(400.0, 400.0)).two_sided = two_sided;
    scene.lights = {disk_beam({0.0, 0.0, 0.0}, {0.3, -light_side, 0.0}, 80.0, sloping)};
    scene.camera = camera_above({0.0, 0.0, 0.0}, 400.0, 40.0);
    scene.camera.position_mm.y *= camera_side;
    scene.film = {8, 8, {}};
    scene.render.photons_per_pass = 20000;
    scene.render.radius_mm = 6.0;
    return scene;
}

}  // namespace

// Lambert: radiance rho E cos / pi on the side that is lit, none on the other, whose normal is the opposite.
TEST_CASE("a two-sided sheet reflects on the side that is lit, and only there") {
    const double cosine = 1.0 / std::sqrt(1.09);
    for (const double light : {1.0, -1.0})
        for (const double camera : {1.0, -1.0}) {
            CAPTURE(light, camera);
            const Scene scene = lit_sheet(light, camera, true);
            Renderer renderer(test_device(), scene);
            PassImages images(renderer);
            Sample ratio;
            for (std::uint32_t pass = 0; pass < 12; ++pass)
                ratio.add(mean_xyz(images.next(pass), Layer::surface).y /
                          film_xyz(scene, pass, sloping.scaled(reflectance * cosine / M_PI)).y);
            CAPTURE(ratio.mean(), ratio.standard_error());
            if (light != camera) {
                CHECK(ratio.mean() == 0.0);
            } else {
                CHECK(ratio.standard_error() < 0.01);
                CHECK(std::abs(normal_of_t(ratio.z(1.0), static_cast<double>(ratio.count() - 1))) < 4.5);
            }
            const Balance power = renderer.book().ledger().power;
            CHECK(std::abs(power.imbalance()) < 1e-4);
            CHECK(power.absorbed == Approx((1.0 - reflectance) * power.emitted).epsilon(1e-4));
            CHECK(power.escaped + power.roulette == Approx(reflectance * power.emitted).epsilon(1e-4));
        }
}

TEST_CASE("the back of a sheet with one side is black") {
    const Scene scene = lit_sheet(-1.0, -1.0, false);
    Renderer renderer(test_device(), scene);
    renderer.render_pass(0);
    CHECK(mean_xyz(renderer.image(), Layer::surface).y == 0.0);
    const Balance power = renderer.book().ledger().power;
    CHECK(power.absorbed == Approx(power.emitted).epsilon(1e-4));
}

// A disk of the density estimate that hangs half beyond the edge of the sheet, seen from behind: the share on
// the surface is found there as it is in front.
TEST_CASE("the edge of a two-sided sheet is as bright as its middle, from behind too") {
    for (const double side : {1.0, -1.0}) {
        Scene scene = lit_sheet(side, side, true);
        scene.shapes[0].mesh = make_rectangle(60.0, 60.0);
        scene.camera.position_mm.x = scene.camera.target_mm.x = 29.0;
        scene.camera.vertical_fov_deg *= 0.02;
        Renderer renderer(test_device(), scene);
        Sample ratio;
        PassImages images(renderer);
        for (std::uint32_t pass = 0; pass < 24; ++pass)
            ratio.add(mean_xyz(images.next(pass), Layer::surface).y /
                      film_xyz(scene, pass, sloping.scaled(reflectance / std::sqrt(1.09) / M_PI)).y);
        CAPTURE(side, ratio.mean(), ratio.standard_error());
        CHECK(ratio.standard_error() < 0.05);
        CHECK(std::abs(ratio.mean() - 1.0) < 4.5 * ratio.standard_error());
    }
}
