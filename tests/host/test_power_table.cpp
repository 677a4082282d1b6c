#include <cmath>
#include <limits>

#include "host/core/error.hpp"
#include "host/subsurface/distance_sampler.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

MediumSpectra constant_medium(double sigma_s, double sigma_a) {
    return {"jelly", Spectrum::constant(sigma_s), Spectrum::constant(sigma_a), 1.3, 1.0};
}

TableGrid small_grid() {
    TableGrid grid;
    grid.r_mm = {0.0, 0.5, 1.0, 1.5};
    grid.theta_deg = {0.0, 30.0, 60.0};
    grid.lambda_nm = {400.0, 500.0};
    return grid;
}

}  // namespace

TEST_CASE("the default grid is the paper's", "[power_table]") {
    const TableGrid grid;
    CHECK(grid.r_mm.size() == 100);
    CHECK(grid.r_mm[3] == 0.3);
    CHECK(grid.r_mm.back() == 9.9);
    CHECK(grid.theta_deg.size() == 100);
    CHECK(grid.theta_deg[1] == 0.9);
    CHECK(grid.theta_deg.back() == 89.1);
    CHECK(grid.lambda_nm.size() == 100);
    CHECK(grid.lambda_nm.front() == 300.0);
    CHECK(grid.lambda_nm.back() == 795.0);
}

TEST_CASE("tables say what they are and which medium they are for", "[power_table]") {
    const PowerTable fluorescence = make_fluorescence_table(constant_medium(1.0, 0.1), small_grid());
    CHECK(fluorescence.model == "paper");
    CHECK(fluorescence.component == "fluorescence");
    CHECK(fluorescence.unit == "mm");
    CHECK(fluorescence.values.size() == 4 * 3 * 2);
    REQUIRE(fluorescence.axis("theta") != nullptr);
    CHECK(fluorescence.axis("theta")->unit == "deg");
    CHECK(fluorescence.medium.name == "jelly");
    CHECK(fluorescence.medium.eta == 1.3);
    CHECK(fluorescence.medium.sigma_a == std::vector<double>{0.1, 0.1});

    const PowerTable multiple = make_multiple_table(constant_medium(1.0, 0.1), small_grid());
    CHECK(multiple.values.size() == 4 * 2);
    CHECK(multiple.axis("theta") == nullptr);
}

TEST_CASE("media that diverge or make no sense are refused by name and wavelength", "[power_table]") {
    CHECK_THROWS_WITH(make_fluorescence_table(constant_medium(0.0, 0.0)),
                      Contains("medium \"jelly\" at 300 nm") && Contains("sigma_t"));
    CHECK_THROWS_AS(make_single_table(constant_medium(-1.0, 2.0)), InputError);
    CHECK_THROWS_AS(make_single_table(constant_medium(1.0, std::nan(""))), InputError);
    CHECK_THROWS_AS(make_multiple_table(constant_medium(std::numeric_limits<double>::infinity(), 0.0)), InputError);

    // Zero outside of its samples: the first wavelength of the grid beyond them is named.
    MediumSpectra cut = constant_medium(1.0, 0.0);
    cut.sigma_s = {{300.0, 650.0}, {1.0, 1.0}, Outside::zero};
    CHECK_THROWS_WITH(make_multiple_table(cut), Contains("at 655 nm"));

    MediumSpectra thin = constant_medium(1.0, 0.0);
    thin.dipole_eta = 0.5;
    CHECK_THROWS_WITH(make_multiple_table(thin), Contains("dipole_eta"));
}

TEST_CASE("grids that cannot be tabulated are refused", "[power_table]") {
    TableGrid grid = small_grid();
    grid.theta_deg.back() = 90.5;
    CHECK_THROWS_WITH(make_single_table(constant_medium(1.0, 0.0), grid), Contains("theta = 90.5"));
    grid = small_grid();
    grid.r_mm[2] = grid.r_mm[1];
    CHECK_THROWS_WITH(make_single_table(constant_medium(1.0, 0.0), grid), Contains("strictly increasing"));
    grid.r_mm.clear();
    CHECK_THROWS_AS(make_single_table(constant_medium(1.0, 0.0), grid), InputError);
}

TEST_CASE("every value is finite and not negative, in any medium", "[power_table]") {
    for (double sigma_s : {0.0, 1e-6, 1.0, 300.0, 1e6})
        for (double sigma_a : {0.0, 1e-6, 1.0, 1e6}) {
            if (sigma_s + sigma_a == 0.0) continue;
            const MediumSpectra medium = constant_medium(sigma_s, sigma_a);
            for (const PowerTable& table :
                 {make_fluorescence_table(medium, small_grid()), make_single_table(medium, small_grid()),
                  make_multiple_table(medium, small_grid())})
                for (double value : table.values) REQUIRE((std::isfinite(value) && value >= 0.0));
        }
}

