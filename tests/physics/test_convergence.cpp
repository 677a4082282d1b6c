#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

constexpr double height_mm = 60.0, edge_mm = 160.0, reflectance = 0.7;
constexpr int pixels = 16;

// A diffuse floor under a sphere that emits: irradiance Phi h / (4 pi (h^2 + x^2)^(3/2)), smooth and known,
// with curvature for the radius to blur. The range is sixteen integers, so that all passes have the same
// wavelengths.
Scene ball_over_floor(std::uint32_t seed, Direct direct) {
    Scene scene = empty_scene("convergence");
    scene.render.emission = Emission::random;  // the expected slopes are those of independent photons
    scene.materials = {diffuse_material(reflectance), Material{}};
    add_shape(scene, "floor", 0, make_rectangle(2000.0, 2000.0));
    add_shape(scene, "lamp", 1, moved(make_sphere(4.0, 64), {0.0, height_mm, 0.0})).light = 0;
    scene.lights = {{"lamp", Spectrum::constant(1.0), SurfaceLight{1}}};
    // Below the lamp, whose back is not seen.
    scene.camera = camera_above({0.0, 0.0, 0.0}, 40.0, edge_mm);
    scene.film = {pixels, pixels, {}};
    scene.render.lambda_min_nm = 550;
    scene.render.lambda_max_nm = 565;
    scene.render.alpha = 2.0 / 3.0;
    scene.render.radius_mm = 16.0;
    scene.render.photons_per_pass = 3000;
    scene.render.seed = seed;
    scene.render.direct = direct;
    return scene;
}

// Y of the converged picture: the irradiance's mean over each pixel's square of the floor, by the midpoint
// rule.
std::vector<double> truth(const Scene& scene) {
    const double white = film_xyz(scene, 0, Spectrum::constant(1.0)).y;  // of a radiance of 1
    const int steps = 16;
    std::vector<double> result;
    for (int j = 0; j < pixels; ++j)
        for (int i = 0; i < pixels; ++i) {
            double irradiance = 0.0;  // [W m^-2 nm^-1]
            for (int v = 0; v < steps; ++v)
                for (int u = 0; u < steps; ++u) {
                    const double x = edge_mm * ((i + (u + 0.5) / steps) / pixels - 0.5);
                    const double z = edge_mm * ((j + (v + 0.5) / steps) / pixels - 0.5);
                    irradiance += 1e6 * height_mm / std::pow(x * x + z * z + height_mm * height_mm, 1.5) /
                                  (4.0 * M_PI * steps * steps);
                }
            result.push_back(white * reflectance * irradiance / M_PI);
        }
    return result;
}

// Slope of the least-squares line of log y over log x.
double log_slope(const std::vector<double>& x, const std::vector<double>& y) {
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double u = std::log(x[i]), v = std::log(y[i]);
        sx += u, sy += v, sxx += u * u, sxy += u * v;
    }
    const double n = static_cast<double>(x.size());
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

std::vector<double> doublings(double first, double last) {
    std::vector<double> counts;
    for (double n = first; n <= last; n *= 2.0) counts.push_back(n);
    return counts;
}

double measured_slope(std::uint32_t seed, const std::vector<double>& counts, Direct direct) {
    const Scene scene = ball_over_floor(seed, direct);
    const std::vector<double> expected = truth(scene);
    Renderer renderer(test_device(), scene);
    std::vector<double> errors;
    for (const double count : counts) {
        while (renderer.passes() < count) renderer.render_pass(renderer.passes());
        const FilmImage image = renderer.image();
        double sum = 0.0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const double error = static_cast<double>(image.xyz[3][3 * i + 1]) - expected[i];
            sum += error * error;
        }
        errors.push_back(std::sqrt(sum / static_cast<double>(expected.size())));
    }
    return log_slope(counts, errors);
}

// What the schedule of radii itself gives over those passes: the bias of a pass goes with r^2 and its
// variance with 1/r^2 (Knaus and Zwicker 2011, sections 4.1 and 4.2), so the mean's bias with sum(r^2)/N and
// its standard deviation with sqrt(sum(1/r^2))/N. Both tend to N^(-1/3).
struct Slopes {
    double bias, deviation;
};
Slopes expected_slopes(const std::vector<double>& counts) {
    std::vector<double> bias, deviation;
    for (const double count : counts) {
        double squares = 0.0, inverse = 0.0, square = 1.0;
        for (double i = 1.0; i <= count; ++i) {
            squares += square;
            inverse += 1.0 / square;
            square *= (i + 2.0 / 3.0) / (i + 1.0);
        }
        bias.push_back(squares / count);
        deviation.push_back(std::sqrt(inverse) / count);
    }
    return {log_slope(counts, bias), log_slope(counts, deviation)};
}

// The error is made of both, so its slope lies between theirs, give or take the spread over seeds.
void check_convergence(double last, std::uint32_t seeds) {
    const std::vector<double> counts = doublings(8.0, last);
    const Slopes expected = expected_slopes(counts);
    Sample slope;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) slope.add(measured_slope(seed, counts, Direct::photons));
    CAPTURE(slope.mean(), slope.standard_error(), expected.bias, expected.deviation);
    CHECK(slope.standard_error() < 0.03);
    CHECK(slope.mean() > std::min(expected.bias, expected.deviation) - 3.0 * slope.standard_error());
    CHECK(slope.mean() < std::max(expected.bias, expected.deviation) + 3.0 * slope.standard_error());
    // PHYSICS section 7: near -1/3. A fixed radius would give a slope towards 0 where the bias rules and -1/2
    // where the noise does.
    CHECK(std::abs(slope.mean() + 1.0 / 3.0) < 0.08);
}

}  // namespace

TEST_CASE("the error falls with the cube root of the passes", "[convergence]") { check_convergence(128.0, 8); }

// All light here is direct: without photons nothing is blurred, and independent draws would give a slope of -1/2. Those
// of a pixel are spread over the passes.
TEST_CASE("the error of direct light by rays falls faster than the root of the passes", "[convergence]") {
    const std::vector<double> counts = doublings(8.0, 128.0);
    Sample slope;
    for (std::uint32_t seed = 1; seed <= 4; ++seed) slope.add(measured_slope(seed, counts, Direct::rays));
    CAPTURE(slope.mean(), slope.standard_error());
    CHECK(slope.mean() < -0.6);
    CHECK(slope.standard_error() < 0.03);
}

TEST_CASE("the error falls with the cube root of up to 512 passes", "[convergence][.long]") {
    check_convergence(512.0, 16);
}
