#include "host/core/csv_headings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <set>
#include <vector>

#include "host/core/error.hpp"
#include "host/core/text_input.hpp"

namespace stokes {

namespace {

using Text = std::vector<std::string>;

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

bool starts_as_one_of(const std::string& word, std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(), [&](const char* start) { return word.rfind(start, 0) == 0; });
}

bool is_wavelength(const std::string& word) {
    return word == "wl" || starts_as_one_of(word, {"wavelen", "lambda", "wellenl"});
}

bool is_reciprocal_quantity(const std::string& word) {
    return starts_as_one_of(word, {"freq", "energ", "wavenum", "wellenzahl"});
}

// Those that are not known.
bool is_other_unit(const std::string& word) {
    return is_one_of(word, {"hz", "khz", "mhz", "ghz", "phz", "kj", "kcal", "mol", "mev", "kev", "hartree", "rydberg"});
}

// No wavelength, or in a unit that is not known.
bool is_other_quantity(const std::string& word) {
    return is_reciprocal_quantity(word) || (is_other_unit(word) && word != "mol") ||
           is_one_of(word, {"pixel", "pixels", "index", "channel", "channels", "time", "seconds", "temperature",
                            "angle", "joule", "joules", "fs"});
}

bool any_of(const Text& words, bool (*is)(const std::string&)) { return std::any_of(words.begin(), words.end(), is); }

bool says_wavelengths(const std::string& text) { return any_of(name_words(text), is_wavelength); }

bool says_other_quantity(const std::string& text) {
    const Text words = name_words(text);
    return !any_of(words, is_wavelength) && any_of(words, is_other_quantity) && !unit_in(text);
}

// "Frequency (THz)" and "wavelength in um", but no other lengths that text speaks of.
std::optional<WavelengthUnit> unit_beside_quantity(const std::string& note) {
    const Text words = name_words(note);
    for (std::size_t i = 0; i + 1 < words.size(); ++i) {
        if (!is_wavelength(words[i]) && !is_reciprocal_quantity(words[i])) continue;
        const std::size_t next = i + (words[i + 1] == "in" && i + 2 < words.size() ? 2 : 1);
        const auto unit = unit_in(words[next]);
        if (unit && *unit != WavelengthUnit::m) return unit;
    }
    return std::nullopt;
}

// "THz" and "Frequency (THz) R", but not "Integration time (ms)", "Slit (um)" or "Energy: 3 J".
bool speaks_of_wavelengths(const std::string& text) {
    const Text words = name_words(text);
    if (words.empty() || text.find(':') != std::string::npos) return false;
    if (is_wavelength(words[0]) || is_reciprocal_quantity(words[0])) return true;
    return std::all_of(words.begin(), words.end(),
                       [](const std::string& word) { return unit_in(word) || is_other_unit(word); });
}

class AxisFinder {
  public:
    AxisFinder(const CsvTable& table, std::size_t column) : table_(table), column_(column) {}

    CsvAxis find(bool unit_said) const {
        const std::size_t axis = nearest();
        refuse_other_curves(axis);
        CsvAxis found{axis, {}};
        std::string other;
        found.unit = unit_of(axis, other);
        if (!found.unit && !unit_said && !other.empty())
            fail(fmt::format(
                "column {} is named \"{}\": expected wavelengths, or energies in eV, wavenumbers in cm-1 or "
                "frequencies in THz; if it has them, say \"unit\" (--wavelength-unit)",
                axis + 1, printable(other)));
        return found;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: {}", table_.file, what));
    }

    [[noreturn]] void fail_unclear(std::size_t other) const {
        fail(fmt::format(
            "it is unclear which column has the wavelengths of column {}: column {} may have them as well as "
            "the first; name each column of wavelengths \"wavelength\", or leave one curve",
            column_ + 1, other + 1));
    }

