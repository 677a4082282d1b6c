// Photon power tables: a transport model's distance functions on a grid.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/core/spectrum.hpp"

namespace stokes {

// A medium as tables need it.
struct MediumSpectra {
    std::string name;
    Spectrum sigma_s;         // [1/mm]
    Spectrum sigma_a;         // [1/mm]
    double eta = 1.0;         // refractive index, for the refraction angle; only noted in the table
    double dipole_eta = 1.0;  // refractive index in the dipole's A
};

// What a table says about the medium it was made for.
struct TableMedium {
    std::string name;
    std::vector<double> sigma_s;  // [1/mm], at the values of the lambda axis
    std::vector<double> sigma_a;  // [1/mm], likewise
    double eta = 1.0;
    double dipole_eta = 1.0;
};

struct TableAxis {
    std::string name;            // "r", "theta", "lambda"
    std::string unit;            // "mm", "deg", "nm"
    std::vector<double> values;  // strictly increasing
};

struct PowerTable {
    std::string model;      // "paper"
    std::string component;  // "fluorescence", "single" or "multiple"
    TableMedium medium;
    std::vector<TableAxis> axes;
    std::string unit;            // of the values
    std::vector<double> values;  // finite, not negative; as many as the axes' product, the last axis fastest

    // nullptr where the table has no axis of that name.
    const TableAxis* axis(const std::string& name) const;
};

// Grid of the tables; the default is the paper's: r = 0.0, 0.1 .. 9.9 mm, theta = 0.0, 0.9 .. 89.1 degrees,
// lambda = 300, 305 .. 795 nm.
struct TableGrid {
    std::vector<double> r_mm;       // not negative
    std::vector<double> theta_deg;  // in [0, 90]
    std::vector<double> lambda_nm;
    TableGrid();
};

// The medium at these wavelengths [nm]. Throws InputError naming the medium and the wavelength where a coefficient is
// negative or not finite, or where sigma_s + sigma_a is 0 (the integrals diverge) or too small or too large to compute
// with.
TableMedium table_medium(const MediumSpectra& medium, const std::vector<double>& lambda_nm);

// The three tables of the model `paper`: axes (r, theta, lambda), for multiple scattering (r, lambda).
// Units: T_F [mm], T_S [1], T_M [1/mm^2]. Relative error of every value below 1e-9.
// Throws InputError for a grid that is not one, and as table_medium() does.
PowerTable make_fluorescence_table(const MediumSpectra& medium, const TableGrid& grid = {});
PowerTable make_single_table(const MediumSpectra& medium, const TableGrid& grid = {});
PowerTable make_multiple_table(const MediumSpectra& medium, const TableGrid& grid = {});

// Writes the table to path as JSON, format "photon-power-table" version 1, complete or not at all; numbers keep every
// bit. Throws RunError when the file cannot be written.
void write_power_table(const PowerTable& table, const std::string& path);

}  // namespace stokes
