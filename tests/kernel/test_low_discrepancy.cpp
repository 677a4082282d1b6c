#include <algorithm>
#include <array>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

struct alignas(8) Point2 {
    float x, y;
};
struct alignas(16) Point4 {
    std::array<float, 4> u;
};

std::vector<Point4> points(std::uint32_t first, std::uint32_t seed, std::uint32_t n) {
    const Buffer<Point4> all(test_device(), "points", n);
    const Buffer<Point2> two(test_device(), "first two dimensions", n);
    test_program("low_discrepancy.cl")
        .kernel("points")
        .launch(n, Arguments()
                       .add("first", first)
                       .add("seed", seed)
                       .add("all", all, "float4")
                       .add("two", two, "float2")
                       .add("n", n));
    const std::vector<Point4> result = all.download();
    const std::vector<Point2> pairs = two.download();
    for (std::uint32_t i = 0; i < n; ++i) {
        REQUIRE(pairs[i].x == result[i].u[0]);
        REQUIRE(pairs[i].y == result[i].u[1]);
        for (const float u : result[i].u) REQUIRE((u >= 0.0f && u < 1.0f));
    }
    return result;
}

// Whether each box of 2^-cuts[d] by dimension has as many points as the others.
bool even(const std::vector<Point4>& points, const std::array<int, 4>& cuts) {
    std::vector<std::size_t> counts(std::size_t{1} << (cuts[0] + cuts[1] + cuts[2] + cuts[3]), 0);
    for (const Point4& p : points) {
        std::size_t box = 0;
        for (std::size_t d = 0; d < 4; ++d) {
            const std::size_t parts = std::size_t{1} << cuts[d];
            box = box * parts + static_cast<std::size_t>(static_cast<double>(p.u[d]) * static_cast<double>(parts));
        }
        ++counts[box];
    }
    return std::all_of(counts.begin(), counts.end(), [&](std::size_t n) { return n == points.size() / counts.size(); });
}

}  // namespace

// Expected words: the recurrence of Joe and Kuo 2008 with the first rows of their table new-joe-kuo-6.
TEST_CASE("unscrambled points are those of Sobol', Joe and Kuo", "[low_discrepancy][tiny]") {
    struct Row {
        std::uint32_t degree, polynomial;
        std::vector<std::uint32_t> m;
    };
    const std::array<Row, 5> rows = {
        {{1, 0, {1}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}}, {3, 2, {1, 1, 1}}, {4, 1, {1, 1, 3, 3}}}};
    std::array<std::array<std::uint32_t, 32>, 6> directions;
    for (std::uint32_t k = 0; k < 32; ++k) directions[0][k] = 0x80000000u >> k;
    for (std::size_t d = 1; d < 6; ++d) {
        const auto& [s, a, first] = rows[d - 1];
        std::vector<std::uint32_t> m = first;
        for (std::uint32_t k = s; k < 32; ++k) {
            std::uint32_t next = m[k - s] ^ (m[k - s] << s);
            for (std::uint32_t j = 1; j < s; ++j) next ^= ((a >> (s - 1 - j)) & 1u) * (m[k - j] << j);
            m.push_back(next);
        }
        for (std::uint32_t k = 0; k < 32; ++k) directions[d][k] = m[k] << (31 - k);
    }
    for (const std::uint32_t start : {0u, 0xffffff80u, 0x9e377900u}) {
        const std::uint32_t n = 128;
        const Buffer<std::uint32_t> buffer(test_device(), "words", n * 6);
        test_program("low_discrepancy.cl")
            .kernel("unscrambled_words")
            .launch(n, Arguments().add("words", buffer).add("first", start).add("n", n));
        const std::vector<std::uint32_t> words = buffer.download();
        for (std::uint32_t i = 0; i < n; ++i)
            for (std::size_t d = 0; d < 6; ++d) {
                std::uint32_t word = 0;
                for (std::uint32_t k = 0; k < 32; ++k)
                    if (((start + i) >> k) & 1u) word ^= directions[d][k];
                REQUIRE(words[i * 6 + d] == word);
            }
    }
}

TEST_CASE("2^m scrambled points are a net", "[low_discrepancy]") {
    for (const std::uint32_t seed : {0u, 1u, 0x80000000u, 77u})
        for (const std::uint32_t block : {0u, 5u})
            for (int m = 0; m <= 8; ++m) {
                const std::uint32_t n = 1u << m;
                const std::vector<Point4> block_points = points(block * n, seed, n);
                for (int x = 0; x <= m; ++x) REQUIRE(even(block_points, {x, m - x, 0, 0}));
                REQUIRE(even(block_points, {0, 0, m, 0}));
                REQUIRE(even(block_points, {0, 0, 0, m}));
                for (int a = 0; a <= m - 3; ++a)
                    for (int b = 0; a + b <= m - 3; ++b)
                        for (int c = 0; a + b + c <= m - 3; ++c)
                            REQUIRE(even(block_points, {a, b, c, m - 3 - a - b - c}));
            }
}

