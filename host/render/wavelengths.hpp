// The wavelengths of a pass and the weights that keep sums over them unbiased (PHYSICS section 2).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>

#include "kernels/shared/limits.h"

namespace stokes {

using WavelengthSet = std::array<int, STOKES_WAVELENGTHS>;  // [nm], increasing; drawn in strata: not decreasing

// Uniform in [0, bound), bound >= 1, without the bias of a plain remainder; the same on every platform.
std::uint64_t uniform_below(std::mt19937_64& generator, std::uint64_t bound);

// Integers of [first_nm, last_nm] drawn uniformly without replacement; depends on its arguments alone.
// The range must hold at least STOKES_WAVELENGTHS integers (InputError).
WavelengthSet draw_wavelengths(std::uint32_t seed, std::uint32_t pass, int first_nm, int last_nm);

// N/n [nm]: this times the sum over the set estimates the sum over all N wavelengths.
double image_weight_nm(int first_nm, int last_nm);

// (N-1)/(n-1) [nm]: this times the sum over the other members of the set estimates, given that one wavelength is in
// the set, the sum over all N-1 others.
double pair_weight_nm(int first_nm, int last_nm);

// The wavelengths of a pass, and what keeps sums over those that light is re-radiated from unbiased.
struct PassWavelengths {
    WavelengthSet set;
    double pair_weight_nm;  // of a first re-radiation; drawn in strata: image_weight_nm()
    // Factor on it for light that has been re-radiated k times before; [0] is 1. Void for those drawn in strata.
    std::array<double, STOKES_WAVELENGTHS> chain;

    // How many times as rare as in a uniform draw each one is, a factor on all light that starts at it.
    std::array<double, STOKES_WAVELENGTHS> rarity = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};

    // Drawn in strata (stratified_wavelengths.hpp): each one's stratum, never decreasing.
    bool stratified = false;
    std::array<std::uint32_t, STOKES_WAVELENGTHS> strata{};

    // Weight [nm] of light that is taken up at set[ex] and emitted at set[em], the first time.
    double weight_nm(std::size_t ex, std::size_t em) const;
};

}  // namespace stokes
