#include "host/subsurface/paper_transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/error.hpp"
#include "host/subsurface/quadrature.hpp"

namespace stokes {
namespace {

constexpr double kEulerGamma = 0.57721566490153286061;

// Beyond exp(-kNegligible) of its maximum an integrand is left out.
constexpr double kNegligible = 36.0;

// exp(-z cosh x) cosh x, the integrand of K_1(z) and of its incomplete forms.
double bessel_integrand(double z, double x) {
    const double c = std::cosh(x);
    return std::exp(-z * c) * c;
}

// integral_0^inf of the above, K_1(z): the trapezoidal rule converges exponentially, because the integrand is
// even, analytic in |Im x| < pi/2 and falls off doubly exponentially. The step follows the width of the peak.
double bessel_k1(double z, double x_end) {
    const double widest = std::min(0.3, 0.8 / std::sqrt(z));
    const int steps = static_cast<int>(std::ceil(x_end / widest));
    const double step = x_end / steps;
    double sum = 0.5 * std::exp(-z);
    for (int k = 1; k <= steps; ++k) sum += bessel_integrand(z, k * step);
    return sum * step;
}

double incomplete_bessel_k1(double z, double x_end) {
    static const GaussLegendre rule(24);
    const int panels = static_cast<int>(std::ceil(x_end / 3.0));
    const double width = panels == 0 ? 0.0 : x_end / panels;
    double sum = 0.0;
    for (int panel = 0; panel < panels; ++panel)
        for (std::size_t i = 0; i < rule.node.size(); ++i)
            sum += rule.weight[i] * bessel_integrand(z, (panel + rule.node[i]) * width);
    return sum * width;
}

}  // namespace

RefractionAngle RefractionAngle::from_degrees(double theta_deg) {
    // From the half complement h = (90 deg - theta) / 2: sin = 1 - 2 sin^2 h, cos = sin 2h, exact near 90
    // degrees.
    const double half_complement = (90.0 - theta_deg) * M_PI / 360.0;
    const double s = std::sin(half_complement);
    return {std::sin(theta_deg * M_PI / 180.0), std::sin(2.0 * half_complement), 2.0 * s * s};
}

// s(t) is the hypotenuse over b = r cos(theta) and u = t - r sin(theta); with u = b sinh(x) the integral is
// b (K_1(sigma_t b) + integral_0^X exp(-sigma_t b cosh x) cosh x dx), sinh X = tan(theta).
double fluorescence_power(double sigma_t, double r_mm, const RefractionAngle& theta) {
    const double foot = r_mm * theta.sine;
    const double b = r_mm * theta.cosine;
    const double z = sigma_t * b;
    // s(t) = |t - foot| to within b, so the integral is that of the two exponentials.
    if (z < 1e-10) return (1.0 - std::expm1(-sigma_t * foot)) / sigma_t;
    const double x_end = std::acosh(1.0 + kNegligible / z);
    const double x_foot = std::asinh(theta.sine / theta.cosine);
    return b * (bessel_k1(z, x_end) + incomplete_bessel_k1(z, std::min(x_foot, x_end)));
}

// With w = t - r sin(theta) + s(t), dt = (1 + b^2/w^2)/2 dw and t + s = r sin(theta) + w from w_0 = r (1 -
// sin(theta)): both parts of the integral are elementary or E_2.
double single_power(double sigma_s, double sigma_t, double r_mm, const RefractionAngle& theta) {
    const double direct = std::exp(-sigma_t * r_mm) / (2.0 * sigma_t);
    const double beyond = 0.5 * r_mm * (1.0 + theta.sine) * std::exp(-sigma_t * r_mm * theta.sine) *
                          exponential_integral_2(sigma_t * r_mm * theta.one_minus_sine);
    return sigma_s / (4.0 * M_PI) * (direct + beyond);
}

double multiple_power(double sigma_a, double sigma_t, double dipole_a, double r_mm) {
    const double diffusion = 1.0 / (3.0 * sigma_t);
    const double sigma_tr = std::sqrt(3.0 * sigma_a * sigma_t);
    const double z_real = 1.0 / sigma_t;
    const double z_virtual = z_real + 4.0 * dipole_a * diffusion;
    const double d_real = std::hypot(r_mm, z_real);
    const double d_virtual = std::hypot(r_mm, z_virtual);
    // The difference of the two sources, written without cancellation for r far beyond both depths.
    const double further = (z_virtual - z_real) * (z_virtual + z_real) / (d_virtual + d_real);
    const double kept = -std::expm1(-(sigma_tr * further + std::log1p(further / d_real)));
    return std::exp(-sigma_tr * d_real) / d_real * kept / (4.0 * M_PI * diffusion);
}

double dipole_boundary(double eta) {
    if (!std::isfinite(eta) || eta < 1.0)
        throw InputError(fmt::format("dipole_eta {} must be a finite number of at least 1", eta));
    if (eta == 1.0) return 1.0;
    const double f_dr = -1.440 / (eta * eta) + 0.710 / eta + 0.668 + 0.0636 * eta;
    if (f_dr >= 1.0) throw InputError(fmt::format("dipole_eta {} is beyond the range of the dipole's fit", eta));
    return (1.0 + f_dr) / (1.0 - f_dr);
}

double exponential_integral_2(double z) {
    if (z <= 0.0) return 1.0;
    if (z < 1.0) {  // E_2 = exp(-z) - z E_1, E_1 by its power series
        double e1 = -kEulerGamma - std::log(z), power = -1.0;
        for (int k = 1; k <= 20; ++k) {
            power *= -z / k;
            e1 += power / k;
        }
        return std::exp(-z) - z * e1;
    }
    // Stieltjes' continued fraction, contracted, from its tail upward: exp(-z)/(z+2 - 1*2/(z+4 - 2*3/(z+6 -
    // ...))).
    const int depth = 12 + static_cast<int>(60.0 / z);
    double fraction = z + 2.0 + 2.0 * depth;
    for (int k = depth; k >= 1; --k) fraction = z + 2.0 * k - k * (k + 1.0) / fraction;
    return std::exp(-z) / fraction;
}

}  // namespace stokes
