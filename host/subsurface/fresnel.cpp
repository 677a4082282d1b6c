#include "host/subsurface/fresnel.hpp"

#include <cmath>
#include <string>

#include "host/core/error.hpp"
#include "host/subsurface/quadrature.hpp"

namespace stokes {

// With mu = w sinh(u) and w^2 = eta^2 - 1, eta times the cosine within is w cosh(u), so that the amplitude of s light
// is exp(-2u): no square root is left, and eta near 1 takes no more nodes than any other.
double diffuse_reflectance(double eta) {
    if (!(eta >= 1.0 && std::isfinite(eta)))
        throw InputError("eta: expected a number of at least 1, got " + std::to_string(eta));
    if (eta == 1.0) return 0.0;
    static const GaussLegendre quadrature(64);
    const double square = (eta - 1.0) * (eta + 1.0), index2 = eta * eta;
    const double sum = quadrature.integral(0.0, std::asinh(1.0 / std::sqrt(square)), [&](double u) {
        const double s = std::exp(-2.0 * u);
        const double p = (1.0 - index2 * std::tanh(u)) / (1.0 + index2 * std::tanh(u));
        return std::sinh(u) * std::cosh(u) * (s * s + p * p);
    });
    return square * sum;
}

}  // namespace stokes
