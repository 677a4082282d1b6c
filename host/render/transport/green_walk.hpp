// The Green's function of a half-space by random walks on the device (kernels/walk_green.cl).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "host/device/kernel.hpp"
#include "host/subsurface/green_table.hpp"
#include "kernels/shared/green.h"

namespace stokes {

// Where light of a source at one depth left, per walk. Same bits for the same arguments.
struct GreenScores {
    std::vector<double> escape;          // [bin][albedo]: bin 0 below the table's rho[1], bin i about rho[i]
    std::vector<double> total;           // [albedo], within the table's reach
    std::vector<double> standard_error;  // [albedo], of total
};

class GreenWalker {
  public:
    // nodes: of the table that is to be filled, with STOKES_GREEN_ALBEDOS albedos. Throws InputError for
    // another number.
    GreenWalker(const Device& device, const GreenTable& nodes);

    // walks are rounded up to whole launches of at most 65536; done is called after each with the walks so
    // far. stream: sources with different streams have independent random numbers.
    GreenScores walk(double source_depth, std::uint32_t stream, std::uint64_t walks,
                     const std::function<void(std::uint64_t)>& done = {});

  private:
    GreenWalk parameters_{};
    std::size_t bins_;
    Kernel kernel_;
    Buffer<Flux16> albedos_, histograms_;
};

// share: of the work that is done, in [0, 1].
using GreenProgress = std::function<void(double share)>;

// The table for a refractive index in [1, 4]: shape from the walks, that many from each depth near the
// surface and fewer from the deep, totals exact. Throws InputError for eta out of range or no walks.
GreenTable make_green_table(const Device& device, double eta, std::uint64_t walks, const GreenProgress& progress = {});

// The table that comes with the program, where there is one for this eta; else the cached one,
// ${XDG_CACHE_HOME:-$HOME/.cache}/stokes/green-ETA.json.gz, which is made when it is not there or cannot be
// used (with a warning).
GreenTable green_table_for(const Device& device, double eta, const GreenProgress& progress = {});

}  // namespace stokes
