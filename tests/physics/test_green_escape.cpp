#include <cmath>
#include <vector>

#include "host/subsurface/escape.hpp"
#include "host/subsurface/quadrature.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/half_space.hpp"
#include "tests/support/input_error.hpp"

using namespace stokes;

namespace {

// Light that arrives within the medium at cosine mu: what leaves after one collision, and after all.
struct Reflectance {
    double single = 0.0, total = 0.0;
};

Reflectance reflectance_within(double eta, double mu, double albedo) {
    const Escaping share = escaping_share(eta, mu, albedo);
    return {albedo * share.direct, albedo * share.total};
}

// From outside, cosine mu, the specular reflection included.
double reflectance_outside(double eta, double mu, double albedo) {
    const double mu_within = cosine_within(eta, mu);
    const double specular = internal_reflectance(mu_within, eta);
    return specular + (1.0 - specular) * reflectance_within(eta, mu_within, albedo).total;
}

}  // namespace

TEST_CASE("escape gives Chandrasekhar's reflectance of a half-space", "[green_escape]") {
    for (const auto& c : chandrasekhar) {
        CAPTURE(c.albedo, c.mu);
        CHECK(reflectance_within(1.0, c.mu, c.albedo).total == Approx(c.expected).margin(1e-7));
    }
}

TEST_CASE("unscattered escape gives the single-scattering reflectance", "[green_escape]") {
    CHECK(reflectance_within(1.0, 1.0, 0.9).single == Approx(0.1380838).margin(1e-7));
    CHECK(reflectance_within(1.0, 0.5, 0.9).single == Approx(0.2028122).margin(1e-7));
    for (const double mu : {1.0, 0.5, 0.1})
        CHECK(reflectance_within(1.0, mu, 0.7).single ==
              Approx(0.35 * (1.0 - mu * std::log(1.0 + 1.0 / mu))).margin(1e-8));
}

// Adding-doubling and a random walk agree on these to 5e-5 (PHYSICS section 4).
TEST_CASE("escape gives the reflectance below a refracting surface", "[green_escape]") {
    CHECK(reflectance_outside(1.5, 1.0, 0.9) == Approx(0.2599).margin(5e-5));
    CHECK(reflectance_outside(1.5, 1.0, 0.99) == Approx(0.6020).margin(5e-5));
    CHECK(reflectance_outside(1.33, 1.0, 0.9) == Approx(0.2948).margin(5e-5));
    CHECK(reflectance_outside(1.33, 1.0, 0.99) == Approx(0.6530).margin(5e-5));

    const GaussLegendre rule(12);
    const double diffuse =
        rule.integral(0.0, 1.0, [](double mu) { return 2.0 * mu * reflectance_outside(1.5, mu, 0.9); });
    CHECK(diffuse == Approx(0.3079).margin(1e-4));
}

// An isotropic source at the surface, eta = 1: U(0) = 1/2 integral_0^1 H(mu) dmu = (1 - sqrt(1 - a))/a
// (Chandrasekhar).
TEST_CASE("escape from the surface and without loss is exact", "[green_escape]") {
    for (const double eta : {1.0, 1.33, 1.5, 2.0}) {
        const HalfSpaceEscape escape(eta, {0.0, 1e-3, 0.3, 2.0, 30.0});
        CHECK(escape.total(0.0) == escape.unscattered());
        for (const double u : escape.total(1.0)) CHECK(u == 1.0);
        // U is analytic in sqrt(1 - a), so that the limit is approached linearly in it.
        const std::vector<double> near = escape.total(1.0 - 1e-4), nearer = escape.total(1.0 - 1e-6);
        for (std::size_t i = 0; i < near.size(); ++i)
            CHECK((1.0 - nearer[i]) * 10.0 == Approx(1.0 - near[i]).epsilon(0.6));
        for (std::size_t i = 0; i + 1 < near.size(); ++i) CHECK(near[i] > near[i + 1]);
    }
    const HalfSpaceEscape surface(1.0, {0.0});
    for (const double a : {0.2, 0.9, 0.99, 0.9999})
        CHECK(surface.total(a)[0] == Approx(1.0 / (1.0 + std::sqrt(1.0 - a))).margin(1e-7));
}

// a atanh(kappa) = kappa; near a = 1 kappa = sqrt(3 (1 - a)) (1 - 2/5 (1 - a) ..).
TEST_CASE("the decay deep in the medium solves its equation", "[green_escape]") {
    for (const double a : {0.1, 0.5, 0.9, 0.99, 0.999}) {
        const double kappa = diffusion_decay(a);
        CHECK(a * std::atanh(kappa) == Approx(kappa).epsilon(1e-6));
    }
    CHECK(diffusion_decay(1.0 - 1e-6) == Approx(std::sqrt(3e-6)).epsilon(1e-6));
    CHECK(diffusion_decay(1.0) == 0.0);
    CHECK(diffusion_decay(0.0) == Approx(1.0));
}

TEST_CASE("escape refuses what is no half-space", "[green_escape]") {
    CHECK(input_error([] { HalfSpaceEscape(0.9, {1.0}); }) == "eta 0.9: expected a refractive index from 1 to 4");
    CHECK(input_error([] { HalfSpaceEscape(std::nan(""), {1.0}); }) != "");
    CHECK(input_error([] { HalfSpaceEscape(1.0, {1.0}).total(1.1); }) == "albedo 1.1: expected a number from 0 to 1");
}
