#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "kernels/shared/limits.h"
// limits.h comes first: it has the size check.
#include "kernels/shared/power_table.h"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

// Twelve distances 0, 0.01 .. 10.24 mm and five rows 0, 0.1 .. 2.7, in both of which the density changes a
// lot.
TableShape log_shape(unsigned offset) {
    TableShape shape{};
    shape.offset = offset;
    shape.row_count = 5;
    shape.row_first = 0.1f;
    shape.row_step = static_cast<float>(std::log2(3.0));
    shape.r_count = 12;
    shape.r_first = 0.01f;
    shape.r_step = 1.0f;
    shape.log_axes = STOKES_LOG_ROWS | STOKES_LOG_R;
    return shape;
}

double node(double first, double octaves, std::size_t i) {
    return i == 0 ? 0.0 : first * std::exp2(octaves * static_cast<double>(i - 1));
}

struct LogTable {
    TableShape shape = log_shape(7);
    std::vector<double> r, row;
    std::vector<float> mean, cumulative;

    LogTable() : mean(shape.offset, -5.0f), cumulative(shape.offset, 99.0f) {
        for (std::size_t i = 0; i < shape.r_count; ++i) r.push_back(node(0.01, 1.0, i));
        for (std::size_t i = 0; i < shape.row_count; ++i) row.push_back(node(0.1, std::log2(3.0), i));
        for (const double depth : row) {
            double integral = 0.0;
            for (std::size_t i = 0; i < r.size(); ++i) {
                mean.push_back(static_cast<float>(r[i] * std::exp(-r[i] / (0.3 + depth)) + 0.002));
                if (i > 0) integral += 0.5 * (double(mean.back()) + double(mean[mean.size() - 2])) * (r[i] - r[i - 1]);
                cumulative.push_back(static_cast<float>(integral));
            }
        }
    }
    // The density at the nodes, linear between the rows in their value.
    std::vector<double> density(double at) const {
        const auto above = std::upper_bound(row.begin() + 1, row.end() - 1, at) - row.begin();
        const double w = std::clamp((at - row[above - 1]) / (row[above] - row[above - 1]), 0.0, 1.0);
        std::vector<double> result;
        for (std::size_t i = 0; i < r.size(); ++i)
            result.push_back((1.0 - w) * double(mean[shape.offset + (above - 1) * r.size() + i]) +
                             w * double(mean[shape.offset + above * r.size() + i]));
        return result;
    }
};

std::vector<float> draw(const LogTable& table, float row, const std::vector<float>& u) {
    Device& device = test_device();
    const Buffer<float> mean(device, "mean rows", table.mean), cumulative(device, "cumulative rows", table.cumulative);
    const Buffer<float> rows(device, "rows", std::vector<float>(u.size(), row)), uniforms(device, "u", u);
    const Buffer<float> distances(device, "distances", u.size());
    test_program("power_table.cl")
        .kernel("draw_distances")
        .launch(u.size(), Arguments()
                              .add("mean_rows", mean)
                              .add("cumulative_rows", cumulative)
                              .add("shape", table.shape)
                              .add("theta_deg", rows)
                              .add("u", uniforms)
                              .add("r_mm", distances)
                              .add("n", static_cast<std::uint32_t>(u.size())));
    return distances.download();
}

// Integral of the piecewise linear density between its nodes i and i + 1, up to fraction x.
double cell_integral(const LogTable& table, const std::vector<double>& f, std::size_t i, double x) {
    return (table.r[i + 1] - table.r[i]) * x * (f[i] + 0.5 * x * (f[i + 1] - f[i]));
}

}  // namespace

// Seven chi-square tests with quarter cells as bins, together wrong once in 1000.
TEST_CASE("distances on a logarithmic axis follow their density", "[log_axis]") {
    const LogTable table;
    const double level = sidak_level(1e-3, 7);
    std::mt19937 generator(5);
    for (const float row : {0.0f, 0.04f, 0.1f, 0.5f, 0.9f, 2.69f, 8.0f}) {
        CAPTURE(row);
        std::vector<float> u(1u << 18);
        for (float& x : u) x = static_cast<float>(generator() >> 8) * 0x1p-24f;
        std::vector<float> r = draw(table, row, u);
        std::sort(r.begin(), r.end());
        const std::vector<double> f = table.density(row);
        std::vector<double> observed, expected;
        double total = 0.0;
        for (std::size_t i = 0; i + 1 < f.size(); ++i) {
            double before = 0.0;
            for (const double x : {0.25, 0.5, 0.75, 1.0}) {
                const auto edge = static_cast<float>(table.r[i] + x * (table.r[i + 1] - table.r[i]));
                const bool last = i + 2 == f.size() && x == 1.0;
                const auto below = last ? r.end() : std::lower_bound(r.begin(), r.end(), edge);
                observed.push_back(static_cast<double>(below - r.begin()));
                expected.push_back(cell_integral(table, f, i, x) - before);
                before += expected.back();
            }
            total += before;
        }
        for (std::size_t i = observed.size(); i-- > 1;) observed[i] -= observed[i - 1];
        for (double& e : expected) e *= static_cast<double>(u.size()) / total;
        CHECK(chi_square_p_value(observed, expected) > level);
        CHECK(r.front() >= 0.0f);
        CHECK(r.back() <= 10.24f * 1.0001f);
    }
}

TEST_CASE("look-ups on logarithmic axes are bilinear in the values", "[log_axis][tiny]") {
    const LogTable table;
    std::vector<Flux16> values(table.mean.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        for (int j = 0; j < 16; ++j) values[i].v[j] = table.mean[i] * static_cast<float>(j + 1);
    const std::vector<float> rows{0.0f, 0.03f, 0.1f, 0.25f, 2.0f, 2.7f, 50.0f, 0.9f};
    const std::vector<float> r_mm{0.0f, 0.005f, 0.01f, 0.015f, 3.0f, 10.24f, 99.0f, 0.64f};
    Device& device = test_device();
    const Buffer<Flux16> table16(device, "table", values), out(device, "out", rows.size());
    const Buffer<float> r(device, "r", r_mm), row(device, "rows", rows);
    test_program("power_table.cl")
        .kernel("look_up")
        .launch(rows.size(), Arguments()
                                 .add("table16", table16)
                                 .add("shape", table.shape)
                                 .add("r_mm", r)
                                 .add("theta_deg", row)
                                 .add("out", out)
                                 .add("n", static_cast<std::uint32_t>(rows.size())));
    const std::vector<Flux16> found = out.download();
    for (std::size_t k = 0; k < rows.size(); ++k) {
        CAPTURE(k);
        const std::vector<double> f = table.density(rows[k]);
        const auto above = std::upper_bound(table.r.begin() + 1, table.r.end() - 1, double(r_mm[k])) - table.r.begin();
        const double x =
            std::clamp((double(r_mm[k]) - table.r[above - 1]) / (table.r[above] - table.r[above - 1]), 0.0, 1.0);
        const double expected = (1.0 - x) * f[above - 1] + x * f[above];
        for (int j = 0; j < 16; ++j) CHECK(double(found[k].v[j]) == Approx(expected * (j + 1)).epsilon(2e-5));
    }
}