    // A line of units may stand below other lengths than wavelengths.
    bool is_axis(std::size_t column) const {
        if (column == 0) return table_.wavelengths_first;
        if (names_wavelengths(table_.columns[column])) return true;
        const Text& above = table_.headings[column];
        return std::any_of(above.begin(), above.end(),
                           [](const std::string& text) { return says_wavelengths(text) && names_wavelengths(text); });
    }

    std::size_t nearest() const {
        if (column_ > 0 && is_axis(column_))
            fail(fmt::format("column {}, \"{}\", has wavelengths; expected one of values", column_ + 1,
                             printable(table_.columns[column_])));
        std::size_t last = column_;
        while (last > 0 && !is_axis(last - 1)) --last;
        if (last == 0) return only_one();
        std::size_t first = last - 1;
        while (first > 0 && is_axis(first - 1)) --first;
        for (std::size_t i = first + 1; i < last; ++i) {
            std::string unused;
            if (unit_of(i, unused) == unit_of(first, unused) && differ(i, first)) fail_unclear(i);
        }
        return first;
    }

    std::size_t only_one() const {
        std::optional<std::size_t> found;
        for (std::size_t i = column_ + 1; i < table_.columns.size(); ++i) {
            if (!is_axis(i)) continue;
            if (found) fail_unclear(i);
            found = i;
        }
        return found.value_or(0);
    }

