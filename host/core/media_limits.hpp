// What the tables of subsurface light can be made for, and so what a scene's media may be.
#pragma once

namespace stokes {

// sigma_s + sigma_a [1/mm]. Mean free paths from 1e-9 mm to 1e9 mm: far beyond any medium, and safe in the
// kernels' single precision.
inline constexpr double smallest_sigma_t_per_mm = 1e-9;
inline constexpr double largest_sigma_t_per_mm = 1e9;

// The dipole's fit of the internal diffuse reflectance reaches 1, which no boundary can have, at 3.85.
inline constexpr double largest_dipole_eta = 3.8;

// Green's function tables, which surfaces with Fresnel reflection need, end at this refractive index.
inline constexpr double largest_green_eta = 4.0;

}  // namespace stokes