TEST_CASE("the device layout is [row][r][lambda]", "[power_table]") {
    MediumSpectra medium = constant_medium(1.0, 0.1);
    medium.sigma_s = {{400.0, 500.0}, {1.0, 2.0}, Outside::hold};
    const PowerTable table = make_single_table(medium, small_grid());
    const TableShape shape = table_shape(table, 7);
    CHECK(shape.offset == 7u);
    CHECK(shape.row_count == 3u);
    CHECK(shape.row_step == 30.0f);
    CHECK(shape.r_count == 4u);
    CHECK(shape.r_step == 0.5f);
    const std::vector<float> layout = device_layout(table);
    REQUIRE(layout.size() == 24);
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t r = 0; r < 4; ++r)
            for (std::size_t lambda = 0; lambda < 2; ++lambda)
                CHECK(layout[(row * 4 + r) * 2 + lambda] ==
                      static_cast<float>(table.values[(r * 3 + row) * 2 + lambda]));
    const UniformAxis wavelengths = device_wavelengths(table);
    CHECK(wavelengths.count == 2);
    CHECK(wavelengths.first == 400.0);
    CHECK(wavelengths.step == 100.0);

    CHECK(table_shape(make_multiple_table(medium, small_grid())).row_count == 1u);
    TableGrid uneven = small_grid();
    uneven.r_mm[1] = 0.6;
    CHECK_THROWS_WITH(table_shape(make_single_table(medium, uneven)), Contains("axis r is not evenly spaced"));
    uneven.r_mm = {0.0};
    CHECK_THROWS_WITH(table_shape(make_single_table(medium, uneven)), Contains("at least 2"));
}

TEST_CASE("the sampler holds the mean over all wavelengths and its trapezoidal integral", "[power_table]") {
    MediumSpectra medium = constant_medium(1.0, 0.1);
    medium.sigma_s = {{400.0, 500.0}, {1.0, 2.0}, Outside::hold};
    const PowerTable table = make_fluorescence_table(medium, small_grid());
    const DistanceSampler sampler = make_distance_sampler(table);
    REQUIRE(sampler.mean_rows.size() == 12);
    for (std::size_t row = 0; row < 3; ++row) {
        double integral = 0.0;
        for (std::size_t r = 0; r < 4; ++r) {
            const auto mean = [&](std::size_t i) {
                return 0.5 * (table.values[(i * 3 + row) * 2] + table.values[(i * 3 + row) * 2 + 1]);
            };
            if (r > 0) integral += 0.25 * (mean(r - 1) + mean(r));
            CHECK(sampler.mean_rows[row * 4 + r] == Approx(mean(r)).epsilon(1e-6));
            CHECK(sampler.cumulative_rows[row * 4 + r] == Approx(integral).epsilon(1e-6));
        }
    }
    REQUIRE(sampler.weighted_rows.size() == 12);
    for (std::size_t row = 0; row < 3; ++row) {
        const float* mean = &sampler.mean_rows[row * 4];
        double squares = 0.0, integral = 0.0;
        const double total = sampler.cumulative_rows[row * 4 + 3];
        for (std::size_t r = 1; r < 4; ++r) squares += 0.25 * (mean[r - 1] * mean[r - 1] + mean[r] * mean[r]);
        for (std::size_t r = 0; r < 4; ++r) {
            const std::size_t i = row * 4 + r;
            CHECK(sampler.weighted_rows[i] ==
                  Approx(0.1 * mean[r] / total + 0.9 * mean[r] * mean[r] / squares).epsilon(1e-5));
            if (r > 0) integral += 0.25 * (sampler.weighted_rows[i - 1] + sampler.weighted_rows[i]);
            CHECK(sampler.weighted_cumulative_rows[i] == Approx(integral).epsilon(1e-5));
        }
        CHECK(integral == Approx(1.0).epsilon(1e-5));
    }
}

TEST_CASE("a medium that does not scatter has densities of 0, not of nothing", "[power_table]") {
    const DistanceSampler sampler = make_distance_sampler(make_single_table(constant_medium(0.0, 0.1), small_grid()));
    for (const float density : sampler.weighted_rows) CHECK(density == 0.0f);
    for (const float integral : sampler.weighted_cumulative_rows) CHECK(integral == 0.0f);
}
