// A floor whose reflectance a picture gives, under light that is the same everywhere.
#include <memory>

#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

const Spectrum sloping = {{300.0, 780.0}, {0.5, 2.0}, Outside::zero};
// Cross each other between 300 and 780 nm.
const Spectrum dark = {{300.0, 780.0}, {0.3, 0.05}, Outside::hold};
const Spectrum bright = {{300.0, 780.0}, {0.2, 0.9}, Outside::hold};

constexpr double floor_mm = 160.0;

// A checkerboard of two by two texels, the top left one white; beyond their middles the picture is clamped,
// so that the outer quarter on each side has the colour of one texel alone. All of the floor is lit, and
// nothing beside it.
Scene checkered_floor() {
    Scene scene = empty_scene("floor");
    const auto checks = std::make_shared<const Picture>(Picture{2, 2, {1.0f, 0.0f, 0.0f, 1.0f}, {}});
    scene.materials = {Material{}, {"checker", DiffuseMaterial{dark, checks, bright}}};
    add_shape(scene, "floor", 1, make_rectangle(floor_mm, floor_mm));
    const RectangleBeam beam{
        {{0.0, floor_mm, 0.0}, {0.0, -1.0, 0.0}, {0.5 * floor_mm, 0.0, 0.0}, {0.0, 0.0, 0.5 * floor_mm}}};
    scene.lights = {{"beam", sloping.scaled(floor_mm * floor_mm * 1e-6), beam}};
    scene.film = {8, 8, {}};
    scene.render.photons_per_pass = 60000;
    scene.render.radius_mm = 5.0;
    return scene;
}

Spectrum product(const Spectrum& a, const Spectrum& b, double factor) {
    Spectrum result;
    for (int lambda = 300; lambda <= 780; ++lambda) {
        result.lambda_nm.push_back(lambda);
        result.value.push_back(factor * a.at(lambda) * b.at(lambda));
    }
    return result;
}

}  // namespace

// Lambert: L = rho E / pi with the reflectance of the place.
TEST_CASE("the squares of a checkered floor have the radiance of their own reflectance", "[textured]") {
    struct Place {
        double x_mm, z_mm;
        bool white;
    };
    const double far = 0.375 * floor_mm;
    for (const Place& place :
         {Place{-far, -far, true}, Place{far, -far, false}, Place{-far, far, false}, Place{far, far, true}}) {
        CAPTURE(place.x_mm, place.z_mm);
        Scene scene = checkered_floor();
        scene.camera = camera_above({place.x_mm, 0.0, place.z_mm}, 400.0, 20.0);
        const Spectrum radiance = product(sloping, place.white ? bright : dark, 1.0 / M_PI);
        Renderer renderer(test_device(), scene);
        PassImages images(renderer);
        Sample ratio;
        for (std::uint32_t pass = 0; pass < 16; ++pass)
            ratio.add(mean_xyz(images.next(pass), Layer::surface).y / film_xyz(scene, pass, radiance).y);
        CAPTURE(ratio.mean(), ratio.standard_error());
        CHECK(ratio.standard_error() < 0.01);
        CHECK(std::abs(normal_of_t(ratio.z(1.0), static_cast<double>(ratio.count() - 1))) < 4.5);
    }
}

// Half way between two texels the picture has the mean of both.
TEST_CASE("between two texels the radiance is the mean of both", "[textured]") {
    Scene scene = checkered_floor();
    scene.camera = camera_above({0.0, 0.0, -0.375 * floor_mm}, 400.0, 20.0);
    const Spectrum black = product(sloping, dark, 0.5 / M_PI), white = product(sloping, bright, 0.5 / M_PI);
    Renderer renderer(test_device(), scene);
    PassImages images(renderer);
    Sample ratio;
    for (std::uint32_t pass = 0; pass < 8; ++pass)
        ratio.add(mean_xyz(images.next(pass), Layer::surface).y /
                  (film_xyz(scene, pass, black).y + film_xyz(scene, pass, white).y));
    CAPTURE(ratio.mean(), ratio.standard_error());
    CHECK(std::abs(normal_of_t(ratio.z(1.0), static_cast<double>(ratio.count() - 1))) < 4.5);
}

// The picture's mean luminance is 1/2: the floor absorbs E (1 - (dark + bright)/2), at each wavelength of
// each pass.
TEST_CASE("a checkered floor absorbs the mean of what its squares do, and the ledger closes", "[textured]") {
    const Scene scene = checkered_floor();
    Renderer renderer(test_device(), scene);
    double emitted = 0.0, absorbed = 0.0;
    const std::uint32_t passes = 4;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        renderer.render_pass(pass);
        for (const int lambda : wavelengths_of(scene, pass)) {
            emitted += sloping.at(lambda);
            absorbed += sloping.at(lambda) * (1.0 - 0.5 * (dark.at(lambda) + bright.at(lambda)));
        }
    }
    const Balance power = renderer.book().ledger().power;
    CHECK(std::abs(power.imbalance()) < 1e-4);
    CHECK(power.dropped == 0.0);
    // 240000 photons, the reflected share of each between 0.2 and 0.6: 3e-4 of the mean.
    CHECK(power.absorbed / power.emitted == Approx(absorbed / emitted).epsilon(2e-3));
    CHECK(power.escaped + power.roulette == Approx(power.emitted - power.absorbed).epsilon(1e-4));
}

// A closed room of reflectance R under radiance 1 has 1/(1 - R) everywhere; so it has where R comes from a
// picture of one luminance, black + L (white - black).
TEST_CASE("a furnace papered with an even picture is one of its reflectance", "[textured]") {
    Scene scene = empty_scene("furnace");
    const auto grey = std::make_shared<const Picture>(Picture{3, 1, {0.5f, 0.5f, 0.5f}, {}});
    scene.materials = {{"paper", DiffuseMaterial{Spectrum::constant(0.2), grey, Spectrum::constant(0.8)}}};
    Mesh room = turned_over(make_sphere(100.0, 64));
    room.uv.assign(room.triangles.size(), {glm::vec2(0.0f), glm::vec2(1.0f, 0.0f), glm::vec2(1.0f)});
    const double area_mm2 = mesh_area_mm2(room);
    add_shape(scene, "room", 0, room).light = 0;
    scene.lights = {{"room", Spectrum::constant(M_PI * area_mm2 * 1e-6), SurfaceLight{0}}};
    scene.camera.position_mm = {20.0, -10.0, 5.0};
    scene.camera.target_mm = {-30.0, 40.0, 10.0};
    scene.film = {8, 8, {}};
    scene.render.photons_per_pass = 50000;
    scene.render.radius_mm = 12.0;
    Renderer renderer(test_device(), scene);
    PassImages images(renderer);
    Sample ratio;
    for (std::uint32_t pass = 0; pass < 8; ++pass)
        ratio.add(mean_xyz(images.next(pass), Layer::surface).y / film_xyz(scene, pass, Spectrum::constant(2.0)).y);
    CAPTURE(ratio.mean(), ratio.standard_error());
    CHECK(ratio.mean() == Approx(1.0).epsilon(0.01));
    CHECK(std::abs(renderer.book().ledger().power.imbalance()) < 1e-4);
}
