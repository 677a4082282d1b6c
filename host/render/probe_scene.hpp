// The scene in which a material is probed: a flat half-space and a narrow beam.
#pragma once

#include "host/render/probe.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

// Of a material's medium, from first_lambda_nm to last_lambda_nm; 1 mm without a medium.
struct FreePaths {
    double shortest_mm = 1.0, longest_mm = 1.0;
};
FreePaths mean_free_paths(const ProbeMaterial& material);

// Spectral flux of 1 W in the one nanometre about a whole wavelength [W/nm].
Spectrum line_of(int lambda_nm);

// A sheet in the plane y = 0, facing up, of one body, and a beam that enters it at the origin, coming along
// +x, of 1 W at first_lambda_nm.
Scene probe_scene(const ProbeMaterial& material, const ProbeSettings& settings);

}  // namespace stokes
