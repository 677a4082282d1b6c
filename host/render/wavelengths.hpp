// The wavelengths of a pass and the weights that keep sums over them unbiased (PHYSICS section 2).
#pragma once

#include <array>
#include <cstdint>
#include <random>

#include "kernels/shared/limits.h"

namespace stokes {

using WavelengthSet = std::array<int, STOKES_WAVELENGTHS>;  // [nm], increasing

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

}  // namespace stokes
