// Lights of a scene file.
#pragma once

#include "host/core/json_cursor.hpp"
#include "host/scene/readers/placement.hpp"
#include "host/scene/readers/spectrum_reader.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

// Reads "lights" into scene.lights, all but the flux of emitters, and the surfaces of emitters into placement;
// scene.render and scene.materials are read already. An emitter without a material is black. Throws InputError.
void read_lights(const JsonCursor& lights, SpectrumReader& spectra, Scene& scene, Placement& placement);

// Reads the flux of emitters, whose surfaces are in scene.shapes now. Power, radiance and irradiance are totals over
// the render's wavelengths: spectral flux = total * spectrum / (sum of the spectrum over lambda_min..lambda_max at 1
// nm). The power of a surface of radiance L is pi * area * L. Throws InputError.
void read_emitter_spectra(const JsonCursor& lights, SpectrumReader& spectra, Scene& scene);

}  // namespace stokes
