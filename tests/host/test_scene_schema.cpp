#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "host/core/media_limits.hpp"
#include "host/scene/scene.hpp"
#include "host/scene/scene_keys.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/paths.hpp"

using namespace stokes;
using Json = nlohmann::json;
using Names = std::set<std::string>;

namespace {

Json read_schema() {
    std::ifstream file(source_path("scenes/scene.schema.json"));
    return Json::parse(file);
}

// Every "$ref" below a node.
void collect_references(const Json& node, Names& found) {
    for (const auto& [key, value] : node.items()) {
        if (key == "$ref") found.insert(value.get<std::string>());
        if (value.is_structured()) collect_references(value, found);
    }
}

}  // namespace

TEST_CASE("The schema and the reader know the same objects with the same keys") {
    const Json schema = read_schema();
    CHECK(schema.at("$ref") == "#/$defs/scene");
    Names kinds;
    for (const ObjectKeys& keys : all_object_keys()) {
        INFO(keys.kind);
        CHECK(kinds.insert(keys.kind).second);
        REQUIRE(schema.at("$defs").contains(keys.kind));
        const Json& object = schema.at("$defs").at(keys.kind);
        CHECK(object.at("additionalProperties") == false);
        CHECK_FALSE(object.at("description").get<std::string>().empty());

        Names in_schema;
        for (const auto& [key, value] : object.at("properties").items()) in_schema.insert(key);
        Names in_reader(keys.required.begin(), keys.required.end());
        in_reader.insert(keys.optional.begin(), keys.optional.end());
        CHECK(in_reader.size() == keys.required.size() + keys.optional.size());
        CHECK(in_schema == in_reader);
        CHECK(object.at("required").get<Names>() == Names(keys.required.begin(), keys.required.end()));
    }
    for (const auto& [kind, object] : schema.at("$defs").items()) {
        INFO(kind);
        CHECK((object.contains("properties") == (kinds.count(kind) == 1)));
    }
}

TEST_CASE("Every definition of the schema is referred to, and every reference is defined") {
    const Json schema = read_schema();
    Names references;
    collect_references(schema, references);
    Names defined;
    for (const auto& [kind, object] : schema.at("$defs").items()) defined.insert("#/$defs/" + kind);
    CHECK(references == defined);
}

TEST_CASE("Every key of the schema says what it is, or is one of a few words, or refers to what says so") {
    const Json schema = read_schema();
    for (const ObjectKeys& keys : all_object_keys()) {
        for (const auto& [key, value] : schema.at("$defs").at(keys.kind).at("properties").items()) {
            INFO(keys.kind << "." << key);
            CHECK((value.contains("description") || value.contains("const") || value.contains("enum") ||
                   value.contains("$ref")));
        }
    }
}

TEST_CASE("The schema has the reader's limits") {
    const Json schema = read_schema();
    const auto property = [&](const char* kind, const char* key) {
        return schema.at("$defs").at(kind).at("properties").at(key);
    };
    CHECK(property("render", "photons_per_pass").at("maximum") == most_photons_per_pass);
    CHECK(property("medium", "dipole_eta").at("maximum") == largest_dipole_eta);
    for (const auto& [kind, key] :
         {std::pair("reflectance_texture", "black"), std::pair("reflectance_texture", "white"),
          std::pair("fluorophore", "excitation"), std::pair("fluorophore", "emission")})
        CHECK(property(kind, key).at("$ref") == "#/$defs/spectrum_up_to_1");
    CHECK(property("material_diffuse", "reflectance").at("$ref") == "#/$defs/reflectance");
    CHECK(schema.at("$defs").at("reflectance").at("oneOf").at(0).at("$ref") == "#/$defs/spectrum_up_to_1");
    CHECK(property("render", "branches").at("enum") == branches_words);
    CHECK(property("render", "distances").at("enum") == distances_words);
    CHECK(property("render", "emission").at("enum") == emission_words);
    CHECK(property("render", "direct").at("enum") == direct_words);
    CHECK(property("render", "radii").at("enum") == radii_words);
    CHECK(property("render", "exits").at("maximum") == most_exits);
    CHECK(property("scene", "transport").at("enum") == transport_words);
    CHECK(property("scene", "transport").at("default") ==
          transport_words[static_cast<std::size_t>(RenderSettings().transport)]);
    CHECK(property("material_translucent", "fresnel").at("default") == TranslucentMaterial().fresnel);
    CHECK(property("fluorophore", "quantum_yield").at("maximum") == 1);
    for (const char* key : {"left", "top", "width", "height"}) CHECK(property("crop", key).at("maximum") == 1);
    for (const char* key : {"width", "height"}) CHECK(property("crop", key).at("minimum") == 0.001);
    CHECK(schema.at("$defs").at("spectrum_up_to_1").at("allOf").at(1).at("maximum") == 1);
}
