// How much of a point source's light ever leaves a scattering half-space: exact transport, no random numbers.
//
// The half-space scatters isotropically with albedo a, has the refractive index eta relative to the outside
// and a smooth surface with unpolarised Fresnel reflection R(mu), T = 1 - R, total beyond the critical angle.
// Depths are optical, in mean free paths.
#pragma once

#include <vector>

namespace stokes {

// Fresnel reflectance at the surface from within, mu the cosine of incidence in [0, 1].
double internal_reflectance(double mu, double eta);

// kappa in [0, 1]: deep in the medium light falls off as exp(-kappa z). The root of a atanh(kappa) = kappa; 0
// for a = 1.
double diffusion_decay(double albedo);

// u0(z) = 1/2 integral_0^1 T(mu) exp(-z/mu) dmu: the probability that light of an isotropic source at depth z
// >= 0 leaves without a collision and without an internal reflection. Error below 1e-8.
double unscattered_escape(double z, double eta);

// U(z), the probability of ever leaving, at a list of depths:
//   U(z) = u0(z) + a integral_0^inf K(z, z') U(z') dz',
//   K(z, z') = 1/2 [E_1(|z - z'|) + integral_0^1 R(mu) exp(-(z + z')/mu) dmu/mu],
// the second term being light that is reflected by the surface between two collisions. Solved by collocation
// with piecewise polynomials on panels graded toward the surface; the kernel's singularities are integrated
// by panels graded toward them. Error below 1e-6 for every albedo up to 1 - 1e-6, and for 1 itself.
class HalfSpaceEscape {
  public:
    // depths: not negative and finite. Throws InputError for eta outside [1, 4].
    HalfSpaceEscape(double eta, std::vector<double> depths);

    // U at the depths, in their order; exactly 1 for albedo 1. Throws InputError for an albedo outside [0,
    // 1].
    std::vector<double> total(double albedo) const;
    // u0 at the depths.
    const std::vector<double>& unscattered() const { return unscattered_; }

  private:
    double eta_;
    std::vector<double> depths_, unscattered_;
    std::vector<double> nodes_, node_unscattered_;  // of the collocation
    std::vector<double> node_kernel_;               // [node][node]: integral K L_j, L_j the node's polynomial
    std::vector<double> depth_kernel_;              // [depth][node]
};

}  // namespace stokes
