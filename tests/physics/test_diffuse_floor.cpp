#include <utility>

#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

constexpr double reflectance = 0.6;

// Neither flat nor zero anywhere in 300..780 nm [W m^-2 nm^-1].
const Spectrum sloping = {{300.0, 780.0}, {0.5, 2.0}, Outside::zero};

// A diffuse floor; its interior, 40 mm wide, is seen from above.
Scene floor_scene() {
    Scene scene = empty_scene("floor");
    scene.materials = {diffuse_material(reflectance), Material{}};
    add_shape(scene, "floor", 0, make_rectangle(1000.0, 1000.0));
    scene.film = {8, 8, {}};
    scene.camera = camera_above({0.0, 0.0, 0.0}, 400.0, 40.0);
    return scene;
}

Scene lit_floor(double angle_deg, const Spectrum& irradiance) {
    Scene scene = floor_scene();
    const double angle = angle_deg * M_PI / 180.0;
    scene.lights = {disk_beam({0.0, 0.0, 0.0}, {std::sin(angle), -std::cos(angle), 0.0}, 80.0, irradiance)};
    return scene;
}

// The picture's mean Y in each pass over what the radiance makes of that pass's wavelengths.
Sample brightness(const Scene& scene, const Spectrum& radiance, std::uint32_t passes) {
    Renderer renderer(test_device(), scene);
    PassImages images(renderer);
    Sample ratio;
    for (std::uint32_t pass = 0; pass < passes; ++pass)
        ratio.add(mean_xyz(images.next(pass), Layer::surface).y / film_xyz(scene, pass, radiance).y);
    return ratio;
}

void check_is_one(const Sample& ratio, double within) {
    CAPTURE(ratio.mean(), ratio.standard_error());
    CHECK(ratio.standard_error() < within);
    // 4.5 of a normal variable: 7e-6 for a comparison.
    CHECK(std::abs(normal_of_t(ratio.z(1.0), static_cast<double>(ratio.count() - 1))) < 4.5);
}

}  // namespace

// A Lambertian surface under irradiance E has radiance rho E / pi. One event a photon: the film's Y of a pass
// is that radiance at the pass's wavelengths, whatever the number of photons and the radius, as long as the
// disk of the density estimate lies inside the beam.
TEST_CASE("a diffuse floor under irradiance E has radiance rho E / pi", "[floor]") {
    struct Case {
        double angle_deg;
        std::int64_t photons;
        double radius_mm;
    };
    for (const Case& c :
         {Case{0.0, 20000, 6.0}, Case{0.0, 80000, 6.0}, Case{0.0, 20000, 25.0}, Case{55.0, 20000, 6.0}}) {
        CAPTURE(c.angle_deg, c.photons, c.radius_mm);
        Scene scene = lit_floor(c.angle_deg, sloping);
        scene.render.photons_per_pass = c.photons;
        scene.render.radius_mm = c.radius_mm;
        scene.render.direct = Direct::photons;
        const double cosine = std::cos(c.angle_deg * M_PI / 180.0);
        check_is_one(brightness(scene, sloping.scaled(reflectance * cosine / M_PI), 16), 0.01);
    }
}

// The same without photons, to rounding, in each pass.
TEST_CASE("a diffuse floor under irradiance E has radiance rho E / pi without noise by rays", "[floor]") {
    for (const double angle_deg : {0.0, 55.0}) {
        CAPTURE(angle_deg);
        Scene scene = lit_floor(angle_deg, sloping);
        scene.render.photons_per_pass = 100;
        scene.render.direct = Direct::rays;
        const double cosine = std::cos(angle_deg * M_PI / 180.0);
        const Sample ratio = brightness(scene, sloping.scaled(reflectance * cosine / M_PI), 4);
        CAPTURE(ratio.mean(), ratio.standard_error());
        CHECK(ratio.mean() == Approx(1.0).epsilon(1e-5));
        CHECK(ratio.standard_error() < 1e-5);
    }
}

TEST_CASE("the film is linear in the lamp's power", "[floor]") {
    std::vector<FilmImage> images;
    for (const double factor : {1.0, 8.0}) {
        Scene scene = lit_floor(0.0, sloping.scaled(factor));
        scene.render.photons_per_pass = 5000;
        scene.render.radius_mm = 5.0;
        Renderer renderer(test_device(), scene);
        renderer.render_pass(0);
        images.push_back(renderer.image());
    }
    const std::vector<float>& one = images[0].xyz[static_cast<std::size_t>(Layer::surface)];
    const std::vector<float>& eight = images[1].xyz[static_cast<std::size_t>(Layer::surface)];
    for (std::size_t i = 0; i < one.size(); ++i) {
        REQUIRE(one[i] > 0.0f);
        // The same photons, each with eight times the flux: rounding alone, 24 bits over some hundred sums.
        CHECK(eight[i] == Approx(8.0 * static_cast<double>(one[i])).epsilon(1e-5));
    }
}

