// Low-discrepancy numbers in [0, 1) for the passes of a render.
#pragma once

#include <cstdint>

namespace stokes {

// A seed for one purpose, from the seed of the render.
std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t purpose);

// Over seeds, uniform in [0, 1) and independent of those of other seeds; of one seed, any 2^m indices that follow a
// multiple of 2^m have one number in each interval of length 2^-m. The order differs from seed to seed, so that the
// pairs of two seeds' numbers cover the square as independent ones do. The radical inverse in base 2, its digits and
// the order of its indices scrambled after Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995, as Burley,
// "Practical hash-based Owen scrambling", JCGT 9(4), 2020, joins them.
double low_discrepancy_number(std::uint64_t seed, std::uint32_t index);

// Over seeds, uniform in 0 .. 2^bits - 1; of one seed, indices of the same range have each number once, and any 2^m of
// them that follow a multiple of 2^m one in each interval of 2^(bits - m). The scrambled radical inverse.
std::uint32_t low_discrepancy_cell(std::uint64_t seed, std::uint32_t index, int bits);

}  // namespace stokes
