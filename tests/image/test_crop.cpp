// A crop of a picture is that part of it.
#include <cmath>
#include <utility>

#include "host/image/compare.hpp"
#include "host/render/renderer.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

constexpr std::uint32_t passes = 48;
constexpr int width = 64, height = 48;  // of the whole picture
constexpr int left = 28, top = 18;      // of the crop in it
constexpr int crop_width = 20, crop_height = 16;

RgbLayers render(Scene scene, int columns, int rows, const Crop& crop) {
    scene.film = {columns, rows, {}};
    scene.camera.crop = crop;
    Renderer renderer(test_device(), scene);
    for (std::uint32_t pass = 0; pass < passes; ++pass) renderer.render_pass(pass);
    return film_layers(renderer.image());
}

std::vector<float> part(const std::vector<float>& rgb, int x0, int y0) {
    std::vector<float> result;
    for (int y = y0; y < y0 + crop_height; ++y)
        for (int i = 3 * x0; i < 3 * (x0 + crop_width); ++i)
            result.push_back(rgb[static_cast<std::size_t>(3 * width * y + i)]);
    return result;
}

}  // namespace

// Photons, wavelengths and radii are the same; the rays alone lie elsewhere in their pixels. What that makes is well
// below what a shift by one pixel does.
TEST_CASE("a crop is its part of the picture, and of no other place in it", "[crop]") {
    const Radii radii = GENERATE(Radii::one, Radii::local);
    CAPTURE(static_cast<int>(radii));
    Scene scene = small_scene(Transport::conserving);
    scene.render.emission = Emission::aimed;
    scene.render.radius_mm = 12.0;
    scene.render.radii = radii;
    const RgbLayers whole = render(scene, width, height, {});
    const RgbLayers crop = render(scene, crop_width, crop_height,
                                  {static_cast<double>(left) / width, static_cast<double>(top) / height,
                                   static_cast<double>(crop_width) / width, static_cast<double>(crop_height) / height});
    for (const std::string& layer : layers_in_order(whole)) {
        CAPTURE(layer);
        const auto compare_at = [&](int x, int y) {
            return compare_layer(crop.at(layer), part(whole.at(layer), x, y), crop_width);
        };
        const LayerError here = compare_at(left, top);
        CHECK(here.reference_mean > 0.0);
        CHECK(std::abs(here.mean_error) < 0.03 * here.reference_mean);
        for (const auto& [x, y] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)})
            CHECK(compare_at(left + x, top + y).rmse > 1.5 * here.rmse);
    }
}

TEST_CASE("a crop has the first radius of the whole picture", "[crop]") {
    Scene scene = small_scene(Transport::conserving);
    const double radius_mm = Renderer(test_device(), scene).first_radius();
    for (const Crop& crop : {Crop{0.5, 0.5, 0.125, 0.125}, Crop{0.0, 0.0, 0.01, 0.01}}) {
        scene.camera.crop = crop;
        CHECK(Renderer(test_device(), scene).first_radius() == radius_mm);
    }
}
