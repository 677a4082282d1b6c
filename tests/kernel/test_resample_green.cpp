#include <algorithm>
#include <cmath>
#include <vector>

#include "host/render/transport/green_resampler.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/input_error.hpp"

using namespace stokes;

namespace {

// H1 = a rho / (rho + z) exp(-rho (0.2 + 2 sqrt(1 - a))), scaled to the exact totals: log(H1/a) is linear in
// sqrt(1 - a).
double shape_of(double rho, double z, double albedo) {
    return albedo * rho / (rho + z + 0.05) * std::exp(-rho * (0.2 + 2.0 * std::sqrt(1.0 - albedo)));
}

const GreenTable& smooth_table() {
    static const GreenTable table = [] {
        GreenTable t = green_table_nodes(1.4);
        for (const double a : t.albedo)
            for (const double z : t.z)
                for (const double rho : t.rho) t.h1.push_back(static_cast<float>(shape_of(rho, z, a)));
        normalise_green_rows(t);
        return t;
    }();
    return table;
}

const GreenResampler::Sixteen kSigma{0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.45, 1.5, 1.6, 1.8, 1.9, 2.0};
const GreenResampler::Sixteen kAlbedo{0.0,  0.05, 0.3,  0.5,   0.7,   0.8,   0.9,    0.95,
                                      0.97, 0.98, 0.99, 0.995, 0.998, 0.999, 0.9998, 1.0};

double node(double first, double octaves, std::size_t i) {
    return i == 0 ? 0.0 : first * std::exp2(octaves * static_cast<double>(i - 1));
}

struct Resampled {
    TableShape shape;
    std::vector<Flux16> values, u1;
    std::vector<float> mean, cumulative;

    explicit Resampled(std::size_t offset = 0, std::size_t first_row = 0,
                       const GreenResampler::Sixteen& sigma = kSigma) {
        Device& device = test_device();
        shape = green_medium_shape(smooth_table(), 0.5, 2.0, offset);
        const std::size_t entries = offset + std::size_t{shape.row_count} * shape.r_count;
        const GreenPassTables pass{
            Buffer<Flux16>(device, "table", entries), Buffer<Flux16>(device, "u1", first_row + shape.row_count),
            Buffer<float>(device, "mean", entries), Buffer<float>(device, "cumulative", entries)};
        pass.table16.upload(std::vector<Flux16>(entries));
        pass.u1.upload(std::vector<Flux16>(pass.u1.size()));
        pass.mean_rows.upload(std::vector<float>(entries, -7.0f));
        pass.cumulative_rows.upload(std::vector<float>(entries, -7.0f));
        GreenResampler(device, smooth_table()).resample(shape, first_row, sigma, kAlbedo, pass);
        values = pass.table16.download();
        u1 = pass.u1.download();
        mean = pass.mean_rows.download();
        cumulative = pass.cumulative_rows.download();
    }
    double r(std::size_t i) const { return node(shape.r_first, shape.r_step, i); }
    double z(std::size_t i) const { return node(shape.row_first, shape.row_step, i); }
    std::size_t entry(std::size_t row, std::size_t i) const { return shape.offset + row * shape.r_count + i; }
};

}  // namespace

TEST_CASE("the medium's axes cover the universal table at every wavelength", "[resample_green]") {
    const GreenTable& table = smooth_table();
    const TableShape shape = green_medium_shape(table, 0.5, 2.0, 11);
    CHECK(shape.offset == 11);
    CHECK(shape.log_axes == (STOKES_LOG_ROWS | STOKES_LOG_R));
    CHECK(double(shape.r_first) == Approx(table.rho[1] / 2.0));
    CHECK(double(shape.row_first) == Approx(table.z[1] / 2.0));
    CHECK(node(shape.r_first, shape.r_step, shape.r_count - 1) == Approx(table.rho.back() / 0.5).epsilon(1e-5));
    CHECK(node(shape.row_first, shape.row_step, shape.row_count - 1) == Approx(table.z.back() / 0.5).epsilon(1e-5));
    CHECK(input_error([&] { green_medium_shape(table, 0.0, 2.0); }) ==
          "extinction coefficients from 0 to 2 per mm: expected positive numbers");
}

