// The density over distance that photons' exit distances are drawn from, as sample_distance() reads it.
#pragma once

#include <cstddef>
#include <vector>

#include "host/subsurface/device_table.hpp"

namespace stokes {

// For each row (refraction angle) the mean of a table over all its wavelengths, taken as piecewise linear in
// r, and its integral from the first distance on, not normalised. Both [row][r]; shape as of the table's
// values.
struct DistanceSampler {
    std::vector<float> mean_rows;        // [the table's unit]
    std::vector<float> cumulative_rows;  // [the table's unit * mm]
    // The same for the density to draw from where more light leaves: nine tenths as the square of the mean, the rest as
    // the mean, normalised; 0 in rows where the mean is.
    std::vector<float> weighted_rows;             // [1/mm]
    std::vector<float> weighted_cumulative_rows;  // [1]
    TableShape shape{};
};

// offset as for table_shape(), whose errors it throws.
DistanceSampler make_distance_sampler(const PowerTable& table, std::size_t offset = 0);

}  // namespace stokes
