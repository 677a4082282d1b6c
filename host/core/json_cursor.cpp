#include "host/core/json_cursor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "host/core/error.hpp"
#include "host/core/text_input.hpp"

namespace stokes {
namespace {

bool contains(const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& candidates) {
    const std::string closest = closest_name(name, candidates);
    return closest.empty() ? std::string() : fmt::format("; did you mean \"{}\"?", closest);
}

std::string quoted_list(const std::vector<std::string>& words) {
    std::string result;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) result += i + 1 == words.size() ? " or " : ", ";
        result += '"' + words[i] + '"';
    }
    return result;
}

bool is_name(const std::string& text) {
    if (text.empty() || text.size() > 64) return false;
    if (text.front() == ' ' || text.front() == '.' || text.front() == '-') return false;
    return std::all_of(text.begin(), text.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == ' ' || c == '_' || c == '-' || c == '.';
    });
}

constexpr const char* name_rule =
    "a name of 1 to 64 letters, digits, spaces, \"_\", \"-\" and \".\" that begins with a letter, digit or "
    "\"_\"";

}  // namespace

bool NumberRange::contains(double x) const {
    return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
}

std::string NumberRange::text() const {
    return fmt::format("in {}{:g}, {:g}{}", low_open ? '(' : '[', low, high, high_open ? ')' : ']');
}

std::string JsonCursor::at_line(int line, const std::string& what) const {
    const std::string place = file_->empty() ? "" : fmt::format("{}:{}: ", *file_, line);
    return fmt::format("{}{}{}{}", place, path_, path_.empty() ? "" : ": ", what);
}

std::string JsonCursor::at_place(const std::string& what) const { return at_line(value_->line, what); }

void JsonCursor::fail_at(int line, const std::string& what) const { throw InputError(at_line(line, what)); }

void JsonCursor::fail(const std::string& what) const { fail_at(value_->line, what); }

void JsonCursor::fail_expected(const std::string& what) const { fail("expected " + what + ", got " + got()); }

void JsonCursor::fail_undefined(const std::string& part, const std::vector<std::string>& names) const {
    fail(fmt::format("no \"{}\" in {}{}", printable(value_->text), part, did_you_mean(value_->text, names)));
}

std::string JsonCursor::got() const {
    switch (value_->type) {
        case JsonValue::Type::null:
            return "null";
        case JsonValue::Type::boolean:
            return value_->boolean ? "true" : "false";
        case JsonValue::Type::number:
            return fmt::format("{}", value_->number);
        case JsonValue::Type::string:
            return '"' + printable(value_->text) + '"';
        case JsonValue::Type::array:
            return fmt::format("an array of {}", value_->items.size());
        case JsonValue::Type::object:
            break;
    }
    return "an object";
}

void JsonCursor::expect_object() const {
    if (!is(JsonValue::Type::object)) fail_expected("an object");
}

void JsonCursor::expect_keys(const std::vector<std::string>& known, const std::vector<std::string>& needed) const {
    expect_object();
    for (const JsonKey& key : value_->keys) {
        if (contains(known, key.name)) continue;
        fail_at(key.line, fmt::format("unknown key \"{}\"{}", printable(key.name), did_you_mean(key.name, known)));
    }
    for (const std::string& key : needed) {
        if (!has(key)) fail(fmt::format("missing key \"{}\"", key));
    }
}

JsonCursor JsonCursor::member(std::size_t index) const {
    const std::string name = printable(value_->keys[index].name);
    return {value_->items[index], *file_, path_.empty() ? name : path_ + '.' + name};
}

std::optional<JsonCursor> JsonCursor::find(const std::string& key) const {
    for (std::size_t i = 0; i < value_->keys.size(); ++i) {
        if (value_->keys[i].name == key) return member(i);
    }
    return std::nullopt;
}

JsonCursor JsonCursor::at(const std::string& key) const {
    expect_object();
    const auto found = find(key);
    if (!found) fail(fmt::format("missing key \"{}\"", key));
    return *found;
}

std::string JsonCursor::one_of(const std::vector<std::string>& keys) const {
    expect_object();
    std::string found;
    for (const std::string& key : keys) {
        if (!has(key)) continue;
        if (!found.empty()) fail(fmt::format("\"{}\" and \"{}\" given together; expected one of them", found, key));
        found = key;
    }
    if (found.empty()) fail("expected one of the keys " + quoted_list(keys));
    return found;
}

