#include "host/subsurface/power_table_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"

namespace stokes {
namespace {

using Json = nlohmann::json;

constexpr const char* kFormat = "photon-power-table";
constexpr int kVersion = 1;
constexpr std::size_t kMostValues = std::size_t{1} << 28;

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

void append_numbers(std::string& text, const double* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
        fmt::format_to(std::back_inserter(text), i == 0 ? "{}" : ",{}", values[i]);
}

std::string number_array(const std::vector<double>& values) {
    std::string text = "[";
    append_numbers(text, values.data(), values.size());
    return text + "]";
}

std::string quoted(const std::string& text) {
    return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

// A JSON object of an open file, with the words for complaints about it.
class Reader {
  public:
    Reader(const Json& object, const std::string& path, const std::string& prefix)
        : object_(object), path_(path), prefix_(prefix) {
        if (!object.is_object()) throw InputError(fmt::format("{}: {}expected an object", path_, place()));
    }

    [[noreturn]] void fail(const std::string& key, const std::string& expected) const {
        throw InputError(fmt::format("{}: {}{}: expected {}", path_, prefix_, key, expected));
    }
    const Json& at(const std::string& key, const std::string& expected) const {
        const auto found = object_.find(key);
        if (found == object_.end()) fail(key, expected + ", found nothing");
        return *found;
    }
    std::string text(const std::string& key) const {
        const Json& value = at(key, "a text");
        if (!value.is_string()) fail(key, "a text");
        return value.get<std::string>();
    }
    // "expected" is compared as it stands in the file.
    void expect(const std::string& key, const Json& expected) const {
        const Json& value = at(key, expected.dump());
        if (value != expected) fail(key, expected.dump());
    }
    double number(const std::string& key, double low) const {
        const std::string expected = fmt::format("a number of at least {}", low);
        const Json& value = at(key, expected);
        if (!value.is_number() || !(value.get<double>() >= low)) fail(key, expected);
        return value.get<double>();
    }
    // count numbers, none negative; any count where it is 0.
    std::vector<double> numbers(const std::string& key, std::size_t count) const {
        const std::string expected =
            count == 0 ? "a list of numbers" : fmt::format("a list of {} numbers", count);
        const Json& list = at(key, expected);
        if (!list.is_array() || list.empty()) fail(key, expected);
        if (count != 0 && list.size() != count) fail(key, fmt::format("{}, found {}", expected, list.size()));
        std::vector<double> result;
        result.reserve(list.size());
        for (const Json& value : list) {
            if (!value.is_number() || !(value.get<double>() >= 0.0) || !std::isfinite(value.get<double>()))
                fail(fmt::format("{}[{}]", key, result.size()), "a finite number of at least 0");
            result.push_back(value.get<double>());
        }
        return result;
    }

  private:
    std::string place() const { return prefix_.empty() ? "" : prefix_.substr(0, prefix_.size() - 1) + ": "; }

    const Json& object_;
    std::string path_, prefix_;
};

Json parse_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw InputError(fmt::format("{}: cannot open: {}", path, std::strerror(errno)));
    std::ostringstream text;
    text << file.rdbuf();
    if (!file) throw InputError(fmt::format("{}: cannot read", path));
    const std::string content = text.str();
    try {
        return Json::parse(content);
    } catch (const Json::parse_error& error) {
        const std::size_t end = std::min(error.byte, content.size());
        const auto line =
            1 + std::count(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(end), '\n');
        throw InputError(fmt::format("{}:{}: not valid JSON", path, line));
    } catch (const Json::exception&) {
        throw InputError(fmt::format("{}: a number is too large", path));
    }
}

const TableKind& known_kind(const Reader& reader) {
    const std::string model = reader.text("model"), component = reader.text("component");
    std::string models, components;
    for (const TableKind& kind : table_kinds()) {
        if (kind.model == model && kind.component == component) return kind;
        if (models.find('"' + kind.model + '"') == std::string::npos) models += " \"" + kind.model + '"';
        if (kind.model == model) components += " \"" + kind.component + '"';
    }
    if (components.empty()) reader.fail("model", "one of" + models);
    reader.fail("component", "one of" + components);
}

TableAxis read_axis(const Json& json, const std::string& path, const std::string& key,
                    const std::string& name, const std::string& unit) {
    const Reader reader(json, path, key + ".");
    reader.expect("name", name);
    reader.expect("unit", unit);
    TableAxis axis{name, unit, reader.numbers("values", 0)};
    for (std::size_t i = 1; i < axis.values.size(); ++i)
        if (!(axis.values[i] > axis.values[i - 1]))
            reader.fail(fmt::format("values[{}]", i), "strictly increasing values");
    return axis;
}

TableMedium read_medium(const Json& json, const std::string& path, std::size_t lambdas) {
    const Reader reader(json, path, "medium.");
    return {reader.text("name"), reader.numbers("sigma_s", lambdas), reader.numbers("sigma_a", lambdas),
            reader.number("eta", 0.0), reader.number("dipole_eta", 1.0)};
}

}  // namespace

void write_power_table(const PowerTable& table, const std::string& path) {
    std::string text =
        fmt::format("{{\"format\": \"{}\", \"version\": {},\n\"model\": {}, \"component\": {},\n", kFormat,
                    kVersion, quoted(table.model), quoted(table.component));
    const TableMedium& medium = table.medium;
    text += fmt::format(
        "\"medium\": {{\"name\": {}, \"eta\": {}, \"dipole_eta\": {},\n  \"sigma_s\": {},\n  \"sigma_a\": "
        "{}}},\n",
        quoted(medium.name), medium.eta, medium.dipole_eta, number_array(medium.sigma_s),
        number_array(medium.sigma_a));
    text += "\"axes\": [";
    for (const TableAxis& axis : table.axes)
        text += fmt::format("{}{{\"name\": {}, \"unit\": {}, \"values\": {}}}",
                            &axis == &table.axes[0] ? "" : ",\n  ", quoted(axis.name), quoted(axis.unit),
                            number_array(axis.values));
    text += fmt::format("],\n\"unit\": {},\n\"values\": [", quoted(table.unit));

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
    const Json json = parse_file(path);
    const Reader reader(json, path, "");
    reader.expect("format", kFormat);
    reader.expect("version", kVersion);
    const TableKind& kind = known_kind(reader);

    PowerTable table;
    table.model = kind.model;
    table.component = kind.component;
    table.unit = kind.unit;
    reader.expect("unit", kind.unit);
    const Json& axes = reader.at("axes", "a list");
    if (!axes.is_array() || axes.size() != kind.axes.size())
        reader.fail("axes", fmt::format("a list of {} axes", kind.axes.size()));
    std::size_t count = 1;
    for (std::size_t i = 0; i < kind.axes.size(); ++i) {
        table.axes.push_back(
            read_axis(axes[i], path, fmt::format("axes[{}]", i), kind.axes[i].first, kind.axes[i].second));
        count *= table.axes.back().values.size();
        if (count > kMostValues) reader.fail("axes", fmt::format("at most {} grid points", kMostValues));
    }
    table.medium = read_medium(reader.at("medium", "an object"), path, table.axes.back().values.size());
    table.values = reader.numbers("values", count);
    return table;
}

}  // namespace stokes
