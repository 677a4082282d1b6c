#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "host/render/stratified_wavelengths.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/photon_fixture.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

using Strata = std::array<std::uint32_t, 16>;

PassConstants stratified_pass(const Strata& strata) {
    PassConstants pass{};
    pass.stratified = 1;
    std::copy(strata.begin(), strata.end(), pass.strata);
    for (std::size_t l = 0; l < level_shares.size(); ++l) pass.level_shares[l] = static_cast<float>(level_shares[l]);
    return pass;
}

// Of all pairs; four columns in sixteen are dark.
std::vector<Flux16> random_rows(std::mt19937& generator) {
    std::vector<Flux16> rows;
    for (std::size_t ex = 0; ex < 16; ++ex) {
        rows.push_back(random_flux(generator, 0.05, 1.0));
        for (std::size_t em = 0; em < 16; ++em)
            if (em <= ex || em % 4 == 1) rows.back().v[em] = 0.0f;
    }
    return rows;
}

struct Light {
    std::vector<Flux16> flux;
    std::vector<std::uint32_t> histories;
};

Light reradiated(const PassConstants& pass, const std::vector<Flux16>& rows, const Flux16& flux, cl_uint times,
                 const std::vector<float>& u) {
    const auto n = static_cast<cl_uint>(u.size() / times);
    const Buffer<Flux16> out(test_device(), "out", n);
    const Buffer<cl_uint> histories(test_device(), "histories", n);
    test_program("reradiation.cl")
        .kernel("reradiate_often")
        .launch(n, Arguments()
                       .add("pass", on_device(std::vector<PassConstants>{pass}))
                       .add("rows", on_device(rows))
                       .add("flux", on_device(std::vector<Flux16>{flux}))
                       .add("u", on_device(u))
                       .add("times", times)
                       .add("n", n)
                       .add("out", out)
                       .add("histories", histories));
    return {out.download(), histories.download()};
}

std::vector<float> random_numbers(std::mt19937& generator, std::size_t count) {
    std::vector<float> u(count);
    for (float& v : u) v = static_cast<float>(generator() >> 8) * 0x1p-24f;
    return u;
}

// Sum over all rows of wavelengths i < j < .. < em of flux rows rows .., each row in the place of its pairs'
// weights with the weight of all of it together.
double expected_at(std::size_t em, const std::vector<Flux16>& rows, const Flux16& flux, std::size_t times,
                   const Strata& strata, const std::vector<std::size_t>& after = {}) {
    double sum = 0.0;
    for (std::size_t ex = 0; ex < em; ++ex) {
        std::vector<std::size_t> chain = after;
        chain.push_back(em);
        const double row = static_cast<double>(rows[ex].v[em]) * pair_ratio(strata[ex], strata[em]);
        if (times > 1) {
            sum += row * expected_at(ex, rows, flux, times - 1, strata, chain);
        } else {
            std::vector<std::uint32_t> members{strata[ex]};
            for (const std::size_t k : chain) members.push_back(strata[k]);
            sum += row * static_cast<double>(flux.v[ex]) / joint_ratio(members);
        }
    }
    return sum;
}

}  // namespace

// 16 wavelengths, 3 sets of strata, up to 3 conversions: at most 144 comparisons, wrong together once in
// 1000.
TEST_CASE("light re-radiated several times has the weight of all its wavelengths together", "[reradiation]") {
    std::mt19937 generator(3);
    constexpr std::size_t n = 1u << 16;
    for (const Strata& strata : {Strata{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15},
                                 Strata{0, 0, 1, 1, 1, 2, 5, 5, 6, 8, 8, 8, 8, 12, 15, 15},
                                 Strata{7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7}})
        for (const cl_uint times : {1u, 2u, 3u}) {
            const std::vector<Flux16> rows = random_rows(generator);
            Flux16 flux = random_flux(generator, 0.2, 2.0);
            flux.v[3] = 0.0f;
            const Light light =
                reradiated(stratified_pass(strata), rows, flux, times, random_numbers(generator, n * times));
            for (std::size_t em = 0; em < 16; ++em) {
                Sample sample;
                for (const Flux16& f : light.flux) sample.add(static_cast<double>(f.v[em]));
                const double expected = expected_at(em, rows, flux, times, strata);
                CAPTURE(times, em, strata[1], expected, sample.mean(), sample.standard_error());
                CHECK(sample.standard_error() <= 0.08 * expected);
                CHECK(std::abs(sample.mean() - expected) <= 4.5 * sample.standard_error() + 1e-5 * expected);
            }
        }
}

// What the leader stands for: each draw sends on as much as all wavelengths together would.
TEST_CASE("a first conversion keeps its light whoever leads", "[reradiation][tiny]") {
    std::mt19937 generator(5);
    const std::vector<Flux16> rows = random_rows(generator);
    const Flux16 flux = random_flux(generator, 0.2, 2.0);
    const Strata strata{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    double total = 0.0;
    for (std::size_t ex = 0; ex < 16; ++ex) total += static_cast<double>(flux.v[ex]) * sum_of(rows[ex]);
    const Light light = reradiated(stratified_pass(strata), rows, flux, 1, random_numbers(generator, 200));
    for (std::size_t i = 0; i < light.flux.size(); ++i) {
        CHECK(sum_of(light.flux[i]) == Approx(total).epsilon(1e-5));
        CHECK((light.histories[i] != 0 && (light.histories[i] & (light.histories[i] - 1)) == 0));
    }
}

TEST_CASE("where no light is sent on, nobody leads", "[reradiation][tiny]") {
    std::mt19937 generator(6);
    const std::vector<Flux16> rows = random_rows(generator);
    Flux16 last = constant_flux(0.0f);
    last.v[15] = 1.0f;  // there is no wavelength above it
    for (const Flux16& flux : {constant_flux(0.0f), last}) {
        const Light light = reradiated(stratified_pass({}), rows, flux, 2, random_numbers(generator, 20));
        for (std::size_t i = 0; i < light.flux.size(); ++i) {
            CHECK(sum_of(light.flux[i]) == 0.0);
            CHECK(light.histories[i] == 0);
        }
    }
}
