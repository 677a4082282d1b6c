// What `stokes probe` prints and writes.
#pragma once

#include <string>
#include <vector>

#include "host/render/probe.hpp"

namespace stokes {

// For a person: shares of the energy, the emission spectrum, the exitance by distance; rows of nothing are
// left out.
std::string probe_table(const ProbeResult& result, const ProbeMaterial& material, const ProbeSettings& settings);

// The whole result as JSON; scenes/COMMANDS.md describes the keys.
std::string probe_json(const ProbeResult& result, const ProbeMaterial& material, const ProbeSettings& settings);

// Measurements at increasing excitation wavelengths, all with the same grid lambda_nm, as CSV: lambda_ex_nm,
// elastic (the share of the energy that leaves at lambda_ex_nm), then by emission wavelength the fluorescence
// [1/nm].
std::string probe_matrix_csv(const std::vector<ProbeResult>& results, const ProbeMaterial& material,
                             const ProbeSettings& settings);

}  // namespace stokes
