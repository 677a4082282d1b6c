// The cells of a table's lines: separators, quotes, decimal commas.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stokes {

struct CsvCell {
    std::string text;              // without blanks around it and quotes
    std::optional<double> number;  // finite; exponents may be written with D
    bool blank = false;            // nothing, or a word that says so: nan, n/a, null ..
    bool decimal_comma = false;    // the number has one
    bool decimal_point = false;
};

// What separates cells, in the order in which they are tried; ' ' is any number of blanks and tabs.
inline constexpr std::string_view csv_separators = "\t;,| ";

// Quotes hold separators together. Commas are decimal ones where they do not separate.
std::vector<CsvCell> csv_cells(std::string_view line, char separator);

// The separator by which a line is a row of numbers: the first by which its first cell is one and all others are
// numbers or blank; failing that, where anything but blanks separates, the first by which another cell is a number.
std::optional<char> separator_of_row(std::string_view line);

// The text with blanks for no-break and thin spaces, but for those between digits: they may stand between thousands.
std::string with_plain_blanks(const std::string& text);

// Whether the line starts with a number, by any separator.
bool starts_with_number(std::string_view line);

// A number that may as well be a whole one with a comma between thousands: "1,234", but not "0,234" or "1,23".
bool may_have_thousands(std::string_view number);

}  // namespace stokes
