#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "host/subsurface/distance_sampler.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

MediumSpectra marble() {
    return {"marble", {{464.0, 611.0}, {1.5, 1.1}, Outside::hold}, {{464.0, 611.0}, {0.007, 0.002}, Outside::hold}};
}

// The density a table asks for at one angle, in double precision from the table's own values: the mean over
// all wavelengths, linear between angles, piecewise linear in r.
struct AnalyticDensity {
    std::vector<double> r_mm, mean, cumulative;

    AnalyticDensity(const PowerTable& table, double theta_deg) : r_mm(table.axis("r")->values) {
        const TableAxis* theta = table.axis("theta");
        const std::size_t rows = theta ? theta->values.size() : 1, lambdas = table.axis("lambda")->values.size();
        std::size_t row = 0;
        while (row + 2 < rows && theta->values[row + 1] <= theta_deg) ++row;
        const std::size_t next = std::min(row + 1, rows - 1);
        const double w =
            rows == 1
                ? 0.0
                : std::clamp((theta_deg - theta->values[row]) / (theta->values[next] - theta->values[row]), 0.0, 1.0);
        for (std::size_t r = 0; r < r_mm.size(); ++r) {
            double sum = 0.0;
            for (std::size_t i = 0; i < lambdas; ++i)
                sum += (1.0 - w) * table.values[(r * rows + row) * lambdas + i] +
                       w * table.values[(r * rows + next) * lambdas + i];
            mean.push_back(sum / static_cast<double>(lambdas));
            cumulative.push_back(r == 0 ? 0.0
                                        : cumulative.back() + 0.5 * (mean[r - 1] + mean[r]) * (r_mm[r] - r_mm[r - 1]));
        }
    }
    // Probability of a distance below r.
    double below(double r) const {
        if (r <= r_mm.front()) return 0.0;
        if (r >= r_mm.back()) return 1.0;
        const std::size_t i = std::upper_bound(r_mm.begin(), r_mm.end(), r) - r_mm.begin() - 1;
        const double x = r - r_mm[i], slope = (mean[i + 1] - mean[i]) / (r_mm[i + 1] - r_mm[i]);
        return (cumulative[i] + x * (mean[i] + 0.5 * slope * x)) / cumulative.back();
    }
    // integral r^power p(r) dr by Simpson, exact for power 1, within each cell
    double moment(int power) const {
        double sum = 0.0;
        for (std::size_t i = 0; i + 1 < r_mm.size(); ++i) {
            const double middle = 0.5 * (r_mm[i] + r_mm[i + 1]);
            sum += (r_mm[i + 1] - r_mm[i]) / 6.0 *
                   (std::pow(r_mm[i], power) * mean[i] + std::pow(middle, power) * 2.0 * (mean[i] + mean[i + 1]) +
                    std::pow(r_mm[i + 1], power) * mean[i + 1]);
        }
        return sum / cumulative.back();
    }
};

// The distances the kernel draws for each u, at one angle. The sampler's rows are put behind an unrelated
// table to exercise the offset.
std::vector<float> draw(const PowerTable& table, float theta_deg, const std::vector<float>& u) {
    const std::size_t offset = 13;
    const DistanceSampler sampler = make_distance_sampler(table, offset);
    std::vector<float> mean(offset, 1e3f), cumulative(offset, -1.0f);
    mean.insert(mean.end(), sampler.mean_rows.begin(), sampler.mean_rows.end());
    cumulative.insert(cumulative.end(), sampler.cumulative_rows.begin(), sampler.cumulative_rows.end());
    Device& device = test_device();
    const Buffer<float> mean_rows(device, "mean rows", mean), cumulative_rows(device, "cumulative rows", cumulative);
    const Buffer<float> angles(device, "angles", std::vector<float>(u.size(), theta_deg)), uniforms(device, "u", u);
    const Buffer<float> distances(device, "distances", u.size());
    // Built once, and never released: a simulator's own statics may be gone when this file's are destroyed.
    static Kernel& kernel = *new Kernel(test_program("power_table.cl").kernel("draw_distances"));
    kernel.launch(u.size(), Arguments()
                                .add("mean_rows", mean_rows)
                                .add("cumulative_rows", cumulative_rows)
                                .add("shape", sampler.shape)
                                .add("theta_deg", angles)
                                .add("u", uniforms)
                                .add("r_mm", distances)
                                .add("n", static_cast<std::uint32_t>(u.size())));
    return distances.download();
}

std::vector<float> uniforms(std::size_t count, unsigned seed) {
    std::mt19937 generator(seed);
    std::vector<float> u(count);
    for (float& x : u) x = static_cast<float>(generator() >> 8) * 0x1p-24f;
    return u;
}

