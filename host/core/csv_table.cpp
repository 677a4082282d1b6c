#include "host/core/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/error.hpp"
#include "host/core/text_input.hpp"

namespace stokes {
namespace {

std::string_view trimmed(std::string_view text) {
    const char* blanks = " \t\r";
    const std::size_t begin = text.find_first_not_of(blanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> fields;
    for (std::size_t comma = line.find(','); comma != std::string_view::npos; comma = line.find(',')) {
        fields.push_back(trimmed(line.substr(0, comma)));
        line.remove_prefix(comma + 1);
    }
    fields.push_back(trimmed(line));
    return fields;
}

[[noreturn]] void fail(const CsvTable& table, std::int64_t line, const std::string& what) {
    throw InputError(fmt::format("{}:{}: {}", table.file, line, what));
}

void set_columns(CsvTable& table, std::int64_t line, std::string_view text) {
    for (const std::string_view name : split(text)) {
        if (name.empty()) fail(table, line, "expected column names, got an empty one");
        if (std::find(table.columns.begin(), table.columns.end(), name) != table.columns.end()) {
            fail(table, line, fmt::format("column \"{}\" named twice", printable(name)));
        }
        table.columns.emplace_back(name);
    }
    if (table.columns.size() < 2) fail(table, line, "expected a wavelength column and at least one more");
    table.values.resize(table.columns.size());
}

void add_row(CsvTable& table, std::int64_t line, std::string_view text) {
    const auto fields = split(text);
    if (fields.size() != table.columns.size()) {
        fail(table, line, fmt::format("expected {} fields, got {}", table.columns.size(), fields.size()));
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const auto value = parse_double(fields[i]);
        if (!value || !std::isfinite(*value)) {
            fail(table, line,
                 fmt::format("{}: expected a finite number, got \"{}\"", table.columns[i], printable(fields[i])));
        }
        table.values[i].push_back(*value);
    }
    const auto& wavelengths = table.values[0];
    const double before = table.lines.empty() ? 0.0 : wavelengths[wavelengths.size() - 2];
    if (!(wavelengths.back() > before)) {
        fail(table, line,
             fmt::format("{}: expected positive wavelengths that increase, got {} after {}", table.columns[0],
                         wavelengths.back(), before));
    }
    table.lines.push_back(line);
}

}  // namespace

CsvTable parse_csv(std::string_view text, const std::string& file) {
    CsvTable table;
    table.file = file;
    TextScanner scanner(text);
    while (!scanner.at_end()) {
        const std::int64_t line = scanner.line();
        const std::string_view row = trimmed(scanner.take_line());
        if (row.empty()) continue;
        if (row.front() == '#' && table.columns.empty()) continue;
        if (table.columns.empty()) {
            set_columns(table, line, row);
        } else {
            add_row(table, line, row);
        }
    }
    if (table.lines.empty()) fail(table, scanner.line(), "expected a line of column names and rows of numbers");
    return table;
}

CsvTable read_csv(const std::string& path) { return parse_csv(read_file(path), path); }

Spectrum csv_spectrum(const CsvTable& table, const std::string& column, Outside outside) {
    const auto found = std::find(table.columns.begin() + 1, table.columns.end(), column);
    if (found == table.columns.end()) {
        std::string names = table.columns[1];
        for (std::size_t i = 2; i < table.columns.size(); ++i) names += ", " + table.columns[i];
        throw InputError(
            fmt::format("{}: no column \"{}\"; expected one of: {}", table.file, printable(column), names));
    }
    const auto& values = table.values[static_cast<std::size_t>(found - table.columns.begin())];
    for (std::size_t row = 0; row < values.size(); ++row) {
        if (values[row] < 0.0) {
            fail(table, table.lines[row], fmt::format("{}: expected no negative value, got {}", column, values[row]));
        }
    }
    return {table.values[0], values, outside};
}

}  // namespace stokes
