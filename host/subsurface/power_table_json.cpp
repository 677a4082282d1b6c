#include "host/subsurface/power_table_json.hpp"

#include <fmt/format.h>

#include <utility>

#include "host/core/atomic_file.hpp"
#include "host/core/json_text.hpp"
#include "host/subsurface/table_json.hpp"

namespace stokes {
namespace {

// The kinds of table there are, and their axes from the slowest to the fastest.
struct TableKind {
    std::string model, component, unit;
    std::vector<std::pair<std::string, std::string>> axes;  // name, unit
};

const std::vector<TableKind>& table_kinds() {
    static const std::vector<TableKind> kinds = {
        {"paper", "fluorescence", "mm", {{"r", "mm"}, {"theta", "deg"}, {"lambda", "nm"}}},
        {"paper", "single", "1", {{"r", "mm"}, {"theta", "deg"}, {"lambda", "nm"}}},
        {"paper", "multiple", "1/mm^2", {{"r", "mm"}, {"lambda", "nm"}}},
    };
    return kinds;
}

const TableKind& known_kind(const JsonFields& fields) {
    const std::string model = fields.text("model"), component = fields.text("component");
    std::string models, components;
    for (const TableKind& kind : table_kinds()) {
        if (kind.model == model && kind.component == component) return kind;
        if (models.find('"' + kind.model + '"') == std::string::npos) models += " \"" + kind.model + '"';
        if (kind.model == model) components += " \"" + kind.component + '"';
    }
    if (components.empty()) fields.fail("model", "one of" + models);
    fields.fail("component", "one of" + components);
}

TableMedium read_medium(const Json& json, const std::string& path, std::size_t lambdas) {
    const JsonFields fields(json, path, "medium.");
    return {fields.text("name"), fields.numbers("sigma_s", lambdas), fields.numbers("sigma_a", lambdas),
            fields.number("eta", 0.0), fields.number("dipole_eta", 1.0)};
}

}  // namespace

void write_power_table(const PowerTable& table, const std::string& path) {
    std::string text =
        fmt::format("{{\"format\": \"{}\", \"version\": {},\n\"model\": {}, \"component\": {},\n", power_table_format,
                    power_table_version, json_quoted(table.model), json_quoted(table.component));
    const TableMedium& medium = table.medium;
    text += fmt::format(
        "\"medium\": {{\"name\": {}, \"eta\": {}, \"dipole_eta\": {},\n  \"sigma_s\": {},\n  \"sigma_a\": "
        "{}}},\n",
        json_quoted(medium.name), medium.eta, medium.dipole_eta, number_array(medium.sigma_s),
        number_array(medium.sigma_a));
    text += "\"axes\": [";
    for (const TableAxis& axis : table.axes)
        text += fmt::format("{}{{\"name\": {}, \"unit\": {}, \"values\": {}}}", &axis == &table.axes[0] ? "" : ",\n  ",
                            json_quoted(axis.name), json_quoted(axis.unit), number_array(axis.values));
    text += fmt::format("],\n\"unit\": {},\n\"values\": [", json_quoted(table.unit));

    // One line for each run along the last axis.
    const std::size_t run = table.axes.back().values.size();
    text.reserve(text.size() + 21 * table.values.size());
    for (std::size_t first = 0; first < table.values.size(); first += run) {
        text += first == 0 ? "\n" : ",\n";
        append_numbers(text, table.values.data() + first, run);
    }
    text += "\n]}\n";
    write_file_atomically(path, text);
}

PowerTable read_power_table(const std::string& path) {
    const Json json = parse_json(read_text(path), path);
    const JsonFields fields(json, path, "");
    fields.expect("format", power_table_format);
    fields.expect("version", power_table_version);
    const TableKind& kind = known_kind(fields);

    PowerTable table;
    table.model = kind.model;
    table.component = kind.component;
    table.unit = kind.unit;
    fields.expect("unit", kind.unit);
    const Json& axes = fields.at("axes", "a list");
    if (!axes.is_array() || axes.size() != kind.axes.size())
        fields.fail("axes", fmt::format("a list of {} axes", kind.axes.size()));
    std::size_t count = 1;
    for (std::size_t i = 0; i < kind.axes.size(); ++i) {
        table.axes.push_back(
            read_axis(axes[i], path, fmt::format("axes[{}]", i), kind.axes[i].first, kind.axes[i].second));
        count *= table.axes.back().values.size();
        if (count > most_table_values) fields.fail("axes", fmt::format("at most {} grid points", most_table_values));
    }
    table.medium = read_medium(fields.at("medium", "an object"), path, table.axes.back().values.size());
    table.values = fields.numbers("values", count);
    return table;
}

}  // namespace stokes
