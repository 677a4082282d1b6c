// What `stokes render` says of scenes whose pictures are not what they seem: one line each, and exit code 0.
#include <nlohmann/json.hpp>

#include "tests/support/catch.hpp"
#include "tests/support/png_bytes.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;
using Json = nlohmann::ordered_json;

namespace {

// A ball on a floor under a beam.
Json ball() {
    return Json::parse(R"({
        "format": "stokes-scene", "version": 1,
        "camera": {"position_mm": [0, 60, 140], "target_mm": [0, 18, 0]},
        "media": {"milk": {"sigma_s_per_mm": 1.5, "sigma_a_per_mm": 0.05, "eta": 1.33}},
        "materials": {"glow": {"type": "translucent", "medium": "milk"}, "white": {"type": "diffuse", "reflectance": 0.8}},
        "lights": [{"type": "beam", "section": "disk", "position_mm": [0, 200, 0], "direction": [0, -1, 0],
                    "radius_mm": 100, "irradiance_W_m2": 10, "spectrum": {"illuminant": "D65"}}],
        "shapes": [{"type": "rectangle", "width_mm": 300, "height_mm": 300, "material": "white"},
                   {"name": "ball", "type": "sphere", "radius_mm": 18, "material": "glow",
                    "transform": [{"translate_mm": [0, 18, 0]}]}]})");
}

// A closed room of this reflectance, as a box turned inside out by its corners: six squares that face inward.
Json room(double reflectance) {
    Json scene = ball();
    scene["media"] = Json::object();
    scene["materials"] = {{"white", {{"type", "diffuse"}, {"reflectance", reflectance}}}};
    scene["camera"] = {{"position_mm", {0, 0, 80}}, {"target_mm", {0, -20, 0}}};
    scene["lights"] = Json::parse(R"([{"type": "sphere", "center_mm": [0, 60, 0], "radius_mm": 10, "power_W": 1,
                                       "material": "white", "spectrum": {"illuminant": "D65"}}])");
    scene["shapes"] = Json::array();
    const auto wall = [&](const Json& axis, double angle, const Json& to) {
        scene["shapes"].push_back(
            {{"type", "rectangle"},
             {"width_mm", 200},
             {"height_mm", 200},
             {"material", "white"},
             {"transform", {{{"rotate_axis", axis}, {"angle_deg", angle}}, {{"translate_mm", to}}}}});
    };
    wall({1, 0, 0}, 0, {0, -100, 0});
    wall({1, 0, 0}, 180, {0, 100, 0});
    wall({0, 0, 1}, -90, {-100, 0, 0});
    wall({0, 0, 1}, 90, {100, 0, 0});
    wall({1, 0, 0}, 90, {0, 0, -100});
    wall({1, 0, 0}, -90, {0, 0, 100});
    return scene;
}

Outcome rendered(const Json& scene, const std::string& options = "--quiet") {
    const TemporaryFolder folder;
    put_file(folder.file("s.json"), scene.dump());
    return run_stokes("render " + folder.file("s.json") + " -o " + folder.file("s.exr") +
                      " --size 12x8 --passes 1 --sampling plain " + options +
                      (options.find("--photons") == std::string::npos ? " --photons 500" : ""));
}

}  // namespace

// The ball is met; the note of what nothing uses keeps quiet where the program is told to.
TEST_CASE("a sound scene has no warnings", "[render_warnings]") {
    Json scene = ball();
    CHECK(rendered(scene).err.empty());
    scene["materials"]["spare"] = {{"type", "black"}};
    CHECK(rendered(scene).err.empty());
    CHECK_THAT(rendered(scene, "").err,
               Contains("stokes: note: ") && Contains("nothing in the picture uses materials \"spare\""));
}

TEST_CASE("a key that the transport ignores is said", "[render_warnings]") {
    Json scene = ball();
    scene["media"]["milk"]["dipole_eta"] = 1.33;
    for (const char* transport : {"conserving", "walk"}) {
        const Outcome run = rendered(scene, std::string("--quiet --transport ") + transport);
        CHECK(run.code == 0);
        CHECK_THAT(run.err,
                   Contains("stokes: warning: ") && Contains("s.json: media: transport \"" + std::string(transport) +
                                                             "\" ignores dipole_eta of \"milk\"\n"));
    }
    CHECK(rendered(scene, "--quiet --transport paper").err.empty());
}

TEST_CASE("a translucent body in the dark is named", "[render_warnings]") {
    Json scene = ball();
    scene["shapes"].push_back(
        Json::parse(R"({"type": "rectangle", "width_mm": 300, "height_mm": 300, "material": "white",
                                              "transform": [{"translate_mm": [0, 100, 0]}]})"));
    scene["shapes"][0]["material"] = scene["shapes"][2]["material"] = "black";
    scene["materials"]["black"] = {{"type", "black"}};
    const Outcome run = rendered(scene);
    CHECK(run.code == 0);
    CHECK_THAT(run.err, Contains("stokes: warning: no photon met the translucent body \"ball\""));
}

// A dye that gives off a hundred times what it takes up creates light. It is measured by the light that can meet the
// scene: a beam of 30 m has 90 000 times the power of one of 100 mm.
TEST_CASE("created light is said of wide beams too", "[render_warnings]") {
    Json scene = ball();
    scene["fluorophores"] = {{"hot", {{"excitation", 1}, {"emission", 1}, {"conversion_per_nm", 0.2}}}};
    scene["materials"]["glow"]["fluorophore"] = "hot";
    scene["materials"]["glow"]["fluorescent_fraction"] = 1;
    for (const double radius_mm : {100.0, 30000.0}) {
        scene["lights"][0]["radius_mm"] = radius_mm;
        const Outcome run = rendered(scene, "--quiet --transport paper --photons 4000");
        CHECK(run.code == 0);
        CHECK_THAT(run.err, Contains("times the emitted light was created"));
    }
}

// 1/2.2 is what programs write for sRGB.
TEST_CASE("a texture's gamma that is not applied is said", "[render_warnings]") {
    const TemporaryFolder folder;
    Json scene = ball();
    scene["materials"]["white"]["reflectance"] = {{"texture", "t.png"}, {"black", 0.1}, {"white", 0.9}};
    put_file(folder.file("s.json"), scene.dump());
    const auto warnings = [&](double gamma) {
        PngKind kind;
        kind.gamma = gamma;
        put_file(folder.file("t.png"), png_bytes(2, {std::string("\x10\x80"), std::string("\xf0\x20")}, kind));
        const Outcome run = run_stokes("render " + folder.file("s.json") + " -o " + folder.file("s.exr") +
                                       " --size 12x8 --passes 1 --photons 500 --sampling plain --quiet");
        CHECK(run.code == 0);
        return run.err;
    };
    CHECK_THAT(warnings(1.0), Contains("t.png: its gamma (gAMA 1) is not applied: the picture is taken as sRGB"));
    CHECK(warnings(1.0 / 2.2).empty());
    CHECK(warnings(0.0).empty());
}

// Nothing takes up light here, so that every path goes on to the limit of events and all of the light is cut off there.
TEST_CASE("light that is cut off is said", "[render_warnings]") {
    const Outcome run = rendered(room(1.0));
    CHECK(run.code == 0);
    CHECK_THAT(run.err, Contains("stokes: warning: 1 times the emitted light was cut off") && Contains("too dark"));
    CHECK(rendered(room(0.5)).err.empty());
}
