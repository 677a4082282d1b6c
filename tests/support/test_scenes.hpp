// Scenes whose light is known. Passes draw their wavelengths uniformly, as draw_wavelengths() does.
#pragma once

#include "host/scene/scene.hpp"

namespace stokes {

// That material, which is translucent.
TranslucentMaterial& translucent_of(Scene& scene, std::size_t material = 0);

// A closed sphere of diffuse reflectance that shines inward with radiance 1 W m^-2 sr^-1 nm^-1 at every wavelength, the
// camera inside. Its radiance is 1 / (1 - reflectance) in every direction.
Scene furnace_scene(double reflectance);

// A square of marble (sigma_s 1.31, sigma_a 0.0041 per mm, eta 1.5) with Qdot-like fluorophore and fluorescent fraction
// c, facing up, 2 m wide, under a thin parallel beam at this angle from its normal, with power at all wavelengths.
Scene slab_scene(double fluorescent_fraction, double angle_deg, Transport transport = Transport::paper);

// A small closed world: a translucent sphere over a diffuse floor under a disk lamp.
Scene small_scene(Transport transport = Transport::paper);

}  // namespace stokes
