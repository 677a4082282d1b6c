// A column of a table as a spectrum.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/core/csv_table.hpp"
#include "host/core/spectrum.hpp"
#include "host/core/wavelength_unit.hpp"

namespace stokes {

// What becomes of values below zero.
enum class Negative { zero, refuse };
template <>
inline const Words words_of<Negative> = {"zero", "refuse"};

// Whether values are per nanometre (or no densities at all), or per unit of the wavelength column.
enum class Per { nm, unit };
template <>
inline const Words words_of<Per> = {"nm", "unit"};

// Below zero by up to this share of the largest value is noise about a dark level.
inline constexpr double dark_noise_share = 0.02;

// How samples are to be taken.
struct SampleRules {
    std::optional<WavelengthUnit> unit;  // none: what the table says; failing that, nm
    std::optional<Per> per;              // none: nm
    std::optional<Negative> negative;    // none: noise about a dark level becomes zero, with a remark; more is refused
};

struct ColumnSpectrum {
    Spectrum spectrum;
    std::vector<std::string> remarks;  // "FILE: ..", one line each
    // Why a density is in doubt, or "" (doubt_of_density).
    std::string density_doubt;
};

// A density over photon energy that nobody has said what it is per: "values over eV are taken ..". "" where there is no
// doubt.
std::string doubt_of_density(std::optional<WavelengthUnit> unit, const std::optional<Per>& per);

// Why a spectrum of probabilities is probably a relative one: a table of which no value comes near 1. "" where it is
// not.
std::string doubt_of_probability(const Spectrum& spectrum);

// The samples about 300 to 830 nm, wavelengths increasing. Blank cells at the ends of a column are where it has no
// data, as are the deleted channels of spectral libraries, -1e30 and below. InputError when there is no such column, no
// wavelength from 300 to 830 nm, no value there, a blank cell between values, or a value that is no number or too far
// below zero.
ColumnSpectrum read_column(const CsvTable& table, const std::string& column, Outside outside, const SampleRules& rules);

// The same of a table in nm without values below zero.
Spectrum csv_spectrum(const CsvTable& table, const std::string& column, Outside outside);

// Why samples at x, lowest to highest, cannot be wavelengths of light in this unit; "" where they can. unit none:
// nobody has said it.
std::string fault_of_range(std::optional<WavelengthUnit> unit, double low, double high);

}  // namespace stokes
