#include <array>
#include <cmath>

#include "host/subsurface/paper_transport.hpp"
#include "host/subsurface/power_table.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/photon_passes.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

Scene without_tables(Scene scene) {
    scene.render.tables = false;
    return scene;
}

double power_of(std::uint32_t component, const Medium& medium, double lambda_nm, double r_mm, double theta_deg) {
    const RefractionAngle theta = RefractionAngle::from_degrees(theta_deg);
    const double sigma_s = medium.sigma_s.at(lambda_nm), sigma_a = medium.sigma_a.at(lambda_nm);
    if (component == STOKES_MAP_FLUORESCENCE) return fluorescence_power(sigma_s + sigma_a, r_mm, theta);
    if (component == STOKES_MAP_SINGLE) return single_power(sigma_s, sigma_s + sigma_a, r_mm, theta);
    return multiple_power(sigma_a, sigma_s + sigma_a, dipole_boundary(medium.dipole_eta), r_mm);
}

// E[T(r)] at each of the pass's wavelengths for r in [0, 9.9] mm with density proportional to T's mean over
// the tables' wavelengths, by Simpson's rule in double precision; r = 9.9 x^2 smooths T at r = 0.
std::array<double, 16> mean_power(std::uint32_t component, const Medium& medium, double theta_deg,
                                  const float* lambda_nm) {
    const TableGrid grid;
    std::array<double, 16> result{};
    double total = 0.0;
    const int steps = 400;
    for (int i = 0; i <= steps; ++i) {
        const double x = double(i) / steps, r = 9.9 * x * x;
        double density = 0.0;
        for (const double lambda : grid.lambda_nm) density += power_of(component, medium, lambda, r, theta_deg);
        density *= x * (i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0);
        total += density;
        for (std::size_t k = 0; k < 16; ++k)
            result[k] += density * power_of(component, medium, double(lambda_nm[k]), r, theta_deg);
    }
    for (double& v : result) v /= total;
    return result;
}

// Light along the paths and per component in the picture, pass by pass.
struct Passes {
    std::array<Sample, layer_count> luminance;
    std::array<Sample, 4> light;  // stored, absorbed, Stokes loss, escaped, as shares of what was emitted
    double radius_mm = 0.0;
};

Passes rendered(Scene scene, std::uint32_t seed, std::uint32_t passes) {
    scene.render.seed = seed;
    Renderer renderer(test_device(), scene);
    PassImages images(renderer);
    Passes result;
    Balance before{};
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const FilmImage image = images.next(pass);
        for (std::size_t c = 0; c < layer_count; ++c) result.luminance[c].add(mean_xyz(image, static_cast<Layer>(c)).y);
        // The ledger is a mean over passes.
        const Balance now = renderer.book().ledger().power;
        const double n = pass + 1.0;
        const auto own = [&](double Balance::*part) { return n * now.*part - (n - 1.0) * before.*part; };
        const double emitted = own(&Balance::emitted);
        result.light[0].add(own(&Balance::stored) / emitted);
        result.light[1].add(own(&Balance::absorbed) / emitted);
        result.light[2].add(own(&Balance::stokes_loss) / emitted);
        result.light[3].add(own(&Balance::escaped) / emitted);
        before = now;
    }
    CHECK(std::abs(before.imbalance()) < 1e-4);
    result.radius_mm = renderer.first_radius();
    return result;
}

// Welch's t as a normal deviate; 0 where neither varies and both are the same.
double deviate(const Sample& a, const Sample& b) {
    const double error = std::hypot(a.standard_error(), b.standard_error());
    if (error == 0.0) return a.mean() == b.mean() ? 0.0 : 1e3;
    return normal_of_t((a.mean() - b.mean()) / error, double(std::min(a.count(), b.count()) - 1));
}

}  // namespace

