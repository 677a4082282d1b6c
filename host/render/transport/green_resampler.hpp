// The universal Green's function table on a medium's own axes and a pass's wavelengths
// (kernels/resample_green.cl).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "host/device/kernel.hpp"
#include "host/subsurface/green_table.hpp"
#include "kernels/shared/green.h"
#include "kernels/shared/limits.h"
#include "kernels/shared/power_table.h"

namespace stokes {

// Axes in millimetres, both logarithmic, that cover the universal table for every extinction coefficient
// between sigma_t_min and sigma_t_max [1/mm], 0 < sigma_t_min <= sigma_t_max: rows are depths, entries
// lateral distances. offset: the table's first entry in its buffers. Throws InputError for other
// coefficients.
TableShape green_medium_shape(const GreenTable& table, double sigma_t_min, double sigma_t_max, std::size_t offset = 0);

// What a pass reads. A medium's entries start at its shape's offset, its rows at first_row.
struct GreenPassTables {
    Buffer<Flux16> table16;         // [row][r]: H1 [1/mm]; its trapezoid integral over r is u1 of the row
    Buffer<Flux16> u1;              // [row]: probability of leaving scattered, so that straight lines
                                    // between rows hold what they should
    Buffer<float> mean_rows;        // [row][r]: mean over the wavelengths of H1/u1 [1/mm]
    Buffer<float> cumulative_rows;  // [row][r]: its integral, not normalised
};

class GreenResampler {
  public:
    using Sixteen = std::array<double, STOKES_WAVELENGTHS>;

    GreenResampler(const Device& device, const GreenTable& table);

    // sigma_t [1/mm], not negative (0: nothing leaves), albedo in [0, 1].
    void resample(const TableShape& shape, std::size_t first_row, const Sixteen& sigma_t, const Sixteen& albedo,
                  const GreenPassTables& tables);

  private:
    std::vector<Flux16> exact_totals(const TableShape& shape, const Sixteen& sigma_t, const Sixteen& albedo) const;
    GreenShape universal_{};
    std::vector<double> root_;  // sqrt(1 - a) of the albedos
    GreenTotals totals_;
    Kernel blend_, resample_, normalise_;
    Buffer<float> log_h_, sigma_t_, fraction_;
    Buffer<std::uint32_t> lower_;
    Buffer<Flux16> blended_;
};

}  // namespace stokes
