// The photon power functions of the transport model `paper`, at one point.
// Source: Kugita, Kaneda, Raytchev, Tamaki, "Spectral Rendering of Fluorescence on Translucent Materials",
// eq. 3-5.
//
// With s(t) = sqrt(r^2 + t^2 - 2 r t sin(theta)), r the distance from entry to exit [mm], theta the
// refraction angle, coefficients [1/mm]; sigma_t = sigma_s + sigma_a must be positive and finite.
#pragma once

namespace stokes {

// Refraction angle; both parts are kept because 1 - sin and cos cancel badly when derived from each other.
struct RefractionAngle {
    double sine = 0.0;
    double cosine = 1.0;
    double one_minus_sine = 1.0;

    // theta in [0, 90] degrees.
    static RefractionAngle from_degrees(double theta_deg);
};

// T_F = integral_0^inf exp(-sigma_t s(t)) dt [mm], eq. 3. Relative error below 1e-9.
double fluorescence_power(double sigma_t, double r_mm, const RefractionAngle& theta);

// T_S = sigma_s / (4 pi) integral_0^inf exp(-sigma_t (t + s(t))) dt [1], eq. 4. Relative error below 1e-12.
double single_power(double sigma_s, double sigma_t, double r_mm, const RefractionAngle& theta);

// T_M [1/mm^2], the dipole's fluence, eq. 5; dipole_a is A of dipole_boundary().
double multiple_power(double sigma_a, double sigma_t, double dipole_a, double r_mm);

// A = (1 + F_dr) / (1 - F_dr), F_dr the diffuse Fresnel reflectance of a medium of refractive index eta >= 1
// (the fit of Jensen et al. 2001); 1 for eta = 1. Throws InputError for other eta.
double dipole_boundary(double eta);

// E_2(z) = integral_1^inf exp(-z t) / t^2 dt for z >= 0. Relative error below 1e-13.
double exponential_integral_2(double z);

}  // namespace stokes
