#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/subsurface/green_table.hpp"
#include "host/subsurface/gzip.hpp"
#include "host/subsurface/table_json.hpp"

namespace stokes {
namespace {

constexpr std::size_t kMostText = std::size_t{1} << 28;
constexpr const char* kUnit = "1/mfp";

// What rounding to four digits may do to a row's integral, and what is nothing at all.
constexpr double kRounding = 1e-3, kNothing = 1e-6;

void append_rounded(std::string& text, const std::vector<float>& values, int digits) {
    for (std::size_t i = 0; i < values.size(); ++i)
        fmt::format_to(std::back_inserter(text), i == 0 ? "{:.{}g}" : ",{:.{}g}", values[i], digits);
}

std::string axis_text(const std::string& name, const std::string& unit, const std::vector<double>& values) {
    return fmt::format("{{\"name\": \"{}\", \"unit\": \"{}\", \"values\": {}}}", name, unit, number_array(values));
}

std::string table_text(const GreenTable& table) {
    std::string text = fmt::format(
        "{{\"format\": \"{}\", \"version\": {},\n\"model\": \"conserving\", \"component\": \"scattered\",\n"
        "\"eta\": {},\n\"axes\": [{},\n  {},\n  {}],\n\"u0\": [",
        power_table_format, power_table_version, table.eta, axis_text("rho", "mfp", table.rho),
        axis_text("z", "mfp", table.z), axis_text("albedo", "1", table.albedo));
    append_rounded(text, table.u0, 8);
    text += "],\n\"u1\": [";
    append_rounded(text, table.u1, 8);
    text += fmt::format("],\n\"unit\": \"{}\",\n\"values\": [", kUnit);
    // The file's last axis, albedo, is the fastest; one line a depth.
    std::vector<float> line(table.albedo.size());
    for (std::size_t r = 0; r < table.rho.size(); ++r)
        for (std::size_t z = 0; z < table.z.size(); ++z) {
            for (std::size_t a = 0; a < line.size(); ++a) line[a] = table.h1[table.row(a, z) + r];
            text += r + z == 0 ? "\n" : ",\n";
            append_rounded(text, line, 4);
        }
    return text + "\n]}\n";
}

// The values of axis i, which must be logarithmic but for a node at 0, or albedos.
std::vector<double> checked_axis(const Json& axes, std::size_t i, const std::string& name, const std::string& file) {
    const std::string key = fmt::format("axes[{}]", i), unit = name == "albedo" ? "1" : "mfp";
    const std::vector<double> values = read_axis(axes[i], file, key, name, unit).values;
    const JsonFields fields(axes[i], file, key + ".");
    if (values.size() < 4) fields.fail("values", "at least 4 values");
    if (values.front() != 0.0) fields.fail("values[0]", "0");
    if (name == "albedo") {
        if (values.back() != 1.0) fields.fail(fmt::format("values[{}]", values.size() - 1), "1");
        return values;
    }
    const double octaves = octaves_per_node(values);
    for (std::size_t n = 1; n < values.size(); ++n)
        if (std::abs(std::log2(values[n] / values[1]) - octaves * static_cast<double>(n - 1)) > 1e-3 * octaves)
            fields.fail(fmt::format("values[{}]", n), "logarithmic steps");
    return values;
}

std::vector<float> as_floats(const std::vector<double>& values) { return {values.begin(), values.end()}; }

void check_probabilities(const JsonFields& fields, const GreenTable& table) {
    const std::size_t depths = table.z.size();
    for (std::size_t i = 0; i < table.u1.size(); ++i)
        if (double(table.u0[i % depths]) + double(table.u1[i]) > 1.0 + kNothing)
            fields.fail(fmt::format("u1[{}]", i), "at most 1 together with u0");
    for (std::size_t a = 0; a < table.albedo.size(); ++a)
        for (std::size_t z = 0; z < depths; ++z) {
            const double u1 = table.u1[a * depths + z];
            if (std::abs(green_row_integral(table, a, z) - u1) > kRounding * u1 + kNothing)
                fields.fail("values", fmt::format("an integral over rho of {:.4g} for z = {:.4g}, albedo = {:.4g}", u1,
                                                  table.z[z], table.albedo[a]));
        }
}

}  // namespace

void write_green_table(const GreenTable& table, const std::string& path) {
    write_file_atomically(path, compress_gzip(table_text(table)));
}

GreenTable parse_green_table(std::string_view content, const std::string& name) {
    const Json json = parse_json(decompress_gzip(content, name, kMostText), name);
    const JsonFields fields(json, name, "");
    fields.expect("format", power_table_format);
    fields.expect("version", power_table_version);
    fields.expect("model", "conserving");
    fields.expect("component", "scattered");
    fields.expect("unit", kUnit);

    GreenTable table;
    table.eta = fields.number("eta", 1.0);
    const Json& axes = fields.at("axes", "a list");
    if (!axes.is_array() || axes.size() != 3) fields.fail("axes", "a list of 3 axes");
    table.rho = checked_axis(axes, 0, "rho", name);
    table.z = checked_axis(axes, 1, "z", name);
    table.albedo = checked_axis(axes, 2, "albedo", name);
    const std::size_t rows = table.z.size() * table.albedo.size();
    if (rows * table.rho.size() > most_table_values)
        fields.fail("axes", fmt::format("at most {} grid points", most_table_values));
    table.u0 = as_floats(fields.numbers("u0", table.z.size()));
    table.u1 = as_floats(fields.numbers("u1", rows));
    const std::vector<double> values = fields.numbers("values", rows * table.rho.size());
    table.h1.resize(values.size());
    auto value = values.begin();
    for (std::size_t r = 0; r < table.rho.size(); ++r)
        for (std::size_t z = 0; z < table.z.size(); ++z)
            for (std::size_t a = 0; a < table.albedo.size(); ++a)
                table.h1[table.row(a, z) + r] = static_cast<float>(*value++);
    check_probabilities(fields, table);
    normalise_green_rows(table);
    return table;
}

GreenTable read_green_table(const std::string& path) { return parse_green_table(read_text(path), path); }

}  // namespace stokes
