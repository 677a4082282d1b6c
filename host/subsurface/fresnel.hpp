// Fresnel reflection at the smooth surface of a dielectric.
#pragma once

namespace stokes {

// Share of diffuse light (the same radiance from everywhere) that the surface of a body of refractive index eta >= 1
// reflects back outside: 2 * integral over mu in [0, 1] of mu R(mu), R unpolarised (kernels/lib/fresnel.clh).
// To 1e-12; 0 for eta = 1. InputError for an eta that is below 1 or not finite.
double diffuse_reflectance(double eta);

}  // namespace stokes