// Flux in the maps against its expectation, of which nothing is interpolated: c * re-radiated flux * E[T_F],
// (1 - c) * flux * E[T_S] and the same with T_M. 90 comparisons at 4.5 standard errors; the quadratures in
// the kernels may be off by 7e-4.
TEST_CASE("photons that integrate their power store what eq. 3-5 say", "[integrated]") {
    for (const double angle_deg : {0.0, 50.0}) {
        const Scene scene = without_tables(slab_scene(0.4, angle_deg));
        PhotonPasses passes(scene);
        const PhotonAccount account = passes.trace(3);
        CHECK(account.missed_exits == 0);
        CHECK(account.refused_slots == 0);
        const double photons = static_cast<double>(scene.render.photons_per_pass);
        const double theta_deg = std::asin(std::sin(angle_deg * M_PI / 180.0) / 1.5) * 180.0 / M_PI;
        const PassConstants& pass = passes.constants();
        for (const std::uint32_t component : {STOKES_MAP_FLUORESCENCE, STOKES_MAP_SINGLE, STOKES_MAP_MULTIPLE}) {
            const auto power = mean_power(component, scene.media[0], theta_deg, pass.lambda_nm);
            const std::vector<Flux16> flux = passes.flux(component);
            for (std::size_t i = 0; i < 16; ++i) {
                const auto lambda = [&](std::size_t k) { return static_cast<double>(pass.lambda_nm[k]); };
                double start = scene.lights[0].flux.at(lambda(i));
                if (component == STOKES_MAP_FLUORESCENCE) {
                    start = 0.0;
                    for (std::size_t j = 0; j < i; ++j)
                        start += scene.lights[0].flux.at(lambda(j)) * 0.02 *
                                 scene.fluorophores[0].excitation.at(lambda(j)) *
                                 scene.fluorophores[0].emission.at(lambda(i)) * pair_weight_nm(300, 780);
                }
                const double expected = start * power[i] * (component == STOKES_MAP_FLUORESCENCE ? 0.4 : 0.6);
                Sample sample;
                for (const Flux16& f : flux) sample.add(static_cast<double>(f.v[i]));
                // Binomial number of events times the spread of their flux.
                const double share = static_cast<double>(sample.count()) / photons, mean = sample.mean() * share;
                const double second = (sample.variance() + sample.mean() * sample.mean()) * share;
                const double sum = mean * photons, error = std::sqrt(std::max(second - mean * mean, 0.0) * photons);
                CAPTURE(angle_deg, component, lambda(i), sum, expected, error);
                CHECK(std::abs(sum - expected) <= 4.5 * error + 7e-4 * expected);
                if (expected > 0.0) CHECK(error < 0.02 * expected);
            }
        }
    }
}

// Three seeds with and three without; the wavelengths are the same in all passes, so that the photons alone
// vary. The deviates of light and of the picture's components: 24, together wrong once in 1000. The tables'
// interpolation is off by some 1e-3, a tenth of the standard errors.
TEST_CASE("renders with and without tables agree, component by component", "[integrated]") {
    Scene scene = small_scene();
    scene.render.lambda_min_nm = 500;
    scene.render.lambda_max_nm = 515;
    scene.render.radius_mm = 6.0;
    const std::uint32_t passes = 24;
    const double level = sidak_level(1e-3, 24);
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        const Passes with = rendered(scene, 2 * seed, passes);
        const Passes without = rendered(without_tables(scene), 2 * seed + 1, passes);
        for (std::size_t c = 0; c < layer_count; ++c) {
            CAPTURE(seed, c, with.luminance[c].mean(), without.luminance[c].mean());
            CHECK(with.luminance[c].mean() > 0.0);
            CHECK(normal_two_sided(deviate(with.luminance[c], without.luminance[c])) > level);
        }
        for (std::size_t k = 0; k < with.light.size(); ++k) {
            CAPTURE(seed, k, with.light[k].mean(), without.light[k].mean());
            CHECK(normal_two_sided(deviate(with.light[k], without.light[k])) > level);
        }
    }
}

// What is left to chance is the same: the spread of a pass, with and without tables, by an F test's normal
// approximation (log of the ratio of variances, of variance 4/n), in the three components together.
TEST_CASE("renders without tables are no noisier", "[integrated]") {
    Scene scene = small_scene();
    scene.render.lambda_min_nm = 500;
    scene.render.lambda_max_nm = 515;
    scene.render.radius_mm = 6.0;
    const std::uint32_t passes = 48;
    const Passes with = rendered(scene, 21, passes), without = rendered(without_tables(scene), 22, passes);
    for (std::size_t c = 0; c < 3; ++c) {
        const double ratio = without.luminance[c].variance() / with.luminance[c].variance();
        CAPTURE(c, ratio);
        CHECK(std::abs(std::log(ratio)) < 3.5 * std::sqrt(4.0 / passes));
    }
}

TEST_CASE("without tables none is made, and the first radius is the same within its noise", "[integrated]") {
    Device device = Device::open("cpu");
    const Scene scene = small_scene();
    Renderer with(device, scene);
    with.render_pass(0);
    device.finish();
    CHECK(device.stage_times().count("resample_table") == 1);
    device.reset_stage_times();
    Renderer without(device, without_tables(scene));
    without.render_pass(0);
    device.finish();
    CHECK(device.stage_times().count("resample_table") == 0);
    CHECK(device.stage_times().count("sample_exits") == 0);
    CHECK(device.stage_times().count("integrate_power") == 1);
    CHECK(without.first_radius() == Approx(with.first_radius()).epsilon(0.05));
}
