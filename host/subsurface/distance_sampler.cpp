#include "host/subsurface/distance_sampler.hpp"

#include <numeric>

namespace stokes {

namespace {

// Share of the weighted rows that is the mean itself: no exit weighs more than about ten times what it does without.
constexpr double unweighted_share = 0.1;

// Integrals of a density over r_mm, piecewise linear, from the first distance to each.
std::vector<double> integrals(const std::vector<double>& density, const std::vector<double>& r_mm) {
    std::vector<double> result(density.size(), 0.0);
    for (std::size_t r = 1; r < density.size(); ++r)
        result[r] = result[r - 1] + 0.5 * (density[r - 1] + density[r]) * (r_mm[r] - r_mm[r - 1]);
    return result;
}

void append(std::vector<float>& floats, const std::vector<double>& values) {
    for (const double value : values) floats.push_back(static_cast<float>(value));
}

// Both shares integrate to their part of one; 0 where the mean is.
std::vector<double> weighted(const std::vector<double>& mean, const std::vector<double>& r_mm) {
    const double total = integrals(mean, r_mm).back();
    std::vector<double> squares(mean.size(), 0.0), result(mean.size(), 0.0);
    if (!(total > 0.0)) return result;
    for (std::size_t r = 0; r < mean.size(); ++r) squares[r] = mean[r] / total * (mean[r] / total);
    const double squared = integrals(squares, r_mm).back();
    for (std::size_t r = 0; r < mean.size(); ++r)
        result[r] = unweighted_share * mean[r] / total + (1.0 - unweighted_share) * squares[r] / squared;
    return result;
}

}  // namespace

DistanceSampler make_distance_sampler(const PowerTable& table, std::size_t offset) {
    DistanceSampler sampler;
    sampler.shape = table_shape(table, offset);
    const std::size_t lambdas = table.axes.back().values.size();
    const std::vector<double>& r_mm = table.axis("r")->values;
    for (std::size_t row = 0; row < sampler.shape.row_count; ++row) {
        std::vector<double> mean;
        for (std::size_t r = 0; r < r_mm.size(); ++r) {
            const double* entry = table_entry(table, sampler.shape, row, r);
            mean.push_back(std::accumulate(entry, entry + lambdas, 0.0) / static_cast<double>(lambdas));
        }
        append(sampler.mean_rows, mean);
        append(sampler.cumulative_rows, integrals(mean, r_mm));
        const std::vector<double> drawn = weighted(mean, r_mm);
        append(sampler.weighted_rows, drawn);
        append(sampler.weighted_cumulative_rows, integrals(drawn, r_mm));
    }
    return sampler;
}

}  // namespace stokes