// Rows are moved a little for the straight lines between them: the total times the density of first collisions, exp(-z)
// at each wavelength, has the exact integral.
TEST_CASE("the resampled rows hold the exact totals", "[resample_green]") {
    const Resampled pass;
    const GreenTotals totals(smooth_table());
    double worst_row = 0.0, worst_total = 0.0;
    for (std::size_t row = 0; row < pass.shape.row_count; ++row)
        for (std::size_t j = 0; j < 16; ++j) {
            double sum = 0.0;
            for (std::size_t i = 0; i + 1 < pass.shape.r_count; ++i)
                sum +=
                    0.5 * (pass.r(i + 1) - pass.r(i)) *
                    (double(pass.values[pass.entry(row, i)].v[j]) + double(pass.values[pass.entry(row, i + 1)].v[j]));
            const double u1 = pass.u1[row].v[j], exact = totals.at(pass.z(row) * kSigma[j], kAlbedo[j]);
            worst_row = std::max(worst_row, std::abs(sum - u1));
            worst_total = std::max(worst_total, std::abs(u1 - exact) - 0.003 * exact);
        }
    CHECK(worst_row < 3e-6);  // single precision, 128 terms
    CHECK(worst_total < 1e-6);
    for (std::size_t j = 0; j < 16; ++j) {
        double lines = 0.0, exact = 0.0;
        for (std::size_t row = 0; row + 1 < pass.shape.row_count; ++row)
            for (int part = 0; part < 32; ++part) {
                const double x = (part + 0.5) / 32.0, width = (pass.z(row + 1) - pass.z(row)) / 32.0;
                const double z = pass.z(row) + x * (pass.z(row + 1) - pass.z(row));
                const double weight = std::exp(-z * kSigma[j]) * width * kSigma[j];
                lines += weight * ((1.0 - x) * double(pass.u1[row].v[j]) + x * double(pass.u1[row + 1].v[j]));
                exact += weight * totals.at(z * kSigma[j], kAlbedo[j]);
            }
        CAPTURE(j, kSigma[j], kAlbedo[j], lines, exact);
        CHECK(std::abs(lines - exact) < 8e-6);  // up to 4e-5 without that
    }
}

TEST_CASE("resampled densities are the universal ones in millimetres", "[resample_green]") {
    const Resampled pass;
    const GreenTotals totals(smooth_table());
    for (const std::size_t row : {20u, 45u, 70u, 80u})
        for (const std::size_t j : {2u, 6u, 12u, 14u}) {
            // The shape's own integral by the same straight lines, on a grid eight times as fine.
            const double z = pass.z(row) * kSigma[j];
            double integral = 0.0;
            for (std::size_t i = 1; i + 1 < 8 * pass.shape.r_count; ++i) {
                const double low = node(0.003, pass.shape.r_step / 8.0, i),
                             high = node(0.003, pass.shape.r_step / 8.0, i + 1);
                integral += 0.5 * (high - low) * (shape_of(low, z, kAlbedo[j]) + shape_of(high, z, kAlbedo[j]));
            }
            const double scale = totals.at(z, kAlbedo[j]) / integral * kSigma[j];
            double peak = 0.0, worst = 0.0;
            for (std::size_t i = 0; i < pass.shape.r_count; ++i) {
                const double expected = scale * shape_of(pass.r(i) * kSigma[j], z, kAlbedo[j]);
                peak = std::max(peak, expected);
                worst = std::max(worst, std::abs(double(pass.values[pass.entry(row, i)].v[j]) - expected));
            }
            CAPTURE(row, j);
            CHECK(worst < 0.004 * peak);
        }
}

TEST_CASE("the mixture is the mean of the wavelengths' densities", "[resample_green]") {
    const std::size_t offset = 40, first_row = 3;
    const Resampled pass(offset, first_row);
    for (std::size_t i = 0; i < offset; ++i) CHECK(pass.mean[i] == -7.0f);
    for (std::size_t row = 0; row < pass.shape.row_count; row += 19) {
        double integral = 0.0, before = 0.0;
        for (std::size_t i = 0; i < pass.shape.r_count; ++i) {
            double mean = 0.0;
            for (std::size_t j = 0; j < 16; ++j) {
                const double u1 = pass.u1[first_row + row].v[j];
                if (u1 > 0.0) mean += double(pass.values[pass.entry(row, i)].v[j]) / u1 / 16.0;
            }
            if (i > 0) integral += 0.5 * (before + mean) * (pass.r(i) - pass.r(i - 1));
            before = mean;
            CHECK(double(pass.mean[pass.entry(row, i)]) == Approx(mean).epsilon(1e-5).margin(1e-12));
            CHECK(double(pass.cumulative[pass.entry(row, i)]) == Approx(integral).epsilon(1e-5).margin(1e-12));
        }
        double lit = 0.0;  // wavelengths of which anything leaves
        for (const float u1 : pass.u1[first_row + row].v) lit += u1 > 0.0f ? 1.0 : 0.0;
        CHECK(lit <= 15.0);
        CHECK(integral == Approx(lit / 16.0).epsilon(1e-4));
    }
}

TEST_CASE("a wavelength without a medium leaves nothing", "[resample_green][tiny]") {
    GreenResampler::Sixteen sigma = kSigma;
    sigma[4] = 0.0;
    const Resampled pass(0, 0, sigma);
    for (const Flux16& value : pass.values) {
        REQUIRE(value.v[4] == 0.0f);
        for (const float v : value.v) REQUIRE((std::isfinite(v) && v >= 0.0f));
    }
    for (const Flux16& u1 : pass.u1) CHECK(u1.v[4] == 0.0f);
}
