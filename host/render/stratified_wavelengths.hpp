// Wavelengths drawn where they matter, in strata (PHYSICS section 2).
//
// Each integer wavelength has an expected count m, and all of them together are laid side by side on a line
// of length 16, cut into 16 strata of length 1. A set takes one place in each stratum; or, less often, two in
// each band of two strata, four in each band of four, eight in each half, or sixteen anywhere, so that every
// pair, and every longer row of wavelengths, can be in a set together. A place says its wavelength, which may
// be drawn more than once. So
//   sum over the set of g / m  estimates  the sum of g over all wavelengths, and
//   sum over k different members of g / (m ... m joint_ratio(their strata))  the sum over all rows of k
//   wavelengths.
//
// Over the passes of a render the numbers of sets in 1, 2, .. bands are as near their shares as they can be, and the
// sets of a kind are stratified within each stratum too: the mean over passes settles faster than that of independent
// ones, and each pass by itself is drawn as if alone.
#pragma once

#include <cstdint>
#include <vector>

#include "host/render/wavelengths.hpp"
#include "kernels/shared/pass.h"

namespace stokes {

// How often a set is drawn in 1, 2, 4, 8 and 16 bands. The variance of shipped lamps on shipped fluorophores
// is least where most sets have 16, and only pairs within a stratum suffer. Multiples of 1/128.
inline constexpr std::array<double, STOKES_STRATA_LEVELS> level_shares = {1.0 / 128.0, 1.0 / 128.0, 1.0 / 64.0,
                                                                          7.0 / 64.0, 55.0 / 64.0};

// Expected number of ordered rows of different members of a set that lie in these strata (0 to 15, in any
// order), over the product of each one's own expected count; in (0, 1], 0 for more than 16.
double joint_ratio(std::vector<std::uint32_t> strata);
// The same of two, looked up.
double pair_ratio(std::uint32_t a, std::uint32_t b);

class StratifiedWavelengths {
  public:
    // expected[i] of wavelength first_nm + i: all positive, in any unit; the sum is brought to 16.
    StratifiedWavelengths(int first_nm, const std::vector<double>& expected);

    // Depends on seed, pass and the expected counts alone.
    PassWavelengths draw(std::uint32_t seed, std::uint32_t pass) const;

    int first_nm() const { return first_nm_; }
    int last_nm() const { return first_nm_ + static_cast<int>(end_.size()) - 1; }
    // Mean number of times a wavelength of the range is in a set.
    double expected(int lambda_nm) const;
    // Where it lies on the line: from begin() to begin() + expected().
    double begin(int lambda_nm) const;

  private:
    int first_nm_;
    std::vector<double> end_;  // of each wavelength on the line
};

}  // namespace stokes
