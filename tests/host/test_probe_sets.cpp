#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <tuple>

#include "host/render/probe_sets.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

// 300..780 by step, with all above 365 nm emitting up to last; each step has one nanometre, or all of those about it.
ProbeGrid grid_of(int step_nm, int last_nm, bool all = false) {
    ProbeGrid grid;
    grid.lambda_ex_nm = 365;
    grid.step_nm = step_nm;
    for (int lambda = 300; lambda <= 780; lambda += step_nm) {
        grid.lambda_nm.push_back(lambda);
    }
    if (!std::binary_search(grid.lambda_nm.begin(), grid.lambda_nm.end(), 365))
        grid.lambda_nm.insert(std::upper_bound(grid.lambda_nm.begin(), grid.lambda_nm.end(), 365), 365);
    for (int i = 0; i < static_cast<int>(grid.lambda_nm.size()); ++i) {
        const int lambda = grid.lambda_nm[static_cast<std::size_t>(i)];
        if (lambda <= 365 || lambda > last_nm) continue;
        ProbeStep step{i, {}, {}};
        for (int about = all ? -(step_nm - 1) / 2 : 0; about <= (all ? step_nm / 2 : 0); ++about) {
            step.lambda_nm.push_back(lambda + about);
            step.emission.push_back(2.0 + std::sin(0.7 * (lambda + about)));
        }
        grid.emitting.push_back(step);
    }
    for (int lambda = 364; lambda >= 345; --lambda) grid.spare.push_back(lambda);
    return grid;
}

// What re-radiation from one wavelength to a higher one could be; 365 nm is the beam.
double transfer(int from, int to) {
    return to > from ? 1.0 + 0.3 * std::sin(0.02 * from) + 0.2 * std::cos(0.05 * to) : 0.0;
}

// Light of exactly `times` re-radiations at `to`, through all nanometres that emit.
double path_sum(const ProbeGrid& grid, int to, int times) {
    if (times == 1) return transfer(365, to);
    double sum = 0.0;
    for (const ProbeStep& step : grid.emitting)
        for (const int between : step.lambda_nm)
            if (between < to) sum += path_sum(grid, between, times - 1) * transfer(between, to);
    return sum;
}

// Of a step, per nm.
double path_mean(const ProbeGrid& grid, const ProbeStep& step, int times) {
    double sum = 0.0;
    for (const int to : step.lambda_nm) sum += path_sum(grid, to, times);
    return sum / grid.step_nm;
}

// The same as a kernel with the set's wavelengths and weights computes it.
double estimate(const ProbeSet& set, std::size_t place, int times) {
    const int to = set.wavelengths.set[place];
    const double weight =
        set.wavelengths.weight_nm(set.excitation, place) * set.wavelengths.chain[static_cast<std::size_t>(times - 1)];
    if (times == 1) return transfer(365, to) * weight;
    double sum = 0.0;
    for (std::size_t k = 0; k < place; ++k)
        if (set.wavelengths.set[k] > 365) sum += estimate(set, k, times - 1) * transfer(set.wavelengths.set[k], to);
    return sum * weight;
}

}  // namespace

TEST_CASE("probe sets read every emitting step once", "[probe sets]") {
    using Case = std::tuple<int, int, bool>;
    for (const auto& [width, last, all] :
         {Case{5, 780, false}, Case{5, 780, true}, Case{5, 660, false}, Case{5, 440, true}, Case{7, 500, true},
          Case{40, 780, false}, Case{5, 366, false}}) {
        const ProbeGrid grid = grid_of(width, last, all);
        CAPTURE(width, last, all, grid.emitting.size());
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
                    const auto is_read = [&](const ProbeStep& step) { return step.read == set.read[k]; };
                    const auto step = std::find_if(grid.emitting.begin(), grid.emitting.end(), is_read);
                    REQUIRE(step != grid.emitting.end());
                    CHECK(std::binary_search(step->lambda_nm.begin(), step->lambda_nm.end(), lambda[k]));
                    ++times[set.read[k]];
                }
            }
            CHECK(times.size() == grid.emitting.size());
            for (const ProbeStep& step : grid.emitting) CHECK(times[step.read] == 1);
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
            for (const ProbeStep& step : grid.emitting) expected += path_mean(grid, step, times);
            for (std::uint32_t batch = 0; batch < 1500; ++batch) {
                double sum = 0.0;
                for (const ProbeSet& set : probe_sets(grid, 1, batch))
                    for (std::size_t k = 0; k < STOKES_WAVELENGTHS; ++k)
                        if (set.read[k] >= 0) sum += estimate(set, k, times) / probe_pair_weight_nm(grid);
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
        for (std::size_t k = 0; k < STOKES_WAVELENGTHS; ++k) {
            if (set.read[k] < 0) continue;
            const double expected = path_sum(grid, set.wavelengths.set[k], times) / grid.step_nm;
            CHECK(estimate(set, k, times) / probe_pair_weight_nm(grid) == Approx(expected));
        }
}

// Whichever nanometre stands for a step, however much each one emits.
TEST_CASE("what a step emits is that of all its nanometres in the mean", "[probe sets]") {
    const ProbeGrid grid = grid_of(5, 440, true);
    std::map<int, Sample> at;
    for (std::uint32_t batch = 0; batch < 4000; ++batch)
        for (const ProbeSet& set : probe_sets(grid, 3, batch))
            for (std::size_t k = 0; k < STOKES_WAVELENGTHS; ++k)
                if (set.read[k] >= 0) at[set.read[k]].add(estimate(set, k, 1) / probe_pair_weight_nm(grid));
    REQUIRE(at.size() == grid.emitting.size());
    for (const ProbeStep& step : grid.emitting) {
        CAPTURE(step.lambda_nm[0]);
        CHECK(at[step.read].standard_error() < 0.02 * at[step.read].mean());
        CHECK(std::abs(at[step.read].z(path_mean(grid, step, 1))) < 3.5);
    }
}

TEST_CASE("probe sets need sixteen wavelengths", "[probe sets]") {
    ProbeGrid grid = grid_of(40, 780);
    grid.spare.clear();
    CHECK_THAT(input_error([&] { probe_sets(grid, 1, 0); }), Contains("expected at least 16 wavelengths, got 12"));
}
