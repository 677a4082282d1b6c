// The same picture, with less noise, where wavelengths are drawn by importance.
#include <array>
#include <cmath>
#include <string>

#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/paths.hpp"

using namespace stokes;

namespace {

constexpr std::uint32_t passes = 140;

using Layers = std::array<std::array<Sample, 3>, layer_count>;  // X, Y, Z

// Means over the picture of each layer, a sample a pass.
Layers measured(Scene scene, Wavelengths wavelengths) {
    scene.render.wavelengths = wavelengths;
    scene.render.emission = Emission::random;  // aimed photons have noise of their own where little light is
    scene.render.photons_per_pass = 24000;
    scene.render.radius_mm = 12.0;
    scene.render.alpha = 1.0;
    scene.film = {16, 12, {}};
    Renderer renderer(test_device(), scene);
    PassImages images(renderer);
    Layers layers;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const FilmImage image = images.next(pass);
        for (std::size_t c = 0; c < layer_count; ++c) {
            const glm::dvec3 xyz = mean_xyz(image, static_cast<Layer>(c));
            for (int k = 0; k < 3; ++k) layers[c][static_cast<std::size_t>(k)].add(xyz[k]);
        }
    }
    return layers;
}

void compare(const Scene& scene) {
    const Layers uniform = measured(scene, Wavelengths::uniform), importance = measured(scene, Wavelengths::importance);
    for (std::size_t c = 0; c < layer_count; ++c)
        for (std::size_t k = 0; k < 3; ++k) {
            const Sample &u = uniform[c][k], &i = importance[c][k];
            const double error = std::hypot(u.standard_error(), i.standard_error());
            CAPTURE(c, k, u.mean(), i.mean(), u.standard_error(), i.standard_error());
            CHECK(i.mean() > 0.0);
            CHECK(std::abs(u.mean() - i.mean()) < 3.5 * error);
            CHECK(i.standard_error() < 0.2 * i.mean());
            CHECK(i.variance() < 0.6 * u.variance());
        }
}

}  // namespace

// 24 comparisons of means at 3.5 standard errors, hardly independent: wrong by chance once in 100.
TEST_CASE("importance-drawn wavelengths give the same picture with less noise", "[wavelength_noise]") {
    const Scene scene = read_scene(source_path("scenes/sphere.json"));
    compare(scene);
    Scene walk = scene;
    walk.render.transport = Transport::walk;
    compare(walk);
}
