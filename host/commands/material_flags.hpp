// A translucent material given on the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "host/render/probe.hpp"

namespace stokes {

struct MaterialFlags {
    std::string sigma_s, sigma_a;      // a number or FILE.csv[:COLUMN] [1/mm]
    std::string excitation, emission;  // FILE.csv[:COLUMN] or a number
    std::string stokes_rule;
    std::string wavelength_unit, per, negative;  // of all files
    double eta = 1.0, fraction = 0.0, quantum_yield = 1.0;
    bool fresnel = false;
};

// The flags outlive the command.
void add_material_flags(CLI::App& command, MaterialFlags& flags);

// Whether any of them was given.
bool has_material_flags(const CLI::App& command);

// The material; values have the limits of a scene file's. InputError, one line that names the flag.
ProbeMaterial material_of(const CLI::App& command, const MaterialFlags& flags);

}  // namespace stokes
