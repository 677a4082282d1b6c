#include "host/scene/settings/schema.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "host/scene/settings/objects.hpp"
#include "host/scene/settings/settings.hpp"

namespace stokes {
namespace {

using Json = nlohmann::ordered_json;

// The values that their readers check.
constexpr const char* special_values = R"({
    "spectrum": {
        "description": "A value over wavelength: a name in spectra, a constant, or an object. No value is negative.",
        "oneOf": [{"$ref": "#/$defs/name"}, {"type": "number", "minimum": 0, "maximum": 1000000000000},
                  {"$ref": "#/$defs/spectrum_object"}]
    },
    "spectrum_up_to_1": {
        "description": "A spectrum without a value above 1.",
        "allOf": [{"$ref": "#/$defs/spectrum"},
                  {"maximum": 1, "properties": {"constant": {"maximum": 1},
                                                "pairs": {"items": {"prefixItems": [{}, {"maximum": 1}]}}}}]
    },
    "spectrum_pair": {
        "type": "array", "minItems": 2, "maxItems": 2,
        "prefixItems": [{"type": "number", "exclusiveMinimum": 0, "maximum": 100000},
                        {"type": "number", "minimum": 0, "maximum": 1000000000000}]
    },
    "reflectance": {"oneOf": [{"$ref": "#/$defs/spectrum_up_to_1"}, {"$ref": "#/$defs/reflectance_texture"}]},
    "factor": {"type": "number", "minimum": -1000000000, "maximum": 1000000000, "not": {"const": 0}},
    "scale": {
        "oneOf": [{"$ref": "#/$defs/factor"},
                  {"type": "array", "items": {"$ref": "#/$defs/factor"}, "minItems": 3, "maxItems": 3}]
    },
    "materials_of_mesh": {"type": "object", "additionalProperties": {"$ref": "#/$defs/name"}},
    "name": {"type": "string", "pattern": "^[A-Za-z0-9_][A-Za-z0-9_ .-]{0,63}$"}
})";

Json key_schema(const Key& key) {
    Json schema = {{"description", key.sentence()}};
    schema.update(schema_of(key.domain));
    std::visit(
        [&](const auto& fallback) {
            if constexpr (!std::is_same_v<std::decay_t<decltype(fallback)>, Presence>) schema["default"] = fallback;
        },
        key.fallback);
    return schema;
}

Json object_schema(const ObjectDeclaration& object) {
    Json schema = {{"description", object.help}};
    for (const std::string& kind : object.alternatives) schema["oneOf"].push_back({{"$ref", "#/$defs/" + kind}});
    if (!object.alternatives.empty()) return schema;
    schema["type"] = "object";
    Json needed = Json::array();
    for (const Key& key : object.keys) {
        schema["properties"][key.name] = key_schema(key);
        if (key.fallback == decltype(key.fallback)(required)) needed.push_back(key.name);
    }
    schema["required"] = needed;
    schema["additionalProperties"] = false;
    for (const std::string& key : object.exactly_one) schema["oneOf"].push_back({{"required", Json::array({key})}});
    if (!object.rules.empty()) schema.update(Json::parse(object.rules));
    return schema;
}

}  // namespace

Json scene_schema() {
    Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                   {"title", "stokes scene"},
                   {"description",
                    "Scene files of stokes, as the program's subcommand `schema` prints it. Lengths are millimetres, "
                    "wavelengths nanometres, angles degrees; units stand in the key names."},
                   {"$ref", "#/$defs/scene"}};
    for (const ObjectDeclaration& object : scene_objects()) schema["$defs"][object.kind] = object_schema(object);
    schema["$defs"].update(Json::parse(special_values));
    return schema;
}

std::string as_lines(const Json& json, const std::string& indent) {
    constexpr std::size_t width = 118;
    if (const std::string line = json.dump(); !json.is_structured() || indent.size() + line.size() < width) return line;
    std::string text;
    for (const auto& [key, value] : json.items())
        text += (text.empty() ? "" : ",\n") + indent + " " + (json.is_object() ? Json(key).dump() + ": " : "") +
                as_lines(value, indent + " ");
    return (json.is_object() ? "{\n" : "[\n") + text + "\n" + indent + (json.is_object() ? "}" : "]");
}

std::string settings_table() {
    std::string table = "| key | flag | values | |\n|---|---|---|---|\n";
    for (const Setting& setting : settings()) {
        std::string values = text_of(setting.domain);
        for (std::size_t at = values.find('|'); at != std::string::npos; at = values.find('|', at + 2))
            values.insert(at, "\\");
        table += fmt::format("| `{}{}{}` | `{}` | {} | {} |\n", setting.object, setting.object.empty() ? "" : ".",
                             setting.key, setting.flag(), values, setting.sentence());
    }
    return table;
}

Json settings_as_json() {
    Json all = Json::object();
    for (const Setting& setting : settings()) {
        Json transports = Json::array();
        for (const Transport transport : setting.traits.transports) transports.push_back(word_of(transport));
        Json row = {{"object", setting.object},
                    {"flags", setting.flags},
                    {"transports", transports},
                    {"sampler", setting.traits.sampler},
                    {"default", setting.constant_default()},
                    {"description", setting.sentence()}};
        row.update(schema_of(setting.domain));
        all[setting.key] = row;
    }
    return all;
}

}  // namespace stokes
