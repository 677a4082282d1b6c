#include "host/core/wavelength_unit.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "host/core/spectrum.hpp"

namespace stokes {

namespace {

// lambda [nm] times energy [eV], wavenumber [1/cm] and frequency [THz]: the exact constants h, c and e of the SI.
constexpr double nm_times_ev = 1239.841984332, nm_times_per_cm = 1e7, nm_times_thz = 299792.458;

struct Conversion {
    double factor;  // of x, or of 1/x
    bool reciprocal;
};

Conversion conversion_of(WavelengthUnit unit) {
    switch (unit) {
        case WavelengthUnit::nm:
            return {1.0, false};
        case WavelengthUnit::um:
            return {1e3, false};
        case WavelengthUnit::angstrom:
            return {0.1, false};
        case WavelengthUnit::m:
            return {1e9, false};
        case WavelengthUnit::ev:
            return {nm_times_ev, true};
        case WavelengthUnit::per_cm:
            return {nm_times_per_cm, true};
        case WavelengthUnit::thz:
            return {nm_times_thz, true};
    }
    return {1.0, false};
}

// Lower case; micro signs and rings as letters, "cm^-1", "cm⁻¹" and "1/cm" as "cm-1".
std::string plain(std::string_view name) {
    std::string text;
    for (const char c : name) text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const std::pair<const char*, const char*> spellings[] = {{"\xc2\xb5", "u"},
                                                             {"\xce\xbc", "u"},
                                                             {"\xc3\x85", "angstrom"},
                                                             {"\xc3\xa5", "angstrom"},
                                                             {"\xe2\x84\xab", "angstrom"},
                                                             {"cm^-1", "percm"},
                                                             {"cm^{-1}", "percm"},
                                                             {"cm\xe2\x81\xbb\xc2\xb9", "percm"},
                                                             {"cm**-1", "percm"},
                                                             {"cm-1", "percm"},
                                                             {"1/cm", "percm"},
                                                             {"/cm)", "percm)"},
                                                             {"/cm]", "percm]"},
                                                             {"\xce\xbb", "lambda"},
                                                             {"(a)", " angstrom "},
                                                             {"[a]", " angstrom "}};
    for (const auto& [from, to] : spellings)
        for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at))
            text.replace(at, std::string_view(from).size(), to);
    return text;
}

}  // namespace

double wavelength_nm(WavelengthUnit unit, double x) {
    const Conversion conversion = conversion_of(unit);
    return conversion.reciprocal ? conversion.factor / x : conversion.factor * x;
}

double units_per_nm(WavelengthUnit unit, double lambda_nm) {
    const Conversion conversion = conversion_of(unit);
    return conversion.reciprocal ? conversion.factor / (lambda_nm * lambda_nm) : 1.0 / conversion.factor;
}

bool is_reciprocal(WavelengthUnit unit) { return conversion_of(unit).reciprocal; }

std::vector<std::string> name_words(std::string_view name) {
    std::vector<std::string> words;
    std::string word;
    for (const char c : plain(name) + ' ') {
        if (std::isalpha(static_cast<unsigned char>(c))) {
            word += c;
        } else if (!word.empty()) {
            words.push_back(word);
            word.clear();
        }
    }
    return words;
}

std::optional<WavelengthUnit> unit_in(std::string_view name) {
    using Unit = WavelengthUnit;
    static const std::map<std::string, Unit> words = {{"nm", Unit::nm},
                                                      {"nanometer", Unit::nm},
                                                      {"nanometers", Unit::nm},
                                                      {"nanometre", Unit::nm},
                                                      {"nanometres", Unit::nm},
                                                      {"um", Unit::um},
                                                      {"micron", Unit::um},
                                                      {"microns", Unit::um},
                                                      {"micrometer", Unit::um},
                                                      {"micrometers", Unit::um},
                                                      {"micrometre", Unit::um},
                                                      {"micrometres", Unit::um},
                                                      {"angstrom", Unit::angstrom},
                                                      {"angstroms", Unit::angstrom},
                                                      {"ang", Unit::angstrom},
                                                      {"m", Unit::m},
                                                      {"meters", Unit::m},
                                                      {"metres", Unit::m},
                                                      {"ev", Unit::ev},
                                                      {"percm", Unit::per_cm},
                                                      {"wavenumber", Unit::per_cm},
                                                      {"wavenumbers", Unit::per_cm},
                                                      {"thz", Unit::thz}};
    std::set<Unit> found;
    for (const std::string& word : name_words(name))
        if (const auto unit = words.find(word); unit != words.end()) found.insert(unit->second);
    if (found.size() != 1) return std::nullopt;
    return *found.begin();
}

std::string units_that_fit(WavelengthUnit unit, double low, double high) {
    std::string fitting;
    using Unit = WavelengthUnit;
    for (const Unit other : {Unit::nm, Unit::um, Unit::angstrom, Unit::m, Unit::ev, Unit::per_cm}) {
        const auto [first, last] = std::minmax({wavelength_nm(other, low), wavelength_nm(other, high)});
        if (other == unit || first > last_lambda_nm || last < first_lambda_nm) continue;
        fitting += (fitting.empty() ? "" : " or ") + word_of(other);
    }
    return fitting;
}

}  // namespace stokes
