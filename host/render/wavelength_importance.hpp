// Where in the spectrum a scene's light is.
#pragma once

#include <optional>
#include <vector>

#include "host/render/stratified_wavelengths.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

// How often each wavelength of the render's range should be in a set: 16 in all, at most once each, and a
// tenth of them uniform, so that none is missed. The rest follows the root of a sum of squares, over
// what the picture is made of, each brought to a sum of 1 over wavelengths:
//   lamp x reflectance x eye, mean over lamps and materials; for each fluorophore that a material has, lamp x
//   excitation, mean over lamps, three times; and what it emits of that, by Stokes' law, x eye, mean over lamps. eye:
//   the colour matching functions X, Y, Z, each by itself.
// For shares of a variance f_k^2/m of several sums add up, and the root of their sum of squares makes it
// least.
std::vector<double> wavelength_importance(const Scene& scene);

// What a render draws its wavelengths from; none: uniformly (draw_wavelengths), as the scene has it, or
// because there are no more than 16.
std::optional<StratifiedWavelengths> stratified_wavelengths(const Scene& scene);

}  // namespace stokes
