#include "host/scene/readers/spectrum_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/embedded.hpp"
#include "host/core/error.hpp"
#include "host/core/text_input.hpp"

namespace stokes {
namespace {

constexpr NumberRange value_range{0.0, largest_spectrum_value};
constexpr NumberRange wavelength_range{0.0, 1e5, true};

std::optional<Outside> read_outside(const JsonCursor& where) {
    const auto outside = where.find("outside");
    if (!outside) return std::nullopt;
    return outside->choice({"zero", "hold"}) == 0 ? Outside::zero : Outside::hold;
}

Spectrum read_illuminant(const std::string& name) {
    const std::string file = "tables/cie/illuminants_1nm.csv";
    const auto found = embedded_files().find(file);
    if (found == embedded_files().end()) throw RunError(file + " is not in this program");
    return csv_spectrum(parse_csv(found->second, file), name, Outside::zero);
}

Spectrum read_pairs(const JsonCursor& pairs) {
    Spectrum result;
    for (const JsonCursor& pair : pairs.items()) {
        const auto both = pair.items();
        if (both.size() != 2) pair.fail_expected("[wavelength in nm, value]");
        const double lambda_nm = both[0].number(wavelength_range);
        if (!result.lambda_nm.empty() && lambda_nm <= result.lambda_nm.back()) {
            both[0].fail(
                fmt::format("expected wavelengths that increase, got {} after {}", lambda_nm, result.lambda_nm.back()));
        }
        result.lambda_nm.push_back(lambda_nm);
        result.value.push_back(both[1].number(value_range));
    }
    if (result.value.empty()) pairs.fail("expected at least one [wavelength in nm, value]");
    return result;
}

void check_maximum(const JsonCursor& where, const Spectrum& spectrum, double maximum) {
    for (std::size_t i = 0; i < spectrum.value.size(); ++i) {
        if (spectrum.value[i] <= maximum) continue;
        where.fail(fmt::format("expected values in [0, {:g}], got {} at {} nm", maximum, spectrum.value[i],
                               spectrum.lambda_nm[i]));
    }
}

}  // namespace

void SpectrumReader::define(const JsonCursor& spectra) {
    for (const auto& [name, value] : spectra.named_members()) named_[name] = read_object(value);
}

std::vector<std::string> SpectrumReader::unused() const {
    std::vector<std::string> names;
    for (const auto& entry : named_)
        if (used_.count(entry.first) == 0) names.push_back(entry.first);
    return names;
}

Spectrum SpectrumReader::read(const ObjectReader& object, const char* key, Outside outside) {
    return read(object.at(key), outside, object.maximum(key));
}

Spectrum SpectrumReader::read(const JsonCursor& where, Outside outside, double maximum) {
    if (where.is(JsonValue::Type::number)) {
        return Spectrum::constant(where.number({0.0, maximum}));
    }
    Definition definition;
    if (where.is(JsonValue::Type::string)) {
        const auto found = named_.find(where.text());
        if (found == named_.end()) {
            std::vector<std::string> names;
            for (const auto& entry : named_) names.push_back(entry.first);
            where.fail_undefined("spectra", names);
        }
        used_.insert(where.text());
        definition = found->second;
    } else if (where.is(JsonValue::Type::object)) {
        definition = read_object(where);
    } else {
        where.fail_expected("a spectrum (a number, a name in spectra, or an object)");
    }
    check_maximum(where, definition.spectrum, maximum);
    definition.spectrum.outside = definition.outside.value_or(outside);
    return definition.spectrum;
}

SpectrumReader::Definition SpectrumReader::read_object(const JsonCursor& place) {
    const ObjectReader where(place, "spectrum_object");
    if (where.kind() == "spectrum_file") return read_file_column(where);
    if (where.kind() == "spectrum_illuminant") return {read_illuminant(where.at("illuminant").text()), Outside::zero};
    if (where.kind() == "spectrum_pairs") return {read_pairs(where.at("pairs")), read_outside(where)};
    return {Spectrum::constant(where.number("constant")), Outside::hold};
}

SpectrumReader::Definition SpectrumReader::read_file_column(const ObjectReader& where) {
    const CsvTable& csv = tables_.read(where.at("file"));
    const JsonCursor column = where.at("column");
    const std::string& name = column.text();
    const double scale = where.number("scale");
    Spectrum spectrum;
    try {
        spectrum = csv_spectrum(csv, name, Outside::zero).scaled(scale);
    } catch (const InputError& error) {
        column.fail(error.what());
    }
    check_maximum(where, spectrum, value_range.high);
    return {std::move(spectrum), read_outside(where)};
}

}  // namespace stokes