    bool differ(std::size_t a, std::size_t b) const {
        return !std::equal(table_.values[a].begin(), table_.values[a].end(), table_.values[b].begin(),
                           [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
    }

    // Several curves, each with wavelengths of its own that nothing names.
    void refuse_other_curves(std::size_t axis) const {
        for (std::size_t i = axis + 1; i <= column_; ++i) {
            const bool alike = is_named_alike(axis, i) || (i < column_ && has_equal_steps_beside(axis, i));
            if (alike && !is_axis(i) && differ(axis, i)) fail_unclear(i);
        }
    }

    // X and X, X1 and X2, X and X.1.
    bool is_named_alike(std::size_t a, std::size_t b) const {
        const auto stem = [&](std::size_t column) {
            std::string name = table_.columns[column];
            while (!name.empty() && !std::isalpha(static_cast<unsigned char>(name.back()))) name.pop_back();
            for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
            return name;
        };
        return !stem(a).empty() && stem(a) == stem(b);
    }

    // Values that go in equal steps over about the same range as the wavelengths, as no measured values do.
    bool has_equal_steps_beside(std::size_t axis, std::size_t other) const {
        std::vector<double> x = table_.values[other], wavelengths = table_.values[axis];
        for (std::vector<double>* v : {&x, &wavelengths})
            v->erase(std::remove_if(v->begin(), v->end(), [](double a) { return std::isnan(a); }), v->end());
        if (x.size() < 4 || wavelengths.empty()) return false;
        const double step = x[1] - x[0];
        for (std::size_t i = 1; i < x.size(); ++i)
            if (std::abs(x[i] - x[i - 1] - step) > 1e-3 * std::abs(step) || step == 0.0) return false;
        const auto [low, high] = std::minmax_element(wavelengths.begin(), wavelengths.end());
        return std::min(x.front(), x.back()) >= 0.5 * *low && std::max(x.front(), x.back()) <= 2.0 * *high;
    }

    // other: what the column is named where that is no wavelength.
    std::optional<WavelengthUnit> unit_of(std::size_t column, std::string& other) const {
        Text above = table_.headings[column];
        if (!table_.named && column == 0 && !table_.notes.empty()) above.insert(above.begin(), table_.notes.front());
        bool wavelengths = false;
        for (const std::string& text : above) {
            const bool is_name = table_.named && text == table_.columns[column];
            const auto unit = is_name || speaks_of_wavelengths(text) ? unit_in(text) : std::nullopt;
            if (unit && !(wavelengths && is_reciprocal(*unit))) return unit;
            wavelengths = wavelengths || says_wavelengths(text);
            const bool of_column = is_name ? !is_setting(text) : speaks_of_wavelengths(text);
            if (of_column && !wavelengths && other.empty() && says_other_quantity(text)) other = text;
        }
        std::set<WavelengthUnit> noted;
        for (const std::string& note : table_.notes)
            if (const auto unit = unit_beside_quantity(note); unit && !(wavelengths && is_reciprocal(*unit)))
                noted.insert(*unit);
        if (noted.size() == 1) return *noted.begin();
        return std::nullopt;
    }

    // "Temperature: 25", of the measurement.
    bool is_setting(const std::string& name) const {
        const auto is_amount = [](const std::string& text) {
            return !text.empty() && std::isdigit(static_cast<unsigned char>(text[0]));
        };
        return name.find(':') != std::string::npos ||
               std::any_of(table_.columns.begin() + 1, table_.columns.end(), is_amount);
    }

    const CsvTable& table_;
    std::size_t column_;
};

// "Humidity: 40 %" is no column's.
bool says_percent(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const char* sign : {"%", "percent", "pct", "prozent"}) {
        for (std::size_t at = text.find(sign); at != std::string::npos; at = text.find(sign, at + 1)) {
            const std::size_t before = at == 0 ? std::string::npos : text.find_last_not_of(' ', at - 1);
            if (before == std::string::npos || !std::isdigit(static_cast<unsigned char>(text[before]))) return true;
        }
    }
    return false;
}

// Text that speaks of mm as well may be of a conversion; "4 cm-1" is a resolution.
bool says_per_cm(const std::string& text) {
    if (text.rfind("1/", 0) != 0 && !text.empty() && std::isdigit(static_cast<unsigned char>(text[0]))) return false;
    const Text words = name_words(text);
    for (std::size_t i = 0; i < words.size(); ++i)
        if (words[i] == "percm" || (words[i] == "cm" && i > 0 && words[i - 1] == "per"))
            return std::find(words.begin(), words.end(), "mm") == words.end();
    return false;
}

std::string while_file_says(const std::string& column, const std::string& said) {
    return column == said ? "" : fmt::format(", while the file says \"{}\"", printable(said));
}

}  // namespace

bool names_wavelengths(std::string_view name) {
    const Text words = name_words(name);
    const auto unit = unit_in(name);
    bool wavelengths = words.size() == 1 && unit && !is_reciprocal(*unit) && *unit != WavelengthUnit::m;
    for (const std::string& word : words) {
        if (is_wavelength(word) || (unit && is_reciprocal_quantity(word)))
            wavelengths = true;
        else if (!unit_in(word) && !is_one_of(word, {"ex", "em", "exc", "excitation", "emission", "in", "of", "the",
                                                     "vacuum", "air", "photon"}))
            return false;
    }
    return wavelengths;
}

CsvAxis axis_of(const CsvTable& table, std::size_t column, bool unit_said) {
    return AxisFinder(table, column).find(unit_said);
}

std::string percent_above(const CsvTable& table, std::size_t column) {
    for (const std::string& text : table.headings[column])
        if (says_percent(text)) return text;
    for (const std::string& note : table.notes)
        if (says_percent(note)) return note;
    return "";
}

std::string per_cm_above(const CsvTable& table, std::size_t column) {
    for (const std::string& text : table.headings[column])
        if (says_per_cm(text)) return text;
    const Text& above = table.headings[0];
    if (std::any_of(above.begin(), above.end(), says_per_cm)) return "";
    for (const std::string& note : table.notes)
        if (says_per_cm(note) && !any_of(name_words(note), is_reciprocal_quantity)) return note;
    return "";
}

std::string doubt_of_percent(const std::string& column, const std::string& said) {
    return fmt::format("column \"{}\" is read as a share of 1{}; percentages have \"scale\": 0.01", printable(column),
                       while_file_says(column, said));
}

std::string doubt_of_per_cm(const std::string& column, const std::string& said) {
    return fmt::format("column \"{}\" is read as 1/mm{}; values per cm have \"scale\": 0.1", printable(column),
                       while_file_says(column, said));
}

}  // namespace stokes
