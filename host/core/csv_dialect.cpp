#include "host/core/csv_dialect.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "host/core/text_input.hpp"

namespace stokes {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return std::string(text);
}

bool says_nothing(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const char* word : {"", "nan", "na", "n/a", "#n/a", "null", "none", "-", "--"})
        if (text == word) return true;
    return false;
}

CsvCell cell_of(const std::string& text, bool comma_is_decimal) {
    CsvCell cell;
    cell.text = text;
    cell.blank = says_nothing(text);
    std::string number = text;
    const auto commas = std::count(number.begin(), number.end(), ',');
    cell.decimal_point = number.find('.') != std::string::npos;
    if (comma_is_decimal && commas == 1 && !cell.decimal_point) {
        number[number.find(',')] = '.';
        cell.decimal_comma = true;
    }
    if (const std::size_t d = number.find_first_of("dD"); d != std::string::npos && d > 0) number[d] = 'e';
    cell.number = parse_double(number);
    if (cell.number && !std::isfinite(*cell.number)) cell.number.reset();
    return cell;
}

}  // namespace

std::vector<CsvCell> csv_cells(std::string_view line, char separator) {
    std::vector<CsvCell> cells;
    std::string text;
    bool within = false, quoted = false;
    const auto end_cell = [&] {
        cells.push_back(cell_of(trimmed(text), separator != ',' || quoted));
        text.clear();
        quoted = false;
    };
    const std::string whole = separator == '\t' ? std::string(line) : trimmed(line);
    const std::string_view rest = whole;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const char c = rest[i];
        if (c == '"') {
            const bool doubled = within && i + 1 < rest.size() && rest[i + 1] == '"';
            if (doubled) text += rest[++i];
            if (!doubled) within = !within;
            quoted = true;
        } else if (within || !(separator == ' ' ? is_blank(c) : c == separator)) {
            text += c;
        } else {
            end_cell();
            while (separator == ' ' && i + 1 < rest.size() && is_blank(rest[i + 1])) ++i;
        }
    }
    end_cell();
    return cells;
}

std::optional<char> separator_of_row(std::string_view line) {
    std::optional<char> with_text;
    for (const char separator : csv_separators) {
        const std::vector<CsvCell> cells = csv_cells(line, separator);
        if (cells.size() < 2 || !cells[0].number) continue;
        const auto rest = cells.begin() + 1;
        const auto is_number = [](const CsvCell& cell) { return cell.number.has_value(); };
        const auto fits = [](const CsvCell& cell) { return cell.number || cell.blank; };
        if (std::all_of(rest, cells.end(), fits)) return separator;
        if (separator != ' ' && !with_text && std::any_of(rest, cells.end(), is_number)) with_text = separator;
    }
    return with_text;
}

std::string with_plain_blanks(const std::string& text) {
    const std::string_view spaces[] = {"\xc2\xa0", "\xe2\x80\xaf", "\xe2\x80\x89", "\xe2\x80\x87"};
    const auto is_digit = [&](std::size_t at) {
        return at < text.size() && std::isdigit(static_cast<unsigned char>(text[at]));
    };
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        std::size_t size = 0;
        for (const std::string_view space : spaces)
            if (text.compare(i, space.size(), space) == 0) size = space.size();
        if (size == 0 || (i > 0 && is_digit(i - 1) && is_digit(i + size)))
            result += text.substr(i, size == 0 ? 1 : size);
        else
            result += ' ';
        i += size == 0 ? 1 : size;
    }
    return result;
}

bool starts_with_number(std::string_view line) {
    return std::any_of(csv_separators.begin(), csv_separators.end(),
                       [&](char separator) { return csv_cells(line, separator)[0].number.has_value(); });
}

bool may_have_thousands(std::string_view number) {
    const std::size_t comma = number.find(',');
    if (comma == 0 || comma > 3 || number.size() != comma + 4 || number[0] == '0') return false;
    return std::all_of(number.begin(), number.end(),
                       [](char c) { return c == ',' || std::isdigit(static_cast<unsigned char>(c)); });
}

}  // namespace stokes
