#include <cmath>
#include <limits>

#include "host/core/error.hpp"
#include "host/subsurface/fresnel.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;

namespace {

// J. W. T. Walsh's integral (Duntley, "The optical properties of diffusing materials", J. Opt. Soc. Am. 32, 1942).
// Its terms cancel to the square of eta - 1.
double walsh(double n) {
    const double n2 = n * n, n4 = n2 * n2;
    return 0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0)) +
           n2 * std::pow(n2 - 1.0, 2) / std::pow(n2 + 1.0, 3) * std::log((n - 1.0) / (n + 1.0)) -
           2.0 * n * n2 * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0)) +
           8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * std::pow(n4 - 1.0, 2)) * std::log(n);
}

// Fresnel's equations by the angles, summed by the midpoint rule over the square of the sine.
double by_angles(double eta, int steps) {
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double sine = std::sqrt((i + 0.5) / steps);
        const double out = std::asin(sine), in = std::asin(sine / eta);
        const double s = std::sin(in - out) / std::sin(in + out), p = std::tan(in - out) / std::tan(in + out);
        sum += 0.5 * (s * s + p * p);
    }
    return sum / steps;
}

}  // namespace

TEST_CASE("diffuse reflectance is Walsh's integral") {
    for (const double eta : {1.05, 1.2, 1.33, 1.5, 2.0, 2.42, 3.5, 5.0, 20.0}) {
        CAPTURE(eta);
        CHECK(std::abs(diffuse_reflectance(eta) - walsh(eta)) < 1e-11);
    }
    CHECK_THAT(diffuse_reflectance(1.5), Catch::Matchers::WithinAbs(0.0918, 5e-5));
}

TEST_CASE("diffuse reflectance is the mean over the angles") {
    for (const double eta : {1.0001, 1.01, 1.5, 5.0}) {
        CAPTURE(eta);
        CHECK_THAT(diffuse_reflectance(eta), Catch::Matchers::WithinAbs(by_angles(eta, 1000000), 2e-6));
    }
}

TEST_CASE("diffuse reflectance rises from zero at index one") {
    CHECK(diffuse_reflectance(1.0) == 0.0);
    double last = 0.0;
    for (double eta = 1.0 + 1e-9; eta < 10.0; eta = 1.0 + 1.3 * (eta - 1.0)) {
        CAPTURE(eta);
        const double here = diffuse_reflectance(eta);
        CHECK(here > last);
        CHECK(here < 1.0);
        last = here;
    }
}

TEST_CASE("diffuse reflectance refuses an index below one") {
    for (const double eta : {0.99, 0.0, -1.5, std::numeric_limits<double>::infinity(), std::nan("")})
        CHECK_THROWS_AS(diffuse_reflectance(eta), InputError);
}
