// Tables of numbers over wavelength, as this project and others write them: comments, text before the table, a line of
// column names or none, rows of numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stokes {

struct CsvTable {
    std::string file;                                // for messages
    std::vector<std::string> columns;                // names, "" where a column has none
    std::vector<std::vector<double>> values;         // [column][row]; no number: nan
    std::vector<std::int64_t> lines;                 // [row], line in the file
    std::vector<std::vector<std::string>> headings;  // [column]: all text above it, from the rows upward
    std::vector<std::string> notes;                  // text before the rows that has no cells for the columns
    bool wavelengths_first = true;  // false: the first column is not named as wavelengths, and another one is
    bool named = true;              // false: the file has no line of names, and its columns are "1", "2", ..
    // [{column, row}]: what stands there in the place of a number, unless it is nothing.
    std::map<std::pair<std::size_t, std::size_t>, std::string> texts;
};

// Comments are lines that start with #, %, ! or //. The first row decides what separates cells: tabs, semicolons,
// commas, bars or blanks; where commas do not, they are decimal ones. The line before the first row, or the last
// comment before it, has the names if it has as many cells; what else stands before it is skipped, unless it starts
// with a number (headings and notes keep it all). A line of units may stand below the names. InputError "FILE:LINE:
// ..." unless there are two columns at least, every row has as many cells as the first, and its wavelengths are
// positive and increase, or decrease, throughout: those of the first column, unless there are others (axis_of).
CsvTable parse_csv(std::string_view text, const std::string& file);
CsvTable read_csv(const std::string& path);

// The place of a column: by name, by other text above it, or by number, "2" for the one after the wavelength, where no
// column has that name.
// InputError when there is no such column, or several.
std::size_t csv_column(const CsvTable& table, const std::string& name);

}  // namespace stokes