// Of the chi-square test with half cells of the table as bins.
double distribution_p_value(const std::vector<float>& samples, const AnalyticDensity& density) {
    std::vector<float> sorted = samples;
    std::sort(sorted.begin(), sorted.end());
    std::vector<double> observed, expected;
    double from = 0.0;
    auto start = sorted.begin();
    const std::size_t bins = 2 * (density.r_mm.size() - 1);
    for (std::size_t i = 1; i <= bins; ++i) {
        const double edge = 0.5 * (density.r_mm[i / 2] + density.r_mm[(i + 1) / 2]);
        const auto end = i == bins ? sorted.end() : std::lower_bound(start, sorted.end(), static_cast<float>(edge));
        observed.push_back(static_cast<double>(end - start));
        expected.push_back(static_cast<double>(samples.size()) * (density.below(edge) - from));
        from = density.below(edge);
        start = end;
    }
    return chi_square_p_value(observed, expected);
}

struct Case {
    PowerTable table;
    std::vector<float> theta_deg;
};

// On grid rows, between them, and beyond the last row, where it is held.
std::vector<Case> cases() {
    const std::vector<float> angles = {0.0f, 0.45f, 27.0f, 41.17f, 88.2f, 88.9f, 89.1f, 90.0f};
    return {{make_fluorescence_table(marble()), angles},
            {make_single_table(marble()), angles},
            {make_multiple_table(marble()), {0.0f, 55.5f}}};
}
constexpr int case_count = 18;

}  // namespace

// Family of 18 chi-square and 18 mean tests, together wrong once in 1000: Sidak level 1 - 0.999^(1/36) each.
TEST_CASE("distances follow the table's mean over all wavelengths", "[sample_distance]") {
    const double level = sidak_level(1e-3, 2 * case_count);
    unsigned seed = 1;
    for (const Case& c : cases())
        for (float theta_deg : c.theta_deg) {
            CAPTURE(c.table.component, theta_deg);
            const AnalyticDensity density(c.table, theta_deg);
            const std::vector<float> r = draw(c.table, theta_deg, uniforms(1u << 18, seed++));
            CHECK(distribution_p_value(r, density) > level);

            double sum = 0.0;
            for (float x : r) sum += x;
            const auto count = static_cast<double>(r.size());
            const double mean = density.moment(1), variance = density.moment(2) - mean * mean;
            CHECK(normal_two_sided((sum / count - mean) / std::sqrt(variance / count)) > level);
        }
    CHECK(seed == case_count + 1);
}

// Single precision: the cumulative distribution rounds to 2^-24, its inverse adds a few units in the last
// place.
TEST_CASE("a distance is the inverse of the cumulative distribution at u", "[sample_distance]") {
    std::vector<float> u = uniforms(4096, 99);
    u.push_back(0.0f);
    u.push_back(0x1p-24f);
    u.push_back(1.0f - 0x1p-24f);
    std::sort(u.begin(), u.end());
    for (const Case& c : cases())
        for (float theta_deg : c.theta_deg) {
            CAPTURE(c.table.component, theta_deg);
            const AnalyticDensity density(c.table, theta_deg);
            const std::vector<float> r = draw(c.table, theta_deg, u);
            CHECK(r.front() == 0.0f);
            double worst = 0.0;
            for (std::size_t i = 0; i < u.size(); ++i) {
                REQUIRE(r[i] >= 0.0f);
                REQUIRE(r[i] <= 9.9f * (1.0f + 1e-6f));
                if (i > 0) REQUIRE(r[i] >= r[i - 1] - 2e-6f);  // two units in the last place at 9.9
                worst = std::max(worst, std::abs(density.below(r[i]) - static_cast<double>(u[i])));
            }
            CHECK(worst < 1e-6);
        }
}

TEST_CASE("distances stay within the table where its density vanishes", "[sample_distance][tiny]") {
    TableGrid grid;
    grid.r_mm = {0.0, 0.1, 0.2, 0.3};
    grid.theta_deg = {0.0, 45.0};
    grid.lambda_nm = {400.0, 500.0};
    const std::vector<float> u = {0.0f, 0.25f, 0.75f, 1.0f - 0x1p-24f};

    // Nothing scatters, so single scattering is 0 everywhere: uniform over all distances.
    const MediumSpectra absorber{"ink", Spectrum::constant(0.0), Spectrum::constant(1.0)};
    const std::vector<float> uniform = draw(make_single_table(absorber, grid), 10.0f, u);
    for (std::size_t i = 0; i < u.size(); ++i) CHECK(uniform[i] == Approx(0.3f * u[i]).margin(1e-6));

    // So dense that all of the density lies in the first cell, falling linearly from r = 0 (at its far end a
    // rounding of 2^-24 in the probability moves the distance by 1e-4 of the cell): P(r < x) = 1 - (1
    // - x/h)^2.
    const MediumSpectra dense{"paint", Spectrum::constant(1e4), Spectrum::constant(0.0)};
    const std::vector<float> near = draw(make_fluorescence_table(dense, grid), 10.0f, u);
    for (std::size_t i = 0; i < u.size(); ++i)
        CHECK(near[i] == Approx(0.1 * (1.0 - std::sqrt(1.0 - static_cast<double>(u[i])))).margin(2e-5));
}
