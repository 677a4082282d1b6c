#include "host/subsurface/table_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

#include "host/core/error.hpp"

namespace stokes {

JsonFields::JsonFields(const Json& object, const std::string& path, const std::string& prefix)
    : object_(object), path_(path), prefix_(prefix) {
    const std::string place = prefix_.empty() ? "" : prefix_.substr(0, prefix_.size() - 1) + ": ";
    if (!object.is_object()) throw InputError(fmt::format("{}: {}expected an object", path_, place));
}

void JsonFields::fail(const std::string& key, const std::string& expected) const {
    throw InputError(fmt::format("{}: {}{}: expected {}", path_, prefix_, key, expected));
}

const Json& JsonFields::at(const std::string& key, const std::string& expected) const {
    const auto found = object_.find(key);
    if (found == object_.end()) fail(key, expected + ", found nothing");
    return *found;
}

std::string JsonFields::text(const std::string& key) const {
    const Json& value = at(key, "a text");
    if (!value.is_string()) fail(key, "a text");
    return value.get<std::string>();
}

void JsonFields::expect(const std::string& key, const Json& expected) const {
    const Json& value = at(key, expected.dump());
    if (value != expected) fail(key, expected.dump());
}

double JsonFields::number(const std::string& key, double low) const {
    const std::string expected = fmt::format("a number of at least {}", low);
    const Json& value = at(key, expected);
    if (!value.is_number() || !(value.get<double>() >= low)) fail(key, expected);
    return value.get<double>();
}

std::vector<double> JsonFields::numbers(const std::string& key, std::size_t count) const {
    const std::string expected = count == 0 ? "a list of numbers" : fmt::format("a list of {} numbers", count);
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

std::string read_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw InputError(fmt::format("{}: cannot open: {}", path, std::strerror(errno)));
    std::ostringstream text;
    text << file.rdbuf();
    if (!file) throw InputError(fmt::format("{}: cannot read", path));
    return text.str();
}

Json parse_json(const std::string& content, const std::string& path) {
    try {
        return Json::parse(content);
    } catch (const Json::parse_error& error) {
        const std::size_t end = std::min(error.byte, content.size());
        const auto line = 1 + std::count(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(end), '\n');
        throw InputError(fmt::format("{}:{}: not valid JSON", path, line));
    } catch (const Json::exception&) {
        throw InputError(fmt::format("{}: a number is too large", path));
    }
}

TableAxis read_axis(const Json& json, const std::string& path, const std::string& key, const std::string& name,
                    const std::string& unit) {
    const JsonFields fields(json, path, key + ".");
    fields.expect("name", name);
    fields.expect("unit", unit);
    TableAxis axis{name, unit, fields.numbers("values", 0)};
    for (std::size_t i = 1; i < axis.values.size(); ++i)
        if (!(axis.values[i] > axis.values[i - 1]))
            fields.fail(fmt::format("values[{}]", i), "strictly increasing values");
    return axis;
}

void append_numbers(std::string& text, const double* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) fmt::format_to(std::back_inserter(text), i == 0 ? "{}" : ",{}", values[i]);
}

std::string number_array(const std::vector<double>& values) {
    std::string text = "[";
    append_numbers(text, values.data(), values.size());
    return text + "]";
}

}  // namespace stokes
