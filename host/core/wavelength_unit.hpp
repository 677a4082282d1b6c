// What the first column of a table over wavelength may be in.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/core/words.hpp"

namespace stokes {

// The last three are photon energy, wavenumber and frequency.
enum class WavelengthUnit { nm, um, angstrom, m, ev, per_cm, thz };
template <>
inline const Words words_of<WavelengthUnit> = {"nm", "um", "angstrom", "m", "eV", "cm-1", "THz"};

// Wavelength in vacuum [nm] of x > 0 in this unit.
double wavelength_nm(WavelengthUnit unit, double x);

// |dx/dlambda| at this wavelength: a density per unit of x times it is a density per nm.
double units_per_nm(WavelengthUnit unit, double lambda_nm);

// Whether equal steps of x are no equal steps of wavelength.
bool is_reciprocal(WavelengthUnit unit);

// The words of a column's name in lower case, units spelled alike: "percm" is cm^-1, cm-1 and 1/cm.
std::vector<std::string> name_words(std::string_view name);

// The unit that a column's name or the line of units below it says: "wavelength_um", "Wavelength (nm)", "lambda [µm]",
// "cm^-1", UTF-8. None where it says none, or several.
std::optional<WavelengthUnit> unit_in(std::string_view name);

// "um or eV": other usual units in which some x from low to high would lie at first_lambda_nm to last_lambda_nm; "" for
// none.
std::string units_that_fit(WavelengthUnit unit, double low, double high);

}  // namespace stokes
