#include <nlohmann/json.hpp>
#include <set>

#include "host/scene/readers/scene_reader.hpp"
#include "host/scene/settings/schema.hpp"
#include "host/scene/settings/settings.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;
using Json = nlohmann::ordered_json;

namespace {

// With every run of white space as one space, as line breaks differ.
std::string in_one_line(const std::string& text) {
    std::string result;
    for (const char c : text)
        if (std::isspace(static_cast<unsigned char>(c)) == 0)
            result += c;
        else if (!result.empty() && result.back() != ' ')
            result += ' ';
    return result;
}

// Every "$ref" below a node.
void collect_references(const Json& node, std::set<std::string>& found) {
    for (const auto& [key, value] : node.items()) {
        if (key == "$ref") found.insert(value.get<std::string>());
        if (value.is_structured()) collect_references(value, found);
    }
}

// A value in the setting's domain, as JSON text.
std::string some_value(const Setting& setting) {
    const Json schema = settings_as_json().at(setting.key);
    if (schema.contains("enum")) return schema["enum"][0].dump();
    return schema.contains("maximum") ? schema["maximum"].dump() : "true";
}

std::string scene_text(Transport transport, const std::string& render) {
    return R"({"format": "stokes-scene", "version": 1, "transport": ")" + word_of(transport) + R"(", "render": {)" +
           render + R"(}, "camera": {"position_mm": [0, 5, 0], "target_mm": [0, 0, 0], "up": [0, 0, 1]},
        "materials": {"floor": {"type": "diffuse", "reflectance": 0.5}},
        "lights": [{"type": "sphere", "center_mm": [0, 9, 0], "radius_mm": 1, "spectrum": 1, "power_W": 1}]})";
}

}  // namespace

TEST_CASE("The schema file is what the program prints", "[scene_schema]") {
    const Outcome printed = run_stokes("schema");
    CHECK(printed.code == 0);
    CHECK(file_content(source_path("scenes/scene.schema.json")) == printed.out);
}

TEST_CASE("Every definition of the schema is referred to, and every reference is defined", "[scene_schema]") {
    const Json schema = scene_schema();
    std::set<std::string> references, defined;
    collect_references(schema, references);
    for (const auto& [kind, object] : schema.at("$defs").items()) defined.insert("#/$defs/" + kind);
    CHECK(references == defined);
}

TEST_CASE("Every setting has a key and a flag of its own", "[scene_schema]") {
    std::set<std::string> names;
    for (const Setting& setting : settings()) {
        INFO(setting.key);
        CHECK(names.insert(setting.object + "." + setting.key).second);
        CHECK(setting.flag().rfind("--", 0) == 0);
        CHECK(names.insert(setting.flag()).second);
        CHECK_FALSE(setting.traits.transports.empty());
    }
}

TEST_CASE("Help, schema and documents say the same sentence of a setting", "[scene_schema]") {
    const std::string help = in_one_line(run_stokes("render --help").out);
    const Json schema = scene_schema().at("$defs");
    const std::string guide = file_content(source_path("scenes/README.md"));
    for (const Setting& setting : settings()) {
        INFO(setting.key);
        CHECK_THAT(help, Contains(setting.flag()) && Contains(setting.sentence()));
        const std::string object = setting.object.empty() ? "scene" : setting.object;
        CHECK(schema.at(object).at("properties").at(setting.key).at("description") == setting.sentence() + ".");
    }
    CHECK_THAT(guide, Contains("<!-- settings -->\n" + settings_table() + "<!-- end of settings -->\n"));
}

TEST_CASE("A setting that the transport has not is the same error from scene and flag", "[scene_schema]") {
    const TemporaryFolder folder;
    const std::string file = folder.file("s.json");
    int refused = 0;
    for (const Setting& setting : settings()) {
        for (const Transport transport : all_transports) {
            const auto& have = setting.traits.transports;
            if (std::find(have.begin(), have.end(), transport) != have.end()) continue;
            ++refused;
            const std::string value = some_value(setting);
            CAPTURE(setting.key, word_of(transport), value);
            put_file(file, scene_text(transport, '"' + setting.key + "\": " + value));
            const Outcome by_scene = run_stokes("render --png x.png " + file);
            put_file(file, scene_text(transport, ""));
            const bool yes_no = std::holds_alternative<YesNo>(setting.domain);
            const Outcome by_flag =
                run_stokes("render --png x.png " + file + " " + setting.flag() + (yes_no ? "" : " " + value));
            CHECK(by_scene.code == 2);
            CHECK(by_flag.code == 2);
            const std::string end = ": " + setting.complaint(resolved([&] {
                RenderSettings given;
                given.transport = transport;
                return given;
            }())) + "\n";
            CHECK_THAT(end, Contains(": expected transport \"") && Contains(", got \"" + word_of(transport) + "\""));
            CHECK(by_scene.err == "stokes: " + file + ":1: " + setting.object + "." + setting.key + end);
            CHECK(by_flag.err == "stokes: " + setting.flag() + end);
        }
    }
    CHECK(refused ==
          9);  // two transports each lack tables, distances, exits and first_collision_only; walk lacks branches
}

TEST_CASE("A flag's value is refused as the scene's is", "[scene_schema]") {
    for (const Setting& setting : settings()) {
        if (setting.object != "render") continue;
        INFO(setting.key);
        JsonValue wrong;  // null, which no setting may be
        const std::string of_flag = input_error([&] {
            parse_scene(scene_text(Transport::paper, ""), "s.json", {{setting.key, {setting.flag(), wrong}}});
        });
        const std::string of_scene =
            input_error([&] { parse_scene(scene_text(Transport::paper, '"' + setting.key + "\": null"), "s.json"); });
        CHECK(of_scene.substr(of_scene.find(": expected")) == of_flag.substr(of_flag.find(": expected")));
    }
}

TEST_CASE("The command line's sampling takes back the samplers that the scene names", "[scene_schema]") {
    const std::string text = scene_text(Transport::conserving, R"("exits": 3, "direct": "photons", "seed": 5)");
    JsonValue best;
    best.type = JsonValue::Type::string;
    best.text = "best";
    const Scene scene = parse_scene(text, "s.json", {{"sampling", {"--sampling", best}}});
    CHECK_FALSE(scene.render.exits);
    CHECK_FALSE(scene.render.direct);
    CHECK(scene.render.seed == 5);
    CHECK(parse_scene(text, "s.json").render.exits == 3);
}
