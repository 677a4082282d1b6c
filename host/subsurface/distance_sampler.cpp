#include "host/subsurface/distance_sampler.hpp"

#include <numeric>

namespace stokes {

DistanceSampler make_distance_sampler(const PowerTable& table, std::size_t offset) {
    DistanceSampler sampler;
    sampler.shape = table_shape(table, offset);
    const std::size_t lambdas = table.axes.back().values.size();
    const std::vector<double>& r_mm = table.axis("r")->values;
    for (std::size_t row = 0; row < sampler.shape.row_count; ++row) {
        double previous = 0.0, integral = 0.0;
        for (std::size_t r = 0; r < r_mm.size(); ++r) {
            const double* entry = table_entry(table, sampler.shape, row, r);
            const double mean = std::accumulate(entry, entry + lambdas, 0.0) / static_cast<double>(lambdas);
            if (r > 0) integral += 0.5 * (previous + mean) * (r_mm[r] - r_mm[r - 1]);
            sampler.mean_rows.push_back(static_cast<float>(mean));
            sampler.cumulative_rows.push_back(static_cast<float>(integral));
            previous = mean;
        }
    }
    return sampler;
}

}  // namespace stokes