// Flux / (pi A) from the front in every direction, nothing from the back; no noise but that of rounding.
TEST_CASE("a rectangle that emits is seen with its radiance", "[floor]") {
    Scene scene = floor_scene();
    add_shape(scene, "lamp", 1, moved(make_rectangle(90.0, 60.0), {0.0, 50.0, 0.0})).light = 0;
    scene.lights = {{"lamp", sloping.scaled(M_PI * 90.0 * 60.0 * 1e-6), SurfaceLight{1}}};
    scene.render.photons_per_pass = 100;
    scene.render.radius_mm = 1.0;
    for (const bool front : {true, false}) {
        CAPTURE(front);
        scene.camera.position_mm = {70.0, front ? 130.0 : 10.0, 40.0};
        scene.camera.target_mm = {0.0, 50.0, 0.0};
        scene.camera.up = {0.0, 1.0, 0.0};
        scene.camera.vertical_fov_deg = 8.0;
        Renderer renderer(test_device(), scene);
        glm::dvec3 expected(0.0);
        for (std::uint32_t pass = 0; pass < 3; ++pass) {
            renderer.render_pass(pass);
            expected += film_xyz(scene, pass, sloping.scaled(front ? 1.0 : 0.0)) / 3.0;
        }
        const FilmImage image = renderer.image();
        for (std::size_t i = 0; i < image.pixels() * 3; ++i) {
            for (const auto& layer : image.xyz)
                if (&layer != &image.xyz[3]) CHECK(layer[i] == 0.0f);
            CHECK(static_cast<double>(image.xyz[3][i]) == Approx(expected[static_cast<int>(i % 3)]).epsilon(1e-5));
        }
    }
}

// Outside a Lambertian sphere its light is that of a point: flux Phi gives a plane element at distance d from
// the centre, the whole sphere above the element's plane, the irradiance Phi cos / (4 pi d^2), which is pi L
// times the form factor (R/d)^2 cos. Over a disk of radius r the mean of h / (h^2 + x^2)^(3/2) differs from
// its centre by at most r^2/8 * 6/h^2, the Laplacian under the sphere: 0.2 % for r = 4 and h = 80.
TEST_CASE("a sphere that emits irradiates a floor by the form factor of a sphere", "[floor]") {
    const double height_mm = 80.0, edge_mm = 70.0;
    for (const auto& [x_mm, direct] : {std::pair(60.0, Direct::photons), std::pair(110.0, Direct::photons),
                                       std::pair(60.0, Direct::rays), std::pair(110.0, Direct::rays)}) {
        CAPTURE(x_mm, direct == Direct::rays);
        Scene scene = floor_scene();
        scene.render.direct = direct;
        add_shape(scene, "lamp", 1, moved(make_sphere(20.0, 128), {0.0, height_mm, 0.0})).light = 0;
        scene.lights = {{"lamp", sloping.scaled(1e-2), SurfaceLight{1}}};
        scene.camera = camera_above({x_mm, 0.0, 0.0}, 400.0, edge_mm);
        // Half of a sphere's points, and more, face away from any other.
        if (direct == Direct::rays) scene.film = {48, 48, {}};
        scene.render.photons_per_pass = 100000;
        scene.render.radius_mm = 4.0;
        double form = 0.0;  // mean over the square that is seen [1/mm^2]
        const int steps = 200;
        for (int i = 0; i < steps; ++i)
            for (int j = 0; j < steps; ++j) {
                const double x = x_mm + edge_mm * ((i + 0.5) / steps - 0.5), z = edge_mm * ((j + 0.5) / steps - 0.5);
                form += height_mm / std::pow(x * x + z * z + height_mm * height_mm, 1.5) / (4.0 * M_PI * steps * steps);
            }
        const Sample ratio = brightness(scene, scene.lights[0].flux.scaled(form * 1e6 * reflectance / M_PI), 24);
        CAPTURE(ratio.mean(), ratio.standard_error());
        CHECK(ratio.standard_error() < 0.01);
        CHECK(std::abs(ratio.mean() - 1.0) < 4.5 * ratio.standard_error() + 0.002);
    }
}
