#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "host/render/low_discrepancy.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

const std::vector<std::uint32_t> some_indices = {0, 1, 2, 3, 127, 128, 5000, 0x80000000u, 0xffffffffu};

std::size_t cell(double u, double cells) { return static_cast<std::size_t>(u * cells); }

}  // namespace

TEST_CASE("numbers of a block of indices lie in different cells", "[low_discrepancy]") {
    for (const std::uint64_t seed : {0u, 1u, 77u})
        for (const std::uint32_t n : {1u, 2u, 16u, 128u, 1024u})
            for (const std::uint32_t first : {0u, n, 5 * n, 0u - n}) {
                std::vector<int> numbers(n, 0), cells(n, 0);
                for (std::uint32_t i = 0; i < n; ++i) {
                    const double u = low_discrepancy_number(seed, first + i);
                    REQUIRE(u >= 0.0);
                    REQUIRE(u < 1.0);
                    ++numbers[cell(u, n)];
                    ++cells[low_discrepancy_cell(seed, first + i, 10) * n / 1024];
                }
                REQUIRE(numbers == std::vector<int>(n, 1));
                REQUIRE(cells == std::vector<int>(n, 1));
            }
}

// 256 cells each, 50000 seeds. All of it together is wrong once in 1000.
TEST_CASE("over seeds a number is uniform, and so is a pair at one index", "[low_discrepancy]") {
    constexpr std::uint64_t seeds = 50000;
    const double level = sidak_level(1e-3, 4 * some_indices.size());
    for (const std::uint32_t index : some_indices) {
        std::vector<double> single(256, 0.0), fine(256, 0.0), pair(256, 0.0), whole(128, 0.0);
        for (std::uint64_t s = 0; s < seeds; ++s) {
            const double a = low_discrepancy_number(derived_seed(s, 0), index),
                         b = low_discrepancy_number(derived_seed(s, 1), index);
            ++single[cell(a, 256.0)];
            ++fine[cell(a, 0x1p40) % 256];
            ++pair[cell(a, 16.0) * 16 + cell(b, 16.0)];
            ++whole[low_discrepancy_cell(derived_seed(s, 2), index % 128, 7)];
        }
        CAPTURE(index);
        CHECK(chi_square_uniform(single) > level);
        CHECK(chi_square_uniform(fine) > level);
        CHECK(chi_square_uniform(pair) > level);
        CHECK(chi_square_uniform(whole) > level);
    }
}

// Unshuffled, pairs of two sequences would stay in two of four quarters.
TEST_CASE("over indices, pairs of numbers of two seeds cover the square", "[low_discrepancy]") {
    for (std::uint64_t s = 0; s < 20; ++s) {
        std::array<int, 16> counts{};
        for (std::uint32_t index = 0; index < 1024; ++index)
            ++counts[cell(low_discrepancy_number(derived_seed(s, 0), index), 4.0) * 4 +
                     cell(low_discrepancy_number(derived_seed(s, 1), index), 4.0)];
        CHECK(*std::min_element(counts.begin(), counts.end()) > 24);  // of 64, five standard deviations less
    }
}
