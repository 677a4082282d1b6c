#include "host/scene/settings/domain.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "host/core/overloaded.hpp"

namespace stokes {
namespace {

using Json = nlohmann::ordered_json;

// Whole numbers without a point.
Json plain_number(double value) {
    if (value == std::floor(value) && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
    return value;
}

Json number_schema(const NumberRange& range) {
    return {{"type", "number"},
            {range.low_open ? "exclusiveMinimum" : "minimum", plain_number(range.low)},
            {range.high_open ? "exclusiveMaximum" : "maximum", plain_number(range.high)}};
}

Json vector_schema(const NumberRange& range) {
    return {{"type", "array"}, {"items", number_schema(range)}, {"minItems", 3}, {"maxItems", 3}};
}

Json reference(const std::string& kind) { return {{"$ref", "#/$defs/" + kind}}; }

Json word_schema(const Words& words) {
    if (words.size() == 1) return {{"const", words[0]}};
    return {{"enum", words}};
}

}  // namespace

std::string text_of(const Domain& domain) {
    return std::visit(
        Overloaded{
            [](const NumberRange& range) { return "number " + range.text(); },
            [](const IntegerRange& range) { return fmt::format("integer in [{}, {}]", range.low, range.high); },
            [](const OneWord& one) { return fmt::format("{}", fmt::join(one.words, "|")); },
            [](const YesNo&) { return std::string("true or false"); },
            [](const NumberOrAuto& number) { return "number " + number.range.text() + " or auto"; },
            [](const auto&) { return std::string("value"); },
        },
        domain);
}

Json schema_of(const Domain& domain) {
    return std::visit(Overloaded{
                          [](const NumberRange& range) { return number_schema(range); },
                          [](const IntegerRange& range) {
                              return Json{{"type", "integer"}, {"minimum", range.low}, {"maximum", range.high}};
                          },
                          [](const OneWord& one) { return word_schema(one.words); },
                          [](const YesNo&) {
                              return Json{{"type", "boolean"}};
                          },
                          [](const NumberOrAuto& number) {
                              return Json{{"oneOf", {number_schema(number.range), word_schema({"auto"})}}};
                          },
                          [](const Text&) {
                              return Json{{"type", "string"}, {"minLength", 1}};
                          },
                          [](const OwnName&) { return reference("name"); },
                          [](const NameIn&) { return reference("name"); },
                          [](const Vector& vector) { return vector_schema(vector.range); },
                          [](const Direction&) { return vector_schema(coordinate_range); },
                          [](const Declared& declared) { return reference(declared.kind); },
                          [](const SpectrumUpTo& spectrum) {
                              return reference(spectrum.maximum == 1.0 ? "spectrum_up_to_1" : "spectrum");
                          },
                          [](const ListOf& list) {
                              Json schema{{"type", "array"}, {"items", reference(list.kind)}};
                              if (list.least > 0) schema["minItems"] = list.least;
                              return schema;
                          },
                          [](const ByName& named) {
                              return Json{{"type", "object"},
                                          {"propertyNames", reference("name")},
                                          {"additionalProperties", reference(named.kind)}};
                          },
                      },
                      domain);
}

void check_value(const Domain& domain, const JsonCursor& where) {
    std::visit(Overloaded{
                   [&](const NumberRange& range) { where.number(range); },
                   [&](const IntegerRange& range) { where.integer(range); },
                   [&](const OneWord& one) { where.choice(one.words); },
                   [&](const YesNo&) { where.boolean(); },
                   [&](const NumberOrAuto& number) { where.number_or_auto(number.range); },
                   [&](const Text&) { where.text(); },
                   [&](const OwnName&) { where.name(); },
                   [&](const NameIn&) { where.text(); },
                   [&](const Vector& vector) { where.vector(vector.range); },
                   [&](const Direction&) { where.direction(); },
                   [](const auto&) {},
               },
               domain);
}

}  // namespace stokes
