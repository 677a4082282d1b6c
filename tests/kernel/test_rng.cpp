#include <cmath>

#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"

using namespace stokes;

// Expected words: known-answer file of the Random123 distribution (philox 4x32-10).
TEST_CASE("philox4x32-10 gives the published words", "[rng][tiny]") {
    const std::vector<std::uint32_t> in = {0,          0,          0,          0,          0,          0,
                                           0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff,
                                           0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344, 0xa4093822, 0x299f31d0};
    const std::vector<std::uint32_t> expected = {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8,
                                                 0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd,
                                                 0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1};
    const Buffer<std::uint32_t> input(test_device(), "counters", in), words(test_device(), "words", 12);
    test_program("rng.cl")
        .kernel("philox_words")
        .launch(3, Arguments().add("counters_and_keys", input).add("words", words).add("n", std::uint32_t{3}));
    REQUIRE(words.download() == expected);
}

TEST_CASE("uniforms fill [0, 1) evenly and dimensions differ", "[rng]") {
    const std::uint32_t n = 1u << 16;
    const Buffer<float> out(test_device(), "uniforms", n * 4);
    Kernel kernel = test_program("rng.cl").kernel("uniforms");
    std::vector<float> previous;
    for (std::uint32_t dimension : {0u, 1u}) {
        kernel.launch(
            n, Arguments().add("seed", 7u).add("pass", 3u).add("dimension", dimension).add("out", out).add("n", n));
        const std::vector<float> u = out.download();
        std::vector<double> bins(64, 0.0);
        for (float x : u) {
            REQUIRE(x >= 0.0f);
            REQUIRE(x < 1.0f);
            bins[static_cast<std::size_t>(x * 64.0f)] += 1.0;
        }
        double chi2 = 0.0;
        for (double b : bins) chi2 += (b - n / 16.0) * (b - n / 16.0) / (n / 16.0);
        CHECK(chi2 < 114.0);  // chi-square with 63 degrees of freedom, upper tail 1e-4 (two draws, fixed seed)
        CHECK(u != previous);
        previous = u;
    }
}
