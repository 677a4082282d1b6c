#include "host/render/low_discrepancy.hpp"

namespace stokes {

namespace {

constexpr std::uint64_t golden = 0x9e3779b97f4a7c15u;

// SplitMix64: Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

// Each of the lowest bits, from the highest of them on, is flipped or not by those above it.
std::uint32_t scrambled(std::uint32_t word, std::uint64_t seed, int bits) {
    std::uint32_t flips = 0;
    for (int bit = bits - 1; bit >= 0; --bit) {
        const std::uint64_t above = (std::uint64_t{1} << bits | word) >> bit >> 1;  // and a one before them
        flips |= static_cast<std::uint32_t>(mixed(seed + golden * above) & 1) << bit;
    }
    return word ^ flips;
}

std::uint32_t reversed(std::uint32_t word, int bits) {
    std::uint32_t result = 0;
    for (int bit = 0; bit < bits; ++bit) result |= (word >> bit & 1) << (bits - 1 - bit);
    return result;
}

}  // namespace

std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t purpose) {
    return mixed(mixed(seed + golden) + (purpose + 1) * golden);
}

std::uint32_t low_discrepancy_cell(std::uint64_t seed, std::uint32_t index, int bits) {
    return scrambled(reversed(index, bits), seed, bits);
}

double low_discrepancy_number(std::uint64_t seed, std::uint32_t index) {
    const std::uint32_t word =
        low_discrepancy_cell(derived_seed(seed, 1), scrambled(index, derived_seed(seed, 0), 32), 32);
    // The digits after those of the index.
    const std::uint64_t rest = mixed(derived_seed(seed, 2) + golden * word) >> 43;
    return static_cast<double>(std::uint64_t{word} << 21 | rest) * 0x1p-53;
}

}  // namespace stokes