std::vector<std::pair<std::string, JsonCursor>> JsonCursor::named_members() const {
    expect_object();
    std::vector<std::pair<std::string, JsonCursor>> result;
    for (std::size_t i = 0; i < value_->keys.size(); ++i) {
        const JsonKey& key = value_->keys[i];
        if (!is_name(key.name)) {
            fail_at(key.line, fmt::format("expected {}, got \"{}\"", name_rule, printable(key.name)));
        }
        result.emplace_back(key.name, member(i));
    }
    return result;
}

std::vector<std::pair<std::string, JsonCursor>> JsonCursor::members() const {
    expect_object();
    std::vector<std::pair<std::string, JsonCursor>> result;
    for (std::size_t i = 0; i < value_->keys.size(); ++i) result.emplace_back(value_->keys[i].name, member(i));
    return result;
}

std::vector<JsonCursor> JsonCursor::items() const {
    if (!is(JsonValue::Type::array)) fail_expected("an array");
    std::vector<JsonCursor> result;
    for (std::size_t i = 0; i < value_->items.size(); ++i) {
        result.emplace_back(value_->items[i], *file_, fmt::format("{}[{}]", path_, i));
    }
    return result;
}

bool JsonCursor::boolean() const {
    if (!is(JsonValue::Type::boolean)) fail_expected("true or false");
    return value_->boolean;
}

double JsonCursor::number(const NumberRange& range) const {
    if (!is(JsonValue::Type::number) || !range.contains(value_->number)) fail_expected("a number " + range.text());
    return value_->number;
}

std::optional<double> JsonCursor::number_or_auto(const NumberRange& range) const {
    if (is(JsonValue::Type::string) && value_->text == "auto") return std::nullopt;
    if (!is(JsonValue::Type::number) || !range.contains(value_->number))
        fail_expected("a number " + range.text() + " or \"auto\"");
    return value_->number;
}

std::int64_t JsonCursor::integer(std::int64_t low, std::int64_t high) const {
    const double x = value_->number;
    const bool fits = is(JsonValue::Type::number) && x == std::floor(x) && x >= static_cast<double>(low) &&
                      x <= static_cast<double>(high);
    if (!fits) fail_expected(fmt::format("an integer in [{}, {}]", low, high));
    return static_cast<std::int64_t>(x);
}

const std::string& JsonCursor::text() const {
    if (!is(JsonValue::Type::string) || value_->text.empty()) fail_expected("a string");
    return value_->text;
}

const std::string& JsonCursor::name() const {
    if (!is(JsonValue::Type::string) || !is_name(value_->text)) fail_expected(name_rule);
    return value_->text;
}

std::size_t JsonCursor::choice(const std::vector<std::string>& words) const {
    if (is(JsonValue::Type::string)) {
        const auto found = std::find(words.begin(), words.end(), value_->text);
        if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
        fail(fmt::format("expected {}, got {}{}", quoted_list(words), got(), did_you_mean(value_->text, words)));
    }
    fail_expected(quoted_list(words));
}

std::vector<double> JsonCursor::numbers(const NumberRange& range, std::size_t count) const {
    if (!is(JsonValue::Type::array) || (count != 0 && value_->items.size() != count))
        fail_expected(count == 0 ? "an array of numbers" : fmt::format("an array of {} numbers", count));
    std::vector<double> result;
    result.reserve(value_->items.size());
    for (const JsonValue& item : value_->items) {
        if (item.type != JsonValue::Type::number || !range.contains(item.number))
            items()[result.size()].fail_expected("a number " + range.text());
        result.push_back(item.number);
    }
    return result;
}

glm::dvec3 JsonCursor::vector(const NumberRange& range) const {
    const std::vector<double> xyz = numbers(range, 3);
    return {xyz[0], xyz[1], xyz[2]};
}

glm::dvec3 JsonCursor::direction() const {
    const glm::dvec3 v = vector(coordinate_range);
    const double length = glm::length(v);
    if (!(length > 1e-12)) fail("expected a direction, got a vector of length zero");
    return v / length;
}

}  // namespace stokes
