// What kernels/lib/integrated_distance.clh draws exit distances from where there are no power tables: the
// medium's coefficients at the tables' wavelengths, and with which probability each wavelength is chosen.
#pragma once

#include <vector>

#include "host/subsurface/power_table.hpp"
#include "kernels/shared/integrated_power.h"
#include "kernels/shared/limits.h"

namespace stokes {

// To be put behind one another for all media of a scene.
struct MediumMixture {
    DistanceMixture record{};  // first: where its rows stand, as given
    std::vector<float> rows;   // STOKES_MIX_ROWS * wavelengths
};

// The wavelengths, the last distance and the last angle are those of the grid, so that distances have the
// density of the tables on that grid (lambda counted once each). first: of the rows in their buffer [floats].
// Throws InputError as table_medium() and dipole_boundary() do.
MediumMixture make_medium_mixture(const MediumSpectra& medium, std::size_t first = 0, const TableGrid& grid = {});

}  // namespace stokes
