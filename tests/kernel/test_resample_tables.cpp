#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "host/subsurface/device_table.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"

using namespace stokes;

namespace {

MediumSpectra marble() {
    return {"marble", {{464.0, 611.0}, {1.5, 1.1}, Outside::hold}, {{464.0, 611.0}, {0.007, 0.002}, Outside::hold}};
}

TableGrid grid_of(std::size_t r, std::size_t theta, std::size_t lambda) {
    TableGrid grid;
    grid.r_mm.resize(r);
    grid.theta_deg.resize(theta);
    grid.lambda_nm.resize(lambda);
    return grid;
}

// Linear interpolation of one entry in wavelength, held at the ends, in double precision.
double at_wavelength(const PowerTable& table, const double* entry, double lambda_nm) {
    const Spectrum spectrum{
        table.axis("lambda")->values, {entry, entry + table.axis("lambda")->values.size()}, Outside::hold};
    return spectrum.at(lambda_nm);
}

// Resampled tables, one after the other in one buffer.
Buffer<Flux16> resample(const std::vector<PowerTable>& tables, const std::vector<float>& lambda_nm) {
    std::vector<float> full;
    for (const PowerTable& table : tables) {
        const std::vector<float> layout = device_layout(table);
        full.insert(full.end(), layout.begin(), layout.end());
    }
    const UniformAxis lambdas = device_wavelengths(tables.front());
    const std::size_t entries = full.size() / lambdas.count;
    Device& device = test_device();
    const Buffer<float> values(device, "power tables", full), wavelengths(device, "wavelengths", lambda_nm);
    const Buffer<Flux16> out(device, "resampled tables", entries);
    Program(device, "resample_tables.cl")
        .kernel("resample_table")
        .launch(entries, Arguments()
                             .add("full", values)
                             .add("n_lambda", static_cast<std::uint32_t>(lambdas.count))
                             .add("lambda_first_nm", static_cast<float>(lambdas.first))
                             .add("lambda_step_nm", static_cast<float>(lambdas.step))
                             .add("lambda_nm16", wavelengths)
                             .add("table16", out)
                             .add("count", static_cast<std::uint32_t>(entries)));
    device.finish();
    return out;
}

// Integers of a pass, first and last grid point, between grid points, and beyond both ends.
const std::vector<float> some_wavelengths = {290.0f, 300.0f, 301.0f, 304.0f, 455.0f, 464.0f, 467.0f, 502.0f,
                                             555.0f, 558.0f, 600.0f, 613.0f, 700.0f, 780.0f, 795.0f, 830.0f};

void check_resampled(const std::vector<PowerTable>& tables) {
    const std::vector<Flux16> out = resample(tables, some_wavelengths).download();
    std::size_t entry = 0;
    double worst = 0.0;
    for (const PowerTable& table : tables) {
        const TableShape shape = table_shape(table);
        for (std::size_t row = 0; row < shape.row_count; ++row)
            for (std::size_t r = 0; r < shape.r_count; ++r, ++entry)
                for (std::size_t i = 0; i < 16; ++i) {
                    const double expected =
                        at_wavelength(table, table_entry(table, shape, row, r), some_wavelengths[i]);
                    worst = std::max(worst, std::abs(static_cast<double>(out[entry].v[i]) / expected - 1.0));
                }
    }
    CHECK(entry == out.size());
    CHECK(worst < 1e-6);
}

// Bilinear look-up in double precision at one wavelength.
double looked_up(const PowerTable& table, double r_mm, double theta_deg, double lambda_nm) {
    const TableShape shape = table_shape(table);
    const auto place = [](const TableAxis* axis, double x) {
        if (axis == nullptr) return 0.0;
        const double step = (axis->values.back() - axis->values.front()) / static_cast<double>(axis->values.size() - 1);
        return std::clamp((x - axis->values.front()) / step, 0.0, static_cast<double>(axis->values.size() - 1));
    };
    const double row = place(table.axis("theta"), theta_deg), r = place(table.axis("r"), r_mm);
    double sum = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        const double i = std::min(std::floor(row) + corner / 2, shape.row_count - 1.0);
        const double j = std::min(std::floor(r) + corner % 2, shape.r_count - 1.0);
        const double weight = (corner / 2 ? row - std::floor(row) : 1.0 - row + std::floor(row)) *
                              (corner % 2 ? r - std::floor(r) : 1.0 - r + std::floor(r));
        sum += weight *
               at_wavelength(table, table_entry(table, shape, static_cast<std::size_t>(i), static_cast<std::size_t>(j)),
                             lambda_nm);
    }
    return sum;
}

}  // namespace

TEST_CASE("resampled tables agree with interpolation in double precision", "[resample_tables]") {
    check_resampled({make_fluorescence_table(marble()), make_multiple_table(marble())});
}

TEST_CASE("small tables, and tables of one wavelength, are resampled", "[resample_tables][tiny]") {
    check_resampled({make_single_table(marble(), grid_of(3, 2, 5)), make_multiple_table(marble(), grid_of(4, 1, 5))});
    check_resampled({make_single_table(marble(), grid_of(2, 1, 1))});
}

TEST_CASE("a look-up is bilinear in distance and angle, held at the ends", "[resample_tables][tiny]") {
    const std::vector<PowerTable> tables = {make_fluorescence_table(marble(), grid_of(20, 30, 100)),
                                            make_single_table(marble(), grid_of(20, 30, 100)),
                                            make_multiple_table(marble(), grid_of(20, 1, 100))};
    const Buffer<Flux16> table16 = resample(tables, some_wavelengths);
    std::mt19937 generator(5);
    std::vector<float> r_mm = {0.0f, 0.1f, 1.9f, 1.95f, 40.0f}, theta_deg = {0.0f, 0.9f, 26.1f, 26.5f, 90.0f};
    for (int i = 0; i < 200; ++i) {
        r_mm.push_back(static_cast<float>(generator() % 2000) * 1e-3f);
        theta_deg.push_back(static_cast<float>(generator() % 2700) * 1e-2f);
    }
    Device& device = test_device();
    const Buffer<float> distances(device, "distances", r_mm), angles(device, "angles", theta_deg);
    const Buffer<Flux16> out(device, "factors", r_mm.size());
    Kernel look_up = test_program("power_table.cl").kernel("look_up");
    std::size_t offset = 0;
    for (const PowerTable& table : tables) {
        const TableShape shape = table_shape(table, offset);
        look_up.launch(r_mm.size(), Arguments()
                                        .add("table16", table16)
                                        .add("shape", shape)
                                        .add("r_mm", distances)
                                        .add("theta_deg", angles)
                                        .add("out", out)
                                        .add("n", static_cast<std::uint32_t>(r_mm.size())));
        const std::vector<Flux16> found = out.download();
        double worst = 0.0;
        for (std::size_t i = 0; i < r_mm.size(); ++i)
            for (std::size_t k = 0; k < 16; ++k)
                worst = std::max(worst, std::abs(static_cast<double>(found[i].v[k]) /
                                                     looked_up(table, r_mm[i], theta_deg[i], some_wavelengths[k]) -
                                                 1.0));
        CAPTURE(table.component);
        CHECK(worst < 3e-6);
        offset += shape.row_count * shape.r_count;
    }
}
