// Scenes whose light is known.
#pragma once

#include <string>

#include "host/scene/scene.hpp"

namespace stokes {

Material diffuse_material(double reflectance);

// Adds a body of its own.
Shape& add_shape(Scene& scene, const std::string& name, int material, const Mesh& mesh);

Mesh moved(Mesh mesh, const glm::dvec3& by_mm);
// The same surface with its front on the other side.
Mesh turned_over(Mesh mesh);

// That material, which is translucent.
TranslucentMaterial& translucent_of(Scene& scene, std::size_t material = 0);

// An empty scene, the start of every scene here. Its passes draw their wavelengths uniformly, as draw_wavelengths()
// does, and photons start evenly over the lights: to aim them takes trial passes that cost more than a test's passes.
Scene empty_scene(const std::string& name);

// A closed sphere of diffuse reflectance that shines inward with radiance 1 W m^-2 sr^-1 nm^-1 at every wavelength, the
// camera inside. Its radiance is 1 / (1 - reflectance) in every direction.
Scene furnace_scene(double reflectance);

// A square of marble (sigma_s 1.31, sigma_a 0.0041 per mm, eta 1.5) with Qdot-like fluorophore and fluorescent fraction
// c, facing up, 2 m wide, under a thin parallel beam at this angle from its normal, with power at all wavelengths.
Scene slab_scene(double fluorescent_fraction, double angle_deg, Transport transport = Transport::paper);

// A small closed world: a translucent sphere over a diffuse floor under a disk lamp.
Scene small_scene(Transport transport = Transport::paper);

}  // namespace stokes
