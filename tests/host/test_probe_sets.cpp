#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "host/render/probe_sets.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

// 300..780 by step, with all above 365 nm emitting up to last.
ProbeGrid grid_of(int step_nm, int last_nm) {
    ProbeGrid grid;
    grid.lambda_ex_nm = 365;
    grid.step_nm = step_nm;
    for (int lambda = 300; lambda <= 780; lambda += step_nm) {
        grid.lambda_nm.push_back(lambda);
        if (lambda > 365 && lambda <= last_nm) grid.emitting.push_back(lambda);
    }
    if (!std::binary_search(grid.lambda_nm.begin(), grid.lambda_nm.end(), 365))
        grid.lambda_nm.insert(std::upper_bound(grid.lambda_nm.begin(), grid.lambda_nm.end(), 365), 365);
    for (int lambda = 364; lambda >= 345; --lambda) grid.spare.push_back(lambda);
    return grid;
}

// What re-radiation from one wavelength to a higher one could be; 365 nm is the beam.
double transfer(int from, int to) {
    return to > from ? 1.0 + 0.3 * std::sin(0.02 * from) + 0.2 * std::cos(0.05 * to) : 0.0;
}

// Light of exactly `times` re-radiations at `to`, per nm; the sum over the wavelengths between weighs step
// each.
double path_sum(const ProbeGrid& grid, int to, int times) {
    if (times == 1) return transfer(365, to);
    double sum = 0.0;
    for (const int between : grid.emitting)
        if (between < to) sum += path_sum(grid, between, times - 1) * transfer(between, to) * grid.step_nm;
    return sum;
}

// The same as a kernel with the set's wavelengths and weights computes it.
double estimate(const ProbeSet& set, int to, int times) {
    const double weight = set.wavelengths.pair_weight_nm * set.wavelengths.chain[static_cast<std::size_t>(times - 1)];
    if (times == 1) return transfer(365, to) * weight;
    double sum = 0.0;
    for (const int between : set.wavelengths.set)
        if (between > 365 && between < to) sum += estimate(set, between, times - 1) * transfer(between, to);
    return sum * weight;
}

}  // namespace

TEST_CASE("probe sets read every emitting wavelength once", "[probe sets]") {
    for (const auto& [step, last] : {std::pair{5, 780}, {5, 660}, {5, 440}, {7, 500}, {40, 780}, {5, 366}}) {
        const ProbeGrid grid = grid_of(step, last);
        CAPTURE(step, last, grid.emitting.size());
        CHECK(probe_set_count(grid) == std::max<std::size_t>((grid.emitting.size() + 14) / 15, 1));
        for (std::uint32_t batch = 0; batch < 20; ++batch) {
            const std::vector<ProbeSet> sets = probe_sets(grid, 7, batch);
            CHECK(sets.size() == probe_set_count(grid));
            std::map<int, int> times;
            for (const ProbeSet& set : sets) {
                const WavelengthSet& lambda = set.wavelengths.set;
                for (std::size_t k = 0; k + 1 < lambda.size(); ++k) CHECK(lambda[k] < lambda[k + 1]);
                CHECK(lambda[set.excitation] == 365);
                for (std::size_t k = 0; k < lambda.size(); ++k) {
                    if (set.read[k] < 0) continue;
                    CHECK(grid.lambda_nm[static_cast<std::size_t>(set.read[k])] == lambda[k]);
                    ++times[lambda[k]];
                }
            }
            CHECK(times.size() == grid.emitting.size());
            for (const int lambda : grid.emitting) CHECK(times[lambda] == 1);
        }
    }
}

TEST_CASE("probe sets depend on seed and batch", "[probe sets]") {
    const ProbeGrid grid = grid_of(5, 780);
    const auto first = [&](std::uint32_t seed, std::uint32_t batch) {
        return probe_sets(grid, seed, batch)[0].wavelengths.set;
    };
    CHECK(first(1, 0) == first(1, 0));
    CHECK(first(1, 0) != first(1, 1));
    CHECK(first(1, 0) != first(2, 0));
}

// 46 wavelengths, so that the fourth set borrows from the others, and 20.
TEST_CASE("repeated re-radiation over probe sets is that over the grid", "[probe sets]") {
    for (const int last : {595, 465}) {
        const ProbeGrid grid = grid_of(5, last);
        for (const int times : {1, 2, 3, 4}) {
            Sample ratio;
            double expected = 0.0;
            for (const int to : grid.emitting) expected += path_sum(grid, to, times);
            for (std::uint32_t batch = 0; batch < 1500; ++batch) {
                double sum = 0.0;
                for (const ProbeSet& set : probe_sets(grid, 1, batch))
                    for (std::size_t k = 0; k < STOKES_WAVELENGTHS; ++k)
                        if (set.read[k] >= 0)
                            sum += estimate(set, set.wavelengths.set[k], times) / probe_pair_weight_nm(grid);
                ratio.add(sum / expected);
            }
            CAPTURE(last, times, ratio.mean(), ratio.standard_error());
            if (times == 1) {
                CHECK(ratio.mean() == Approx(1.0).epsilon(1e-12));
            } else {
                CHECK(ratio.standard_error() < 0.02);
                CHECK(std::abs(ratio.z(1.0)) < 3.5);
            }
        }
    }
}

TEST_CASE("one set that holds all emitting wavelengths is exact", "[probe sets]") {
    const ProbeGrid grid = grid_of(10, 515);
    REQUIRE(grid.emitting.size() == 15);
    const ProbeSet set = probe_sets(grid, 1, 0)[0];
    for (const int times : {1, 2, 3, 5})
        for (const int to : grid.emitting)
            CHECK(estimate(set, to, times) / probe_pair_weight_nm(grid) == Approx(path_sum(grid, to, times)));
}

TEST_CASE("probe sets need sixteen wavelengths", "[probe sets]") {
    ProbeGrid grid = grid_of(40, 780);
    grid.spare.clear();
    CHECK_THAT(input_error([&] { probe_sets(grid, 1, 0); }), Contains("expected at least 16 wavelengths, got 12"));
}
