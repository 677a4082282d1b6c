#include <fmt/format.h>

#include <cfloat>
#include <cmath>

#include "host/core/atomic_file.hpp"
#include "host/core/json_cursor.hpp"
#include "host/core/json_text.hpp"
#include "host/core/text_input.hpp"
#include "host/subsurface/green_table.hpp"
#include "host/subsurface/gzip.hpp"
#include "host/subsurface/table_json.hpp"

namespace stokes {
namespace {

constexpr std::size_t kMostText = std::size_t{1} << 25;
constexpr const char *kModel = "conserving", *kComponent = "scattered", *kUnit = "1/mfp";
constexpr NumberRange kNotNegative{0.0, FLT_MAX};

// What rounding to four digits may do to a row's integral, and what is nothing at all.
constexpr double kRounding = 1e-3, kNothing = 1e-6;

nlohmann::ordered_json rounded(const std::vector<float>& values, int digits) {
    auto list = nlohmann::ordered_json::array();
    for (const float value : values) list.push_back(*parse_double(fmt::format("{:.{}g}", value, digits)));
    return list;
}

// Calls visit(node of h1) in the order of the file: its last axis, albedo, is the fastest.
template <class Visit>
void for_each_value(const GreenTable& table, Visit&& visit) {
    for (std::size_t r = 0; r < table.rho.size(); ++r)
        for (std::size_t z = 0; z < table.z.size(); ++z)
            for (std::size_t a = 0; a < table.albedo.size(); ++a) visit(table.row(a, z) + r);
}

// The values of an axis, which must be logarithmic but for a node at 0, or albedos.
std::vector<double> checked_axis(const JsonCursor& axis, const std::string& name) {
    axis.at("name").choice({name});
    axis.at("unit").choice({name == "albedo" ? "1" : "mfp"});
    const JsonCursor list = axis.at("values");
    const std::vector<double> values = list.numbers(kNotNegative);
    if (values.size() < 4) list.fail_expected("at least 4 values");
    const auto expect = [&](std::size_t n, bool good, const char* what) {
        if (!good) list.items()[n].fail_expected(what);
    };
    expect(0, values[0] == 0.0, "0");
    for (std::size_t n = 1; n < values.size(); ++n) expect(n, values[n] > values[n - 1], "strictly increasing values");
    if (name == "albedo") {
        expect(values.size() - 1, values.back() == 1.0, "1");
        return values;
    }
    const double octaves = octaves_per_node(values);
    for (std::size_t n = 1; n < values.size(); ++n) {
        const double off = std::log2(values[n] / values[1]) - octaves * static_cast<double>(n - 1);
        expect(n, std::abs(off) <= 1e-3 * octaves, "logarithmic steps");
    }
    return values;
}

std::vector<float> as_floats(const std::vector<double>& values) { return {values.begin(), values.end()}; }

void check_probabilities(const JsonCursor& file, const GreenTable& table) {
    const std::size_t depths = table.z.size();
    for (std::size_t i = 0; i < table.u1.size(); ++i)
        if (double(table.u0[i % depths]) + double(table.u1[i]) > 1.0 + kNothing)
            file.at("u1").items()[i].fail_expected("at most 1 together with u0");
    for (std::size_t a = 0; a < table.albedo.size(); ++a)
        for (std::size_t z = 0; z < depths; ++z) {
            const double u1 = table.u1[a * depths + z], integral = green_row_integral(table, a, z);
            if (std::abs(integral - u1) > kRounding * u1 + kNothing)
                file.at("values").fail(
                    fmt::format("expected an integral over rho of {:.4g} for z = {:.4g}, albedo = {:.4g}, got {:.4g}",
                                u1, table.z[z], table.albedo[a], integral));
        }
}

}  // namespace

void write_green_table(const GreenTable& table, const std::string& path) {
    nlohmann::ordered_json json = table_json(kModel, kComponent);
    json["eta"] = table.eta;
    json["axes"] = axes_json({{"rho", "mfp", table.rho}, {"z", "mfp", table.z}, {"albedo", "1", table.albedo}});
    json["u0"] = rounded(table.u0, 8);
    json["u1"] = rounded(table.u1, 8);
    json["unit"] = kUnit;
    std::vector<float> values;
    for_each_value(table, [&](std::size_t i) { values.push_back(table.h1[i]); });
    json["values"] = rounded(values, 4);
    write_file_atomically(path, compress_gzip(json_text(json, -1)));
}

GreenTable parse_green_table(std::string_view content, const std::string& name) {
    const JsonValue json = parse_json(decompress_gzip(content, name, kMostText), name);
    const JsonCursor file(json, name);
    file.at("format").choice({table_format});
    file.at("version").integer(table_version, table_version);
    file.at("model").choice({kModel});
    file.at("component").choice({kComponent});
    file.at("unit").choice({kUnit});

    GreenTable table;
    table.eta = file.at("eta").number({1.0, FLT_MAX});
    const std::vector<JsonCursor> axes = file.at("axes").items();
    if (axes.size() != 3) file.at("axes").fail_expected("an array of 3 axes");
    table.rho = checked_axis(axes[0], "rho");
    table.z = checked_axis(axes[1], "z");
    table.albedo = checked_axis(axes[2], "albedo");
    const std::size_t rows = table.z.size() * table.albedo.size(), count = rows * table.rho.size();
    table.u0 = as_floats(file.at("u0").numbers(kNotNegative, table.z.size()));
    table.u1 = as_floats(file.at("u1").numbers(kNotNegative, rows));
    const std::vector<double> values = file.at("values").numbers(kNotNegative, count);
    table.h1.resize(count);
    auto value = values.begin();
    for_each_value(table, [&](std::size_t i) { table.h1[i] = static_cast<float>(*value++); });
    check_probabilities(file, table);
    normalise_green_rows(table);
    return table;
}

GreenTable read_green_table(const std::string& path) { return parse_green_table(read_file(path), path); }

}  // namespace stokes
