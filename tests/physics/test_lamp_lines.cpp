// A lamp whose lines are narrower than the nanometres that the renderer knows.
#include <fmt/format.h>

#include <array>

#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/paths.hpp"

using namespace stokes;

namespace {

// A floor of reflectance 0.8 under 10 W/m^2, seen from above.
Scene lit_floor(const std::string& spectrum) {
    const std::string text = R"({"format": "stokes-scene", "version": 1,
        "render": {"emission": "random", "photons_per_pass": 64}, "film": {"width": 4, "height": 4},
        "camera": {"position_mm": [0, 200, 0], "target_mm": [0, 0, 0], "up": [0, 0, -1], "vertical_fov_deg": 6},
        "materials": {"white": {"type": "diffuse", "reflectance": 0.8}},
        "lights": [{"type": "beam", "section": "disk", "position_mm": [0, 100, 0], "direction": [0, -1, 0],
                    "radius_mm": 150, "irradiance_W_m2": 10, "spectrum": )" +
                             spectrum + R"(}],
        "shapes": [{"type": "rectangle", "width_mm": 100, "height_mm": 100, "material": "white"}]})";
    return parse_scene(text, source_path("tests/physics/scene.json"));
}

}  // namespace

// 683.002 lm/W times 0.8 * 10 W/m^2 / pi, times the integral of lamp and colour matching function over that of the
// lamp, both by the trapezium rule in steps of 0.1 nm: X, Y, Z = 516.7, 561.7, 559.0 cd/m^2, x, y = 0.3155, 0.3430.
TEST_CASE("a lamp of fine lines has the colour of its integral", "[lamp_lines]") {
    const Scene scene = lit_floor(R"({"file": "mercury_lamp.csv", "column": "power"})");
    Renderer renderer(test_device(), scene);
    PassImages images(renderer);
    std::array<Sample, 3> means;
    for (std::uint32_t pass = 0; pass < 768; ++pass) {
        const glm::dvec3 xyz = mean_xyz(images.next(pass), Layer::surface);
        for (int c = 0; c < 3; ++c) means[static_cast<std::size_t>(c)].add(xyz[c]);
    }
    const double expected[] = {516.7, 561.7, 559.0};
    for (std::size_t c = 0; c < 3; ++c) {
        CAPTURE(c, means[c].mean(), means[c].standard_error());
        CHECK(means[c].standard_error() < 0.01 * expected[c]);
        // Bins of 1 nm blur what lies at a line by up to 0.5 nm: by 0.2 % in X.
        CHECK(std::abs(means[c].mean() - expected[c]) < 4.0 * means[c].standard_error() + 3e-3 * expected[c]);
    }
    const double sum = means[0].mean() + means[1].mean() + means[2].mean();
    CHECK(means[0].mean() / sum == Approx(0.3155).margin(2e-3));
    CHECK(means[1].mean() / sum == Approx(0.3430).margin(2e-3));

    // The same without noise.
    Spectrum radiance = scene.lights[0].flux;
    radiance = radiance.scaled(0.8 * 10.0 / M_PI / radiance.sum_1nm(300, 780));
    const glm::dvec3 exact = xyz_of(radiance);
    for (int c = 0; c < 3; ++c) CHECK(exact[c] == Approx(expected[c]).epsilon(3e-3));
}

// Laser lines of 0.02 nm, each of which lies within one nanometre, at their share of the power.
TEST_CASE("lines at any place between whole nanometres keep their power", "[lamp_lines]") {
    for (const double at_nm : {532.0, 532.25, 532.499, 532.75}) {
        CAPTURE(at_nm);
        const Scene scene = lit_floor(fmt::format(R"({{"pairs": [[{0}, 0], [{1}, 1], [{2}, 0], [632, 0], [632.5, 0.04],
                                                      [633, 0]]}})",
                                                  at_nm - 0.02, at_nm, at_nm + 0.02));
        const Spectrum& flux = scene.lights[0].flux;
        // Areas of 0.02 and 0.02.
        CHECK(flux.sum_1nm(531, 534) == Approx(flux.sum_1nm(631, 634)).epsilon(1e-6));
    }
}
