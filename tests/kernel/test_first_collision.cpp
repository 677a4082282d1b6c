#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/photon_fixture.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

struct Float2 {
    float x, y;
};

struct Collisions {
    std::vector<float> way_mm;
    std::vector<Flux16> weights;  // [n][way, fluorescent, elastic]
    std::vector<float> branch;
};

Collisions draw(const Flux16& sigma_t, const Flux16& uptake, const std::vector<Float2>& u) {
    const auto n = static_cast<cl_uint>(u.size());
    const Buffer<float> way(test_device(), "way", n), branch(test_device(), "branch", n);
    const Buffer<Flux16> weights(test_device(), "weights", std::size_t{3} * n);
    test_program("first_collision.cl")
        .kernel("draw_collisions")
        .launch(n, Arguments()
                       .add("sigma_t", on_device(std::vector<Flux16>{sigma_t}))
                       .add("uptake", on_device(std::vector<Flux16>{uptake}))
                       .add("u", on_device(u), "float2")
                       .add("n", n)
                       .add("way_mm", way)
                       .add("weights", weights)
                       .add("branch", branch));
    return {way.download(), weights.download(), branch.download()};
}

std::vector<Float2> random_pairs(std::size_t n, unsigned seed) {
    std::mt19937 generator(seed);
    std::vector<Float2> u(n);
    for (Float2& pair : u) {
        pair.x = static_cast<float>(generator() >> 8) * 0x1p-24f;
        pair.y = static_cast<float>(generator() >> 8) * 0x1p-24f;
    }
    return u;
}

// From 0.05 to 40 per mm, in no order.
Flux16 mixed_sigma() {
    Flux16 sigma;
    for (std::size_t k = 0; k < 16; ++k)
        sigma.v[k] = static_cast<float>(0.05 * std::pow(800.0, double((k * 7) % 16) / 15.0));
    return sigma;
}

Flux16 mixed_uptake() {
    Flux16 uptake;
    for (std::size_t k = 0; k < 16; ++k) uptake.v[k] = k < 6 ? 0.9f - 0.12f * static_cast<float>(k) : 0.0f;
    return uptake;
}

}  // namespace

// Single precision: 16 densities are added, each with some roundings.
TEST_CASE("collision weights are those of the balance heuristic, and at most 16", "[first_collision][tiny]") {
    const Flux16 sigma = mixed_sigma(), uptake = mixed_uptake();
    std::vector<Float2> u = random_pairs(200, 1);
    u.push_back({0.0f, 0.0f});
    u.push_back({1.0f - 0x1p-24f, 1.0f - 0x1p-24f});
    const Collisions drawn = draw(sigma, uptake, u);
    for (std::size_t i = 0; i < u.size(); ++i) {
        const auto j = static_cast<std::size_t>(u[i].x * 16.0f);
        CAPTURE(i, j, u[i].y);
        CHECK(double(drawn.way_mm[i]) ==
              Approx(-std::log1p(-double(u[i].y)) / double(sigma.v[j])).epsilon(1e-5).margin(1e-9));
        std::array<double, 16> density;
        double sum = 0.0;
        for (std::size_t k = 0; k < 16; ++k)
            sum += density[k] = double(sigma.v[k]) * std::exp(-double(sigma.v[k]) * double(drawn.way_mm[i]));
        double p = 0.0, fluorescent = 0.0, elastic = 0.0;
        for (std::size_t k = 0; k < 16; ++k) {
            const double weight = 16.0 * density[k] / sum;
            CHECK(double(drawn.weights[3 * i].v[k]) == Approx(weight).epsilon(2e-5).margin(1e-9));
            CHECK(drawn.weights[3 * i].v[k] <= 16.0f * 1.00001f);
            p += weight * double(uptake.v[k]) / 16.0;
            fluorescent += double(drawn.weights[3 * i + 1].v[k]);
            elastic += double(drawn.weights[3 * i + 2].v[k]);
            CHECK(drawn.weights[3 * i + 1].v[k] <= 16.0f * 1.00001f);
            CHECK(drawn.weights[3 * i + 2].v[k] <= 16.0f * 1.00001f);
        }
        CHECK(double(drawn.branch[i]) == Approx(p).epsilon(2e-5).margin(1e-9));
        if (p > 1e-6) CHECK(fluorescent == Approx(16.0).epsilon(1e-5));
        CHECK(elastic == Approx(16.0).epsilon(1e-5));
    }
}

// The mean weight of each wavelength is one, and so is that of its two branches together; the mean of its weight times
// the way is its mean free path. 32 comparisons at 4.3 standard errors, together wrong once in 1800.
TEST_CASE("every wavelength has mean weight one, and its own mean free path", "[first_collision]") {
    const Flux16 sigma = mixed_sigma(), uptake = mixed_uptake();
    const std::size_t n = 1u << 18;
    const Collisions drawn = draw(sigma, uptake, random_pairs(n, 2));
    const std::vector<Float2> branch = random_pairs(n, 3);
    for (std::size_t k = 0; k < 16; ++k) {
        Sample weight, path;
        for (std::size_t i = 0; i < n; ++i) {
            const bool fluorescent = branch[i].x < drawn.branch[i];
            const double w = double(drawn.weights[3 * i + (fluorescent ? 1 : 2)].v[k]);
            weight.add(w);
            path.add(double(drawn.weights[3 * i].v[k]) * double(drawn.way_mm[i]) * double(sigma.v[k]));
        }
        CAPTURE(k, sigma.v[k], weight.mean(), path.mean());
        CHECK(weight.standard_error() < 0.02);
        CHECK(std::abs(weight.z(1.0)) < 4.3);
        CHECK(std::abs(path.z(1.0)) < 4.3);
    }
}

TEST_CASE("a medium whose wavelengths are alike has weights of one", "[first_collision][tiny]") {
    const Collisions drawn = draw(constant_flux(1e-6f), constant_flux(1.0f), random_pairs(64, 4));
    for (std::size_t i = 0; i < 64; ++i) {
        CHECK(drawn.branch[i] == Approx(1.0f));
        for (std::size_t k = 0; k < 16; ++k) CHECK(drawn.weights[3 * i].v[k] == Approx(1.0f));
    }
}
