// What a scene asks of its transport model that the model does not give.
#pragma once

#include <string>
#include <vector>

#include "host/scene/scene.hpp"

namespace stokes {

// What the chosen transport ignores or makes of the scene's materials, one line each: with `paper`, fluorophores that
// give off more than they take up, and surfaces whose Fresnel reflection is left out.
std::vector<std::string> model_remarks(const Scene& scene);

// Where `paper` and `conserving` take a body for a half-space that it does not resemble; at most one line per material,
// of the body that is farthest from one, at the wavelength of the render's range where light goes farthest. `walk`
// takes bodies as they are and has none.
//
// Thin: the median thickness (host/scene/mesh/mesh_thickness.hpp) is less than the reach of light, the larger of
// - the diffuse length 1/sqrt(3 sigma_a sigma_t), over which diffuse light falls to 1/e;
// - 3 mean free paths 1/sigma_t, which 5 % of the light passes without a collision.
// A slab as thick as the diffuse length absorbs tanh(1/2) = 0.46 of what the half-space does.
//
// Curved: the mean curvature, averaged over the area, times the diffuse length (at least a mean free path) is above 1
// in magnitude. For diffuse light this product is the first-order error in the light absorbed: the slope of the
// diffusion equation's solution at a sphere's surface is (coth(R/L) - L/R)/L within and (1 + L/R)/L around it, at a
// plane 1/L. A ball with R = L absorbs 0.31 of what the half-space does.
//
// Flat sheets are half-spaces: neither thin nor curved.
std::vector<std::string> failed_assumptions(const Scene& scene);

// The lines of the functions above as warnings on standard error.
void warn_about_models(const Scene& scene);
void warn_about_assumptions(const Scene& scene);

}  // namespace stokes
