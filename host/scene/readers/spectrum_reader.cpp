#include "host/scene/readers/spectrum_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/csv_headings.hpp"
#include "host/core/embedded.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
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

// Of a file's samples or of pairs.
SampleRules read_rules(const ObjectReader& where) {
    SampleRules rules;
    if (const auto unit = where.find("unit")) rules.unit = unit->word<WavelengthUnit>();
    if (const auto per = where.find("per")) rules.per = per->word<Per>();
    if (const auto negative = where.find("negative")) rules.negative = negative->word<Negative>();
    return rules;
}

void check_order(const JsonCursor& pair, const std::vector<double>& x) {
    const std::size_t n = x.size();
    if (n < 2) return;
    const bool increase = x[1] > x[0];
    if (x[n - 1] == x[n - 2] || (x[n - 1] > x[n - 2]) != increase)
        pair.fail(fmt::format("expected wavelengths that {}, got {} after {}",
                              n == 2 || increase ? "increase" : "decrease", x[n - 1], x[n - 2]));
}

void check_maximum(const JsonCursor& where, const Spectrum& spectrum, double maximum, bool file) {
    for (std::size_t i = 0; i < spectrum.value.size(); ++i) {
        if (spectrum.value[i] <= maximum) continue;
        const double largest = spectrum.maximum();
        std::string hint;
        if (file && maximum == 1.0)
            hint = largest > 1.5 && largest <= 100.0
                       ? "; percentages have \"scale\": 0.01"
                       : fmt::format("; \"scale\": {:.4g} brings the largest to 1", 0.99999 / largest);
        where.fail(fmt::format("expected values in [0, {:g}], got {} at {} nm{}", maximum, spectrum.value[i],
                               spectrum.lambda_nm[i], hint));
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

SpectrumReader::Definition SpectrumReader::density_at(const ObjectReader& object, const char* key) {
    const JsonCursor where = object.at(key);
    Definition definition = definition_at(where, object.maximum(key));
    if (!definition.density_doubt.empty()) warn(where.at_place(definition.density_doubt));
    return definition;
}

Spectrum SpectrumReader::read_density(const ObjectReader& object, const char* key) {
    return spectrum_of(object.at(key), density_at(object, key), Outside::zero, object.maximum(key));
}

Spectrum SpectrumReader::read_relative(const ObjectReader& object, const char* key) {
    Definition definition = density_at(object, key);
    definition.spectrum = definition.spectrum.with_maximum_1();
    return spectrum_of(object.at(key), std::move(definition), Outside::zero, object.maximum(key));
}

Spectrum SpectrumReader::read(const JsonCursor& where, Outside outside, double maximum) {
    return read(where, definition_at(where, maximum), outside, maximum);
}

Spectrum SpectrumReader::read_per_mm(const ObjectReader& object, const char* key, double factor) {
    const JsonCursor where = object.at(key);
    Definition definition = definition_at(where, object.maximum(key));
    if (!definition.per_cm.empty() && definition.scale == 1.0 && factor == 1.0)
        warn(where.at_place(doubt_of_per_cm(*definition.column, definition.per_cm)));
    return read(where, std::move(definition), Outside::hold, object.maximum(key)).scaled(factor);
}

Spectrum SpectrumReader::read(const JsonCursor& where, Definition definition, Outside outside, double maximum) const {
    if (!definition.range_fault.empty()) where.fail(definition.range_fault);
    if (definition.has_per)
        where.fail("expected no \"per\": these values are no density over wavelength, as lights and emissions are");
    return spectrum_of(where, std::move(definition), outside, maximum);
}

SpectrumReader::Definition SpectrumReader::definition_at(const JsonCursor& where, double maximum) {
    if (where.is(JsonValue::Type::number)) return {Spectrum::constant(where.number({0.0, maximum})), Outside::hold};
    if (where.is(JsonValue::Type::object)) return read_object(where);
    if (!where.is(JsonValue::Type::string))
        where.fail_expected("a spectrum (a number, a name in spectra, or an object)");
    const auto found = named_.find(where.text());
    if (found != named_.end()) {
        used_.insert(where.text());
        return found->second;
    }
    std::vector<std::string> names;
    for (const auto& entry : named_) names.push_back(entry.first);
    where.fail_undefined("spectra", names);
}

Spectrum SpectrumReader::spectrum_of(const JsonCursor& where, Definition definition, Outside outside,
                                     double maximum) const {
    check_maximum(where, definition.spectrum, maximum, definition.column.has_value());
    if (!definition.percent.empty() && definition.scale == 1.0 && maximum == 1.0)
        warn(where.at_place(doubt_of_percent(*definition.column, definition.percent)));
    definition.spectrum.outside = definition.outside.value_or(outside);
    return definition.by_nanometre ? definition.spectrum : definition.spectrum.at_whole_nanometres();
}

SpectrumReader::Definition SpectrumReader::read_object(const JsonCursor& place) {
    const ObjectReader where(place, "spectrum_object");
    if (where.kind() == "spectrum_file") return read_file_column(where);
    if (where.kind() == "spectrum_illuminant") {
        Definition illuminant{read_illuminant(where.at("illuminant").text()), Outside::zero};
        illuminant.by_nanometre = true;
        return illuminant;
    }
    if (where.kind() == "spectrum_constant") return {Spectrum::constant(where.number("constant")), Outside::hold};
    Definition pairs = read_pairs(where.at("pairs"), read_rules(where));
    pairs.outside = read_outside(where);
    return pairs;
}

SpectrumReader::Definition SpectrumReader::read_pairs(const JsonCursor& pairs, const SampleRules& rules) {
    const WavelengthUnit unit = rules.unit.value_or(WavelengthUnit::nm);
    std::vector<double> x;
    Definition result;
    Spectrum& spectrum = result.spectrum;
    for (const JsonCursor& pair : pairs.items()) {
        const auto both = pair.items();
        if (both.size() != 2) pair.fail_expected("[wavelength in nm, value]");
        x.push_back(both[0].number(wavelength_range));
        check_order(both[0], x);
        const double lambda_nm = wavelength_nm(unit, x.back());
        spectrum.lambda_nm.push_back(lambda_nm);
        const double factor = rules.per == Per::unit ? units_per_nm(unit, lambda_nm) : 1.0;
        spectrum.value.push_back(both[1].number(value_range) * factor);
    }
    if (x.empty()) pairs.fail("expected at least one [wavelength in nm, value]");
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    result.range_fault = fault_of_range(unit, *low, *high);
    result.density_doubt = doubt_of_density(rules.unit, rules.per);
    result.has_per = rules.per.has_value();
    if (spectrum.lambda_nm.front() > spectrum.lambda_nm.back()) {
        std::reverse(spectrum.lambda_nm.begin(), spectrum.lambda_nm.end());
        std::reverse(spectrum.value.begin(), spectrum.value.end());
    }
    return result;
}

SpectrumReader::Definition SpectrumReader::read_file_column(const ObjectReader& where) {
    const CsvTable& csv = tables_.read(where.at("file"));
    const JsonCursor column = where.at("column");
    const SampleRules rules = read_rules(where);
    Definition result;
    try {
        ColumnSpectrum read = read_column(csv, column.text(), Outside::zero, rules);
        for (const std::string& remark : read.remarks) warn(column.at_place(remark));
        result.spectrum = std::move(read.spectrum);
        result.density_doubt = std::move(read.density_doubt);
    } catch (const InputError& error) {
        column.fail(error.what());
    }
    result.has_per = rules.per.has_value();
    result.scale = where.number("scale");
    result.spectrum = result.spectrum.scaled(result.scale);
    result.outside = read_outside(where);
    const std::size_t place = csv_column(csv, column.text());
    result.column = csv.columns[place];
    result.percent = percent_above(csv, place);
    result.per_cm = per_cm_above(csv, place);
    check_maximum(where, result.spectrum, value_range.high, false);
    return result;
}

}  // namespace stokes
