#include "host/subsurface/distance_sampler.hpp"

#include <algorithm>
#include <numeric>

namespace stokes {

namespace {

// Appends a row of a density over r_mm and of its integral from the first distance on.
void add_row(const std::vector<double>& density, const std::vector<double>& r_mm, std::vector<float>& rows,
             std::vector<float>& cumulative_rows) {
    double integral = 0.0;
    for (std::size_t r = 0; r < r_mm.size(); ++r) {
        if (r > 0) integral += 0.5 * (density[r - 1] + density[r]) * (r_mm[r] - r_mm[r - 1]);
        rows.push_back(static_cast<float>(density[r]));
        cumulative_rows.push_back(static_cast<float>(integral));
    }
}

}  // namespace

DistanceSampler make_distance_sampler(const PowerTable& table, std::size_t offset) {
    DistanceSampler sampler;
    sampler.shape = table_shape(table, offset);
    const std::size_t lambdas = table.axes.back().values.size();
    const std::vector<double>& r_mm = table.axis("r")->values;
    std::vector<std::vector<double>> rows(sampler.shape.row_count);
    double largest = 0.0;
    for (std::size_t row = 0; row < rows.size(); ++row)
        for (std::size_t r = 0; r < r_mm.size(); ++r) {
            const double* entry = table_entry(table, sampler.shape, row, r);
            rows[row].push_back(std::accumulate(entry, entry + lambdas, 0.0) / static_cast<double>(lambdas));
            largest = std::max(largest, rows[row].back());
        }
    for (std::vector<double>& row : rows) {
        add_row(row, r_mm, sampler.mean_rows, sampler.cumulative_rows);
        for (double& mean : row) mean = largest > 0.0 ? (mean / largest) * (mean / largest) : 0.0;
        add_row(row, r_mm, sampler.weighted_rows, sampler.weighted_cumulative_rows);
    }
    return sampler;
}

}  // namespace stokes