void check_later_dimensions(const std::vector<std::uint32_t>& seeds, int most_m) {
    for (const std::uint32_t seed : seeds)
        for (int m = 0; m <= most_m; ++m) {
            const std::uint32_t n = 1u << m, first = 3u * n;
            const Buffer<Point4> buffer(test_device(), "points", n);
            test_program("low_discrepancy.cl")
                .kernel("later_points")
                .launch(n,
                        Arguments().add("first", first).add("seed", seed).add("points", buffer, "float4").add("n", n));
            const std::vector<Point4> later = buffer.download(), four = points(first, seed, n);
            for (std::uint32_t i = 0; i < n; ++i)
                REQUIRE((later[i].u[0] == four[i].u[2] && later[i].u[1] == four[i].u[3]));
            for (std::size_t d = 0; d < 4; ++d) {
                std::array<int, 4> cuts{};
                cuts[d] = m;
                REQUIRE(even(later, cuts));
            }
        }
}

TEST_CASE("later dimensions are the same point's, and even", "[low_discrepancy][tiny]") {
    check_later_dimensions({9u}, 3);
}

TEST_CASE("many later dimensions are the same point's, and even", "[low_discrepancy]") {
    check_later_dimensions({0u, 9u}, 8);
}

TEST_CASE("many scrambled points are a net up to the last indices", "[low_discrepancy]") {
    for (const std::uint32_t first : {0u, 0xfffff000u}) {
        const std::vector<Point4> many = points(first, 3u, 4096);
        for (int x = 0; x <= 12; ++x) CHECK(even(many, {x, 12 - x, 0, 0}));
        CHECK(even(many, {0, 0, 12, 0}));
        CHECK(even(many, {0, 0, 0, 12}));
        CHECK(even(many, {3, 2, 2, 2}));
    }
}

TEST_CASE("seeds scramble and shuffle differently", "[low_discrepancy][tiny]") {
    const std::vector<Point4> a = points(0, 1u, 64), b = points(0, 2u, 64);
    for (std::size_t d = 0; d < 4; ++d) {
        int same = 0;
        for (std::size_t i = 0; i < 64; ++i) same += a[i].u[d] == b[i].u[d];
        CHECK(same == 0);
    }
    std::vector<std::uint32_t> previous;
    for (const std::uint32_t seed : {1u, 2u}) {
        const Buffer<std::uint32_t> buffer(test_device(), "indices", 256);
        test_program("low_discrepancy.cl")
            .kernel("shuffled")
            .launch(256, Arguments().add("seed", seed).add("indices", buffer).add("n", 256u));
        const std::vector<std::uint32_t> indices = buffer.download();
        CHECK(indices != previous);
        previous = indices;
        for (std::size_t size = 1; size <= 256; size *= 2)  // each block is a block, in another order
            for (std::size_t i = 0; i < 256; ++i) REQUIRE(indices[i] / size == indices[i / size * size] / size);
    }
}

// A point of given index over 2^16 seeds in a row, some small and some large: each dimension in 256 cells, and each
// pair in 16 x 16. All 50 tests together are wrong once in 1000.
TEST_CASE("over seeds a point is uniform", "[low_discrepancy]") {
    const std::uint32_t n = 1u << 16;
    const double level = sidak_level(1e-3, 50);
    const Buffer<Point4> buffer(test_device(), "points", n);
    Kernel kernel = test_program("low_discrepancy.cl").kernel("points_of_seeds");
    for (const std::uint32_t index : {0u, 1u, 2u, 1000u, 0xffffffffu}) {
        kernel.launch(
            n,
            Arguments("index", index).add("first_seed", index * 0x10000u).add("points", buffer, "float4").add("n", n));
        const std::vector<Point4> all = buffer.download();
        const auto cell = [](float u, float parts) { return static_cast<std::size_t>(u * parts); };
        for (std::size_t d = 0; d < 4; ++d) {
            std::vector<double> counts(256, 0.0);
            for (const Point4& p : all) counts[cell(p.u[d], 256.0f)] += 1.0;
            CHECK(chi_square_uniform(counts) > level);
            for (std::size_t e = d + 1; e < 4; ++e) {
                std::vector<double> pairs(256, 0.0);
                for (const Point4& p : all) pairs[cell(p.u[d], 16.0f) * 16 + cell(p.u[e], 16.0f)] += 1.0;
                CHECK(chi_square_uniform(pairs) > level);
            }
        }
    }
}

// Shuffled sequences of two seeds, at one index: uniform in the square. Both tests together are wrong once in 1000.
TEST_CASE("joined sequences are independent over seeds", "[low_discrepancy]") {
    const std::uint32_t n = 1u << 16;
    const Buffer<Point2> buffer(test_device(), "points", n);
    Kernel kernel = test_program("low_discrepancy.cl").kernel("joined");
    for (const std::uint32_t index : {0u, 12345u}) {
        kernel.launch(n, Arguments().add("index", index).add("out", buffer, "float2").add("n", n));
        std::vector<double> counts(256, 0.0);
        for (const Point2& p : buffer.download())
            counts[static_cast<std::size_t>(p.x * 16.0f) * 16 + static_cast<std::size_t>(p.y * 16.0f)] += 1.0;
        CHECK(chi_square_uniform(counts) > sidak_level(1e-3, 2));
    }
}
