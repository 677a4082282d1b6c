// What the text above a table says of its columns: which of them has the wavelengths, in what unit, what is in percent.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "host/core/csv_table.hpp"
#include "host/core/wavelength_unit.hpp"

namespace stokes {

// Whether a name is that of wavelengths, photon energies, wavenumbers or frequencies in a known unit: "Wavelength
// (nm)", "lambda", "nm", "Energy (eV)".
bool names_wavelengths(std::string_view name);

struct CsvAxis {
    std::size_t column;                  // that of the wavelengths
    std::optional<WavelengthUnit> unit;  // as the text above the table says it
};

// The wavelengths of a column: the nearest column on its left that is named as such, or the first of several side by
// side. InputError where it is unclear which column that is, or where it is named as something else and nobody has said
// its unit.
CsvAxis axis_of(const CsvTable& table, std::size_t column, bool unit_said);

// The text by which a column is in percent; "" where nothing says so.
std::string percent_above(const CsvTable& table, std::size_t column);

// The text by which a column is per centimetre, and its wavelengths are no wavenumbers; "" where nothing says so.
std::string per_cm_above(const CsvTable& table, std::size_t column);

// "column .. is read as ..", for a column that these say so of.
std::string doubt_of_percent(const std::string& column, const std::string& said);
std::string doubt_of_per_cm(const std::string& column, const std::string& said);

}  // namespace stokes
