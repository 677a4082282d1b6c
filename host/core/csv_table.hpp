// Tables of numbers over wavelength: `#` header lines, one line of column names, rows of numbers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/core/spectrum.hpp"

namespace stokes {

struct CsvTable {
    std::string file;                         // for messages
    std::vector<std::string> columns;         // names; the first column is the wavelength [nm]
    std::vector<std::vector<double>> values;  // [column][row]
    std::vector<std::int64_t> lines;          // [row], line in the file
};

// Throws InputError "FILE:LINE: ..." unless there are at least two columns with different names and one row,
// every row has as many finite numbers as there are columns, and wavelengths are positive and strictly
// increase.
CsvTable parse_csv(std::string_view text, const std::string& file);
CsvTable read_csv(const std::string& path);

// One column as a spectrum. Throws InputError when there is no such column or a value is negative.
Spectrum csv_spectrum(const CsvTable& table, const std::string& column, Outside outside);

}  // namespace stokes
