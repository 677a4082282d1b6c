// Spectra by what a scene and `stokes probe` use them for: densities over wavelength, coefficients, shares of 1.
#include <nlohmann/json.hpp>

#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;
using Json = nlohmann::ordered_json;

namespace {

Json base() {
    return Json::parse(R"({
        "format": "stokes-scene", "version": 1,
        "camera": {"position_mm": [0, 0, 50], "target_mm": [0, 0, 0]},
        "media": {"stone": {"sigma_s_per_mm": 2, "sigma_a_per_mm": 0.1, "eta": 1.5}},
        "fluorophores": {"dye": {"excitation": 1, "emission": 1}},
        "materials": {"glow": {"type": "translucent", "medium": "stone", "fluorophore": "dye",
                               "fluorescent_fraction": 0.5},
                      "paint": {"type": "diffuse", "reflectance": 0.5}},
        "lights": [{"type": "disk", "center_mm": [0, 100, 0], "normal": [0, -1, 0], "radius_mm": 10, "power_W": 5,
                    "spectrum": 1}],
        "shapes": [{"type": "sphere", "material": "glow", "radius_mm": 10},
                   {"type": "sphere", "material": "paint", "radius_mm": 10, "transform": [{"translate_mm": [30, 0, 0]}]}]
    })");
}

const Json per_ev = Json::parse(
    R"({"pairs": [[1.5, 0.5], [1.54980248, 0.5], [3.09960496, 0.5], [4.2, 0.5]], "unit": "eV", "per": "unit"})");

Scene with(const char* pointer, const Json& spectrum) {
    Json scene = base();
    scene[Json::json_pointer(pointer)] = spectrum;
    return parse_scene(scene.dump(), "s.json");
}

}  // namespace

// The inner pairs are at 800 and 400 nm. A reflectance of 0.5 is one over any unit. A density of 0.5 per eV is 0.5 hc /
// lambda^2 per nm: falling fourfold from 400 to 800 nm.
TEST_CASE("values are per a unit in lights and emissions alone") {
    for (const char* pointer : {"/materials/paint/reflectance", "/media/stone/sigma_s_per_mm",
                                "/media/stone/sigma_a_per_mm", "/fluorophores/dye/excitation"}) {
        INFO(pointer);
        CHECK_THAT(input_error([&] { with(pointer, per_ev); }), Contains("expected no \"per\": these values are no"));
        Json plain = per_ev;
        plain.erase("per");
        CHECK_NOTHROW(with(pointer, plain));
    }
    const Spectrum emission = with("/fluorophores/dye/emission", per_ev).fluorophores[0].emission;
    CHECK(emission.at(400) / emission.at(800) == Approx(4.0).epsilon(0.01));
    CHECK_NOTHROW(with("/lights/0/spectrum", per_ev));
}

// Over 1.5 to 4.2 eV, 0.1 /mm absorbs as 0.1 /mm does; what the emission is per does not change that.
TEST_CASE("probe takes its emission alone per unit") {
    const TemporaryFolder folder;
    put_file(folder.file("ev.csv"), "eV,v\n1.45,0.1\n4.3,0.1\n");
    const auto probed = [&](const std::string& sigma_a) {
        return run_stokes("probe --sigma-s 1 --sigma-a " + sigma_a +
                          " --fraction 0.5 --excitation 1 --photons 640 --device cpu --per unit --emission " +
                          folder.file("ev.csv"));
    };
    const Outcome number = probed("0.1"), file = probed(folder.file("ev.csv"));
    CAPTURE(file.err);
    REQUIRE(file.code == 0);
    CHECK(file.err.empty());
    CHECK(file.out == number.out);
}

// What nothing scales is read as it stands, which is 100 or 10 times off where the file is right.
TEST_CASE("columns in percent and per centimetre are warned of where they are read as they stand") {
    const TemporaryFolder folder;
    put_file(folder.file("r.csv"), "wl;R;a\nnm;%;cm-1\n400;0.5;0.5\n500;0.5;0.5\n");
    const auto warnings = [&](const char* pointer, const Json& more, const char* column) {
        Json scene = base();
        Json spectrum = {{"file", "r.csv"}, {"column", column}};
        spectrum.update(more);
        scene[Json::json_pointer(pointer)] = spectrum;
        put_file(folder.file("s.json"), scene.dump());
        const Outcome run = run_stokes("render " + folder.file("s.json") + " -o " + folder.file("s.exr") +
                                       " --size 4x3 --passes 1 --photons 500 --quiet");
        CHECK(run.code == 0);
        return run.err;
    };
    const Json as_it_stands = Json::object();
    CHECK_THAT(
        warnings("/materials/paint/reflectance", as_it_stands, "R"),
        Contains("warning: ") && Contains("materials.paint.reflectance: column \"R\" is read as a share of 1, while "
                                          "the file says \"%\"; percentages have \"scale\": 0.01"));
    const std::string per_cm =
        "column \"a\" is read as 1/mm, while the file says \"cm-1\"; values per cm have \"scale\": 0.1";
    CHECK_THAT(warnings("/media/stone/sigma_a_per_mm", as_it_stands, "a"),
               Contains("media.stone.sigma_a_per_mm: " + per_cm));
    CHECK(warnings("/materials/paint/reflectance", {{"scale", 0.01}}, "R").find("percent") == std::string::npos);
    CHECK(warnings("/media/stone/sigma_a_per_mm", {{"scale", 0.1}}, "a").find("per cm") == std::string::npos);

    const Outcome probe = run_stokes("probe --photons 640 --device cpu --sigma-s 1 --sigma-a " + folder.file("r.csv") +
                                     ":a --fraction 0.5 --emission 1 --excitation " + folder.file("r.csv") + ":R");
    CHECK(probe.code == 0);
    CHECK_THAT(probe.err,
               Contains("--sigma-a: " + per_cm) && Contains("--excitation: column \"R\" is read as a share of 1"));
}
