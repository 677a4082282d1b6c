#include <random>

#include "host/core/media_limits.hpp"
#include "host/scene/readers/scene_reader.hpp"
#include "host/subsurface/escape.hpp"
#include "host/subsurface/paper_transport.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;
using Catch::Matchers::StartsWith;

namespace {

const std::string base = R"({
  "format": "stokes-scene", "version": 1, "transport": "paper",
  "render": {"passes": 4, "seed": 9, "lambda_min_nm": 300, "lambda_max_nm": 780},
  "film": {"width": 8, "height": 6},
  "camera": {"position_mm": [0, 0, 50], "target_mm": [0, 0, 0], "up": [0, 1, 0]},
  "spectra": {"lamp": {"pairs": [[300, 1], [400, 2]]}},
  "media": {"stone": {"sigma_s_per_mm": 2, "sigma_a_per_mm": 0.1, "eta": 1.5}},
  "fluorophores": {"dye": {"excitation": {"pairs": [[300, 1]]}, "emission": {"pairs": [[500, 1]]}}},
  "materials": {
    "floor": {"type": "diffuse", "reflectance": 0.5},
    "glow": {"type": "translucent", "medium": "stone", "fluorophore": "dye", "fluorescent_fraction": 0.5}
  },
  "lights": [
    {"type": "disk", "center_mm": [0, 100, 0], "normal": [0, -1, 0],
     "radius_mm": 10, "spectrum": "lamp", "power_W": 5}
  ],
  "shapes": [
    {"type": "sphere", "material": "glow", "radius_mm": 10,
     "transform": [{"scale": 2}, {"rotate_axis": [0, 1, 0], "angle_deg": 9}, {"translate_mm": [1, 2, 3]}]}
  ]
}
)";

struct Case {
    std::string what, with, expected;
};

void check(const std::vector<Case>& cases, const std::string& path = "s.json") {
    for (const Case& c : cases) {
        INFO(c.what << " -> " << c.with);
        const std::size_t at = base.find(c.what);
        REQUIRE(at != std::string::npos);
        const std::string text = std::string(base).replace(at, c.what.size(), c.with);
        CHECK_THAT(input_error([&] { parse_scene(text, path); }), StartsWith(path + c.expected));
    }
}

}  // namespace

TEST_CASE("The scene that the bad ones are made from is good") { CHECK_NOTHROW(parse_scene(base, "s.json")); }

TEST_CASE("Bad scenes: the file as a whole") {
    CHECK_THAT(input_error([] { parse_scene("[]", "s.json"); }),
               StartsWith("s.json:1: expected an object, got an array of 0"));
    CHECK_THAT(input_error([] { parse_scene("", "s.json"); }), StartsWith("s.json:1: JSON syntax error"));
    CHECK_THAT(input_error([] { read_scene("no/such/scene.json"); }),
               StartsWith("no/such/scene.json: cannot read: No such file or directory"));
    check({
        {"\"format\": \"stokes-scene\",", "", ":1: missing key \"format\""},
        {"stokes-scene", "stoke-scene", ":2: format: expected \"stokes-scene\", got \"stoke-scene\""},
        {"\"version\": 1", "\"version\": 2", ":2: version: expected an integer in [1, 1], got 2"},
        {"\"paper\"", "\"papers\"",
         ":2: transport: expected \"paper\", \"conserving\" or \"walk\", got \"papers\"; did you mean "
         "\"paper\"?"},
        {"\"paper\"", "1", ":2: transport: expected \"paper\", \"conserving\" or \"walk\", got 1"},
        {"\"film\"", "\"flim\"", ":4: unknown key \"flim\"; did you mean \"film\"?"},
        {"\"film\"", "\"render\"", ":4: key \"render\" given twice, first in line 3"},
        {"\"film\": {", "\"film\": [{", ":5: JSON syntax error while parsing array - unexpected ':'"},
        {"\"film\"", "\"comment\": 5, \"film\"", ":4: comment: expected a string, got 5"},
    });
}

TEST_CASE("Bad scenes: render, film and camera") {
    check({
        {"\"passes\": 4", "\"passes\": 0", ":3: render.passes: expected an integer in [1, 100000000], got 0"},
        {"\"passes\": 4", "\"passes\": 1e30", ":3: render.passes: expected an integer in"},
        {"\"passes\": 4", "\"photons_per_pass\": -1", ":3: render.photons_per_pass: expected an integer in"},
        {"\"passes\": 4", "\"photons_per_pass\": 268435457",
         ":3: render.photons_per_pass: expected an integer in [1, 268435456], got"},
        {"\"passes\": 4", "\"alpha\": 0", ":3: render.alpha: expected a number in (0, 1], got 0"},
        {"\"passes\": 4", "\"radius_mm\": 0", ":3: render.radius_mm: expected a number in (0, 1e+07], got 0"},
        {"\"passes\": 4", "\"radius\": 1", ":3: render: unknown key \"radius\"; did you mean \"radius_mm\"?"},
        {"\"seed\": 9", "\"seed\": 4294967296", ":3: render.seed: expected an integer in [0, 4294967295]"},
        {"\"seed\": 9", "\"seed\": 1.5", ":3: render.seed: expected an integer in [0, 4294967295], got 1.5"},
        {"780", "314", ":3: render: expected at least 16 whole wavelengths"},
        {"780", "831", ":3: render.lambda_max_nm: expected an integer in [300, 830], got 831"},
        {"\"seed\": 9", "\"sampling\": \"best\", \"wavelengths\": \"uniformly\"",
         ":3: render.wavelengths: expected \"uniform\" or \"importance\", got \"uniformly\""},
        {"\"seed\": 9", "\"distances\": \"far\"",
         ":3: render.distances: expected \"table\" or \"importance\", got \"far\""},
        {"\"seed\": 9", "\"branches\": \"one\"", ":3: render.branches: expected \"roulette\" or \"both\", got \"one\""},
        {"\"seed\": 9", "\"emission\": \"even\"",
         ":3: render.emission: expected \"random\", \"stratified\" or \"aimed\", got \"even\""},
        {"\"seed\": 9", "\"direct\": \"both\"", ":3: render.direct: expected \"photons\" or \"rays\", got \"both\""},
        {"\"seed\": 9", "\"radii\": 2", ":3: render.radii: expected \"one\" or \"local\", got 2"},
        {"\"seed\": 9", "\"exits\": 0", ":3: render.exits: expected an integer in [1, 64], got 0"},
        {"\"seed\": 9", "\"exits\": 65", ":3: render.exits: expected an integer in [1, 64], got 65"},
        {"\"seed\": 9", "\"sampling\": 1", ":3: render.sampling: expected \"plain\" or \"best\", got 1"},
        {"\"width\": 8", "\"width\": 4294967296", ":4: film.width: expected an integer in [1, 16384]"},
        {"\"width\": 8", "\"width\": \"8\"", ":4: film.width: expected an integer in [1, 16384], got \"8\""},
        {"\"width\": 8", "\"exposure_ev\": \"on\"",
         ":4: film.exposure_ev: expected a number in [-100, 100] or \"auto\", got \"on\""},
        {"\"width\": 8", "\"exposure_ev\": 1e999", ":4: number out of range: 1e999"},
        {"\"target_mm\": [0, 0, 0]", "\"target_mm\": [0, 0]", ":5: camera.target_mm: expected an array of 3"},
        {"\"target_mm\": [0, 0, 0]", "\"target_mm\": [0, 0, 50]", ":5: camera.target_mm: expected another place"},
        {"\"target_mm\": [0, 0, 0], ", "", ":5: camera: missing key \"target_mm\""},
        {"\"up\": [0, 1, 0]", "\"up\": [0, 0, 1]", ":5: camera: expected up to point another way"},
        {"\"up\": [0, 1, 0]", "\"up\": [0, 0, 0]", ":5: camera.up: expected a direction, got a vector of length"},
        {"\"up\": [0, 1, 0]", "\"vertical_fov_deg\": 180", ":5: camera.vertical_fov_deg: expected a number in"},
        {"\"up\": [0, 1, 0]", R"("crop": [0, 0, 1, 1])", ":5: camera.crop: expected an object, got an array of 4"},
        {"\"up\": [0, 1, 0]", R"("crop": {"left": 0, "top": 0, "width": 1})",
         ":5: camera.crop: missing key \"height\""},
        {"\"up\": [0, 1, 0]", R"("crop": {"left": 0, "top": 0, "width": 1, "hight": 1})",
         ":5: camera.crop: unknown key \"hight\"; did you mean \"height\"?"},
        {"\"up\": [0, 1, 0]", R"("crop": {"left": -0.1, "top": 0, "width": 0.5, "height": 0.5})",
         ":5: camera.crop.left: expected a number in [0, 1], got -0.1"},
        {"\"up\": [0, 1, 0]", R"("crop": {"left": 0, "top": 1.1, "width": 0.5, "height": 0.5})",
         ":5: camera.crop.top: expected a number in [0, 1], got 1.1"},
        {"\"up\": [0, 1, 0]", R"("crop": {"left": 0, "top": 0, "width": 0, "height": 0.5})",
         ":5: camera.crop.width: expected a number in [0.001, 1], got 0"},
        {"\"up\": [0, 1, 0]", R"("crop": {"left": 0, "top": 0, "width": 0.5, "height": 1.5})",
         ":5: camera.crop.height: expected a number in [0.001, 1], got 1.5"},
        {"\"up\": [0, 1, 0]", R"("crop": {"left": 0.75, "top": 0, "width": 0.5, "height": 0.5})",
         ":5: camera.crop: expected left + width up to 1, got 1.25"},
        {"\"up\": [0, 1, 0]", R"("crop": {"left": 0, "top": 1, "width": 0.5, "height": 0.5})",
         ":5: camera.crop: expected top + height up to 1, got 1.5"},
        {"[0, 0, 50]", "[0, \"y\", 50]", ":5: camera.position_mm[1]: expected a number in [-1e+11, 1e+11], got \"y\""},
    });
}

TEST_CASE("Bad scenes: spectra") {
    const TemporaryFolder folder;
    put_file(folder.file("bad.csv"), "nm,a\n300,1\n300,1\n");
    put_file(folder.file("negative.csv"), "nm,a\n300,1\n310,-1\n");
    put_file(folder.file("um.csv"), "w,a\n0.3,1\n0.8,1\n");
    const std::string lamp = R"({"pairs": [[300, 1], [400, 2]]})";
    check(
        {
            {lamp, "{}", ":6: spectra.lamp: expected one of the keys \"file\", \"illuminant\", \"pairs\" or"},
            {lamp, "7", ":6: spectra.lamp: expected an object, got 7"},
            {lamp, R"({"constant": 1, "pairs": []})", ":6: spectra.lamp: \"pairs\" and \"constant\" given together"},
            {lamp, R"({"constant": -1})", ":6: spectra.lamp.constant: expected a number in [0, 1e+12], got -1"},
            {lamp, R"({"pairs": []})", ":6: spectra.lamp.pairs: expected at least one"},
            {lamp, R"({"pairs": [[300]]})", ":6: spectra.lamp.pairs[0]: expected [wavelength in nm, value]"},
            {lamp, R"({"pairs": [[300, 1], [300, 1]]})",
             ":6: spectra.lamp.pairs[1][0]: expected wavelengths that increase, got 300 after 300"},
            {lamp, R"({"pairs": [[400, 1], [300, 1], [310, 2]]})",
             ":6: spectra.lamp.pairs[2][0]: expected wavelengths that decrease, got 310 after 300"},
            {lamp, R"({"pairs": [[300, 1]], "unit": "mm"})", ":6: spectra.lamp.unit: expected \"nm\", \"um\""},
            {lamp, R"({"pairs": [[300, 1]], "per": "m"})", ":6: spectra.lamp.per: expected \"nm\" or \"unit\""},
            {lamp, R"({"pairs": [[300, 1]], "negative": "zero"})", ":6: spectra.lamp: unknown key \"negative\""},
            {lamp, R"({"file": "um.csv", "column": "a"})",
             ":6: spectra.lamp.column: " + folder.file("um.csv") +
                 ": expected wavelengths from 300 to 830 nm, got 0.3 to 0.8 nm; if they are in um, say \"unit\""},
            {lamp, R"({"file": "negative.csv", "column": "a", "negative": "refuse"})",
             ":6: spectra.lamp.column: " + folder.file("negative.csv") + ":3: a: expected no negative value, got -1"},
            {lamp, R"({"pairs": [[300, -1]]})", ":6: spectra.lamp.pairs[0][1]: expected a number in [0, 1e+12]"},
            {lamp, R"({"pairs": [[0, 1]]})", ":6: spectra.lamp.pairs[0][0]: expected a number in (0, 100000]"},
            {lamp, R"({"illuminant": "D50"})", ":6: spectra.lamp.illuminant: expected \"A\", \"D65\" or \"E\""},
            {lamp, R"({"file": "x.csv"})", ":6: spectra.lamp: missing key \"column\""},
            {lamp, R"({"file": "x.csv", "column": "a"})",
             ":6: spectra.lamp.file: " + folder.file("x.csv") + ": cannot read: No such file or directory"},
            {lamp, R"({"file": "bad.csv", "column": "a"})",
             ":6: spectra.lamp.file: " + folder.file("bad.csv") + ":3: nm: 300 given twice"},
            {lamp, R"({"file": "negative.csv", "column": "a"})",
             ":6: spectra.lamp.column: " + folder.file("negative.csv") + ":3: a: expected no negative value"},
            {lamp, R"({"file": "negative.csv", "column": "b"})",
             ":6: spectra.lamp.column: " + folder.file("negative.csv") + ": no column \"b\""},
            {lamp, R"({"constant": 1, "outside": "hold"})", ":6: spectra.lamp: unknown key \"outside\""},
            {"\"lamp\": {\"p", "\"a/b\": {\"p", ":6: spectra: expected a name of 1 to 64 letters"},
            {"\"spectrum\": \"lamp\"", "\"spectrum\": \"lampe\"",
             ":15: lights[0].spectrum: no \"lampe\" in spectra; did you mean \"lamp\"?"},
            {"\"spectrum\": \"lamp\"", "\"spectrum\": [1]",
             ":15: lights[0].spectrum: expected a spectrum (a number, a name in spectra, or an object)"},
            {"\"spectrum\": \"lamp\"", "\"spectrum\": 0", ":15: lights[0].spectrum: expected some light from 300"},
        },
        folder.file("s.json"));
}

TEST_CASE("Bad scenes: media, fluorophores and materials") {
    check({
        {"\"sigma_s_per_mm\": 2", "\"sigma_s_per_mm\": -2", ":7: media.stone.sigma_s_per_mm: expected a number in"},
        {"\"sigma_s_per_mm\": 2", "\"sigma_s\": 2",
         ":7: media.stone: unknown key \"sigma_s\"; did you mean \"sigma_s_per_mm\"?"},
        {"\"sigma_s_per_mm\": 2, \"sigma_a_per_mm\": 0.1", "\"sigma_s_per_mm\": 0, \"sigma_a_per_mm\": 0",
         ":7: media.stone: expected sigma_s + sigma_a in [1e-09, 1e+09] 1/mm from 300 to 830 nm, got 0 at "
         "300"},
        {"\"sigma_s_per_mm\": 2", "\"sigma_s_per_mm\": 2e9",
         ":7: media.stone: expected sigma_s + sigma_a in [1e-09, 1e+09] 1/mm from 300"},
        {"\"sigma_s_per_mm\": 2, \"sigma_a_per_mm\": 0.1", "\"sigma_s_per_mm\": 0, \"sigma_a_per_mm\": 9e-10",
         ":7: media.stone: expected sigma_s + sigma_a in [1e-09, 1e+09] 1/mm from 300"},
        {"\"eta\": 1.5", "\"dipole_eta\": 3.9", ":7: media.stone.dipole_eta: expected a number in [1, 3.8], got 3.9"},
        {"[[500, 1]]", "[[500, 0]]",
         ":8: fluorophores.dye.emission: expected some emission from 300 to 830 nm, got none"},
        {"\"eta\": 1.5", "\"eta\": 0.5", ":7: media.stone.eta: expected a number in [1, 5], got 0.5"},
        {"[[300, 1]]", "[[300, 1.5]]", ":8: fluorophores.dye.excitation: expected values in [0, 1], got 1.5 at 300"},
        {"[[500, 1]]}", "[[500, 1]]}, \"conversion_per_nm\": 2", ":8: fluorophores.dye.conversion_per_nm: expected"},
        {"[[500, 1]]}", "[[500, 1]]}, \"quantum_yield\": 1.01",
         ":8: fluorophores.dye.quantum_yield: expected a number in [0, 1], got 1.01"},
        {"\"reflectance\": 0.5", "\"reflectance\": 1.5",
         ":10: materials.floor.reflectance: expected a number in [0, 1], got 1.5"},
        {"\"reflectance\": 0.5", "\"reflectance\": \"lamp\"",
         ":10: materials.floor.reflectance: expected values in [0, 1], got 2 at 400 nm"},
        {"\"reflectance\": 0.5", "\"reflectance\": {\"pairs\": [[0.3, 0.1], [0.8, 0.2]]}",
         ":10: materials.floor.reflectance: expected wavelengths from 300 to 830 nm, got 0.3 to 0.8 nm; if they are in "
         "um"},
        {"[[500, 1]]}", "[[500, 1]]}, \"stokes_rule\": \"keep\"",
         ":8: fluorophores.dye.stokes_rule: expected \"keep_yield\" or \"truncate\", got \"keep\""},
        {"\"reflectance\": 0.5", "\"reflectance\": \"white\"",
         ":10: materials.floor.reflectance: no \"white\" in spectra"},
        {"\"reflectance\": 0.5", "\"albedo\": 0.5", ":10: materials.floor: unknown key \"albedo\""},
        {"\"diffuse\"", "\"difuse\"",
         ":10: materials.floor.type: expected \"diffuse\", \"black\" or \"translucent\", got \"difuse\"; "
         "did"},
        {"\"type\": \"diffuse\", ", "", ":10: materials.floor: missing key \"type\""},
        {"{\"type\": \"diffuse\", \"reflectance\": 0.5}", "[]",
         ":10: materials.floor: expected an object, got an array"},
        {"\"medium\": \"stone\"", "\"medium\": \"stome\"",
         ":11: materials.glow.medium: no \"stome\" in media; did you mean \"stone\"?"},
        {"\"medium\": \"stone\", ", "", ":11: materials.glow: missing key \"medium\""},
        {"\"medium\": \"stone\", \"fluorophore\": \"dye\", \"fluorescent_fraction\": 0.5", "\"subsurface\": false",
         ":11: materials.glow: missing key \"fluorophore\""},
        {"\"fluorophore\": \"dye\", ", "", ":11: materials.glow.fluorescent_fraction: a fluorescent fraction without"},
        {", \"fluorescent_fraction\": 0.5", "", ":11: materials.glow: missing key \"fluorescent_fraction\""},
        {"\"fluorescent_fraction\": 0.5", "\"fluorescent_fraction\": 1.01",
         ":11: materials.glow.fluorescent_fraction: expected a number in [0, 1], got 1.01"},
        {"\"type\": \"diffuse\"", "\"type\": \"diffuse\", \"fresnel\": true",
         ":10: materials.floor: unknown key \"fresnel\""},
        {"\"medium\": \"stone\"", "\"medium\": \"stone\", \"fresnel\": 1",
         ":11: materials.glow.fresnel: expected true or false, got 1"},
        {"\"medium\": \"stone\"", "\"medium\": \"stone\", \"fresnel\": true, \"subsurface\": false",
         ":11: materials.glow.fresnel: Fresnel reflection needs a medium and subsurface light"},
        {"\"medium\": \"stone\"", "\"fresnel\": true, \"subsurface\": false",
         ":11: materials.glow.fresnel: Fresnel reflection needs a medium and subsurface light"},
        {"\"medium\": \"stone\"", "\"fresnel\": true",
         ":11: materials.glow: missing key \"medium\", which subsurface light needs"},
        {"\"dye\", \"fl", "\"ink\", \"fl", ":11: materials.glow.fluorophore: no \"ink\" in fluorophores"},
        {"\"fluorescent_fraction\": 0.5",
         "\"fluorescent_fraction\": 0.5, \"fluorophores\": [{\"fluorophore\": \"dye\", \"fraction\": 0.5}]",
         ":11: materials.glow.fluorophores: expected either this or \"fluorophore\" and \"fluorescent_fraction\", "
         "got both"},
        {"\"fluorophore\": \"dye\", \"fluorescent_fraction\": 0.5", "\"fluorophores\": []",
         ":11: materials.glow.fluorophores: expected one or more fluorophores"},
        {"\"fluorophore\": \"dye\", \"fluorescent_fraction\": 0.5",
         "\"fluorophores\": [{\"fluorophore\": \"dye\", \"fraction\": 0.5}, {\"fluorophore\": \"dye\", \"fraction\": "
         "0.1}]",
         ":11: materials.glow.fluorophores[1].fluorophore: \"dye\" given twice"},
        {"\"fluorophore\": \"dye\", \"fluorescent_fraction\": 0.5",
         "\"fluorophores\": [{\"fluorophore\": \"dye\", \"fraction\": 1.5}]",
         ":11: materials.glow.fluorophores[0].fraction: expected a number in [0, 1], got 1.5"},
        {"\"fluorophore\": \"dye\", \"fluorescent_fraction\": 0.5",
         "\"fluorophores\": [{\"fluorophore\": \"dye\", \"share\": 0.5}]",
         ":11: materials.glow.fluorophores[0]: unknown key \"share\""},
        {"\"glow\": {", "\"../glow\": {", ":11: materials: expected a name of 1 to 64 letters"},
    });
}

TEST_CASE("Fresnel reflection needs a refractive index that tables of it end at") {
    const auto with_eta = [](const std::string& eta, const std::string& fresnel) {
        std::string text = base;
        text.replace(text.find("\"eta\": 1.5"), 10, "\"eta\": " + eta);
        return text.replace(text.find("\"medium\": \"stone\""), 17, "\"medium\": \"stone\", \"fresnel\": " + fresnel);
    };
    CHECK(input_error([&] { parse_scene(with_eta("4.01", "true"), "s.json"); }) ==
          "s.json:11: materials.glow.fresnel: Fresnel reflection needs a medium with eta up to 4, got 4.01");
    CHECK_NOTHROW(parse_scene(with_eta("4", "true"), "s.json"));
    CHECK_NOTHROW(parse_scene(with_eta("4.01", "false"), "s.json"));
}

TEST_CASE("Bad scenes: lights") {
    check({
        {"\"power_W\": 5", "\"power_W\": 0", ":15: lights[0].power_W: expected a number in (0, 1e+12], got 0"},
        {", \"power_W\": 5", "", ":14: lights[0]: expected one of the keys \"power_W\", \"radiance_W_m2_sr\" or"},
        {"\"power_W\": 5", "\"power_W\": 5, \"radiance_W_m2_sr\": 5",
         ":14: lights[0]: \"power_W\" and \"radiance_W_m2_sr\" given together"},
        {"\"power_W\": 5", "\"power_w\": 5", ":15: lights[0]: unknown key \"power_w\"; did you mean \"power_W\"?"},
        {"\"power_W\": 5", "\"power_W\": 5, \"material\": \"red\"", ":15: lights[0].material: no \"red\" in materials"},
        {"\"normal\": [0, -1, 0]", "\"normal\": [0, 0, 0]",
         ":14: lights[0].normal: expected a direction, got a vector"},
        {"\"radius_mm\": 10, \"s", "\"radius_mm\": 1e-30, \"s",
         ":14: lights[0]: expected a triangle with an area, found none"},
        {"\"type\": \"disk\"", "\"type\": \"laser\"",
         ":14: lights[0].type: expected \"beam\", \"rectangle\", \"disk\" or \"sphere\", got"},
        {"\"type\": \"disk\"", "\"type\": \"beam\"", ":14: lights[0]: missing key \"section\""},
        {"\"type\": \"disk\"", "\"type\": \"beam\", \"section\": \"disk\"",
         ":14: lights[0]: unknown key \"center_mm\""},
        {"\"type\": \"disk\"", "\"type\": \"rectangle\"", ":15: lights[0]: unknown key \"radius_mm\""},
        {"[[300, 1], [400, 2]]", "[[200, 1], [250, 2]]",
         ":15: lights[0].spectrum: expected some light from 300 to 780 nm"},
        {"[[300, 1], [400, 2]]", "[[250, 2], [290, 0]]",
         ":15: lights[0].spectrum: expected some light from 300 to 780 nm, got none"},
        {"[[300, 1], [400, 2]]", "[[404, 1e-320]]",
         ":15: lights[0].spectrum: expected some light from 300 to 780 nm, got a sum of only"},
    });
    const std::size_t begin = base.find("\"lights\": [");
    const std::size_t end = base.find("  \"shapes\"");
    const std::string dark = std::string(base).replace(begin, end - begin, "\"lights\": [],\n");
    CHECK(input_error([&] { parse_scene(dark, "s.json"); }) == "s.json:13: lights: expected at least one light");
    const std::string up =
        R"("type": "rectangle", "up": [0, 2, 0], "width_mm": 1, "height_mm": 1, "center_mm": [0, 100, 0],
        "normal": [0, -1, 0], "spectrum": "lamp", "power_W": 5})";
    const std::string parallel = std::string(base).replace(begin, end - begin, "\"lights\": [{" + up + "],\n");
    CHECK(input_error([&] { parse_scene(parallel, "s.json"); }) ==
          "s.json:13: lights[0].up: expected another direction than normal");
}

TEST_CASE("Bad scenes: shapes and transforms") {
    const TemporaryFolder folder;
    put_file(folder.file("flat.obj"), "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    put_file(folder.file("bad.obj"), "v 0 0 0\nf 1 2 3\n");
    const std::string sphere = "\"type\": \"sphere\", \"material\": \"glow\", \"radius_mm\": 10";
    const std::string mesh = "\"type\": \"mesh\", \"material\": \"glow\", \"file\": ";
    check(
        {
            {"\"material\": \"glow\"", "\"material\": \"glo\"",
             ":18: shapes[0].material: no \"glo\" in materials; did you mean \"glow\"?"},
            {"\"material\": \"glow\"", "\"material\": 3", ":18: shapes[0].material: expected a string, got 3"},
            {"\"radius_mm\": 10,\n", "\"radius_mm\": -10,\n",
             ":18: shapes[0].radius_mm: expected a number in (0, 1e+07]"},
            {"\"radius_mm\": 10,\n", "\"segments\": 3,\n", ":18: shapes[0]: missing key \"radius_mm\""},
            {"\"radius_mm\": 10,\n", "\"radius_mm\": 10, \"segments\": 3,\n",
             ":18: shapes[0].segments: expected an integer in [4, 2048]"},
            {"\"type\": \"sphere\"", "\"type\": \"cone\"", ":18: shapes[0].type: expected \"mesh\", \"box\""},
            {"{\"scale\": 2}", "{\"scale\": 0}", ":19: shapes[0].transform[0].scale: expected a scale other than zero"},
            {"{\"scale\": 2}", "{\"scale\": [1, 0, 1]}",
             ":19: shapes[0].transform[0].scale[1]: expected a scale other than zero"},
            {"{\"scale\": 2}", "{\"scale\": 1e8}", ":18: shapes[0]: expected coordinates in [-1e+07, 1e+07] mm"},
            // What the camera sees stays, and the origin with it.
            {"[1, 2, 3]", "[0, 2e9, 0]", ":18: shapes[0]: expected coordinates in [-1e+07, 1e+07] mm"},
            {"{\"scale\": 2}", "{\"scale\": 1, \"translate_mm\": [0, 0, 0]}",
             ":19: shapes[0].transform[0]: \"scale\" and \"translate_mm\" given together"},
            {"{\"scale\": 2}", "{}", ":19: shapes[0].transform[0]: expected one of the keys"},
            {"[{\"scale\": 2}", "[2", ":19: shapes[0].transform[0]: expected an object, got 2"},
            {"[0, 1, 0], \"angle", "[0, 0, 0], \"angle",
             ":19: shapes[0].transform[1].rotate_axis: expected a direction"},
            {", \"angle_deg\": 9", "", ":19: shapes[0].transform[1]: missing key \"angle_deg\""},
            {sphere, mesh + "\"no.ply\"", ":18: shapes[0].file: " + folder.file("no.ply") + ": cannot read: No such"},
            {sphere, mesh + "\"bad.obj\"",
             ":18: shapes[0].file: " + folder.file("bad.obj") + ":2: vertex index 3 out of range"},
            {sphere, mesh + "\"flat.obj\"", ":18: shapes[0]: expected a triangle with an area, found none"},
            {sphere, "\"type\": \"prism\", \"material\": \"glow\", \"sides\": 2, \"radius_mm\": 1, \"height_mm\": 1",
             ":18: shapes[0].sides: expected an integer in [3, 2048], got 2"},
            {sphere, "\"type\": \"box\", \"material\": \"glow\", \"size_mm\": [1, 0, 1]",
             ":18: shapes[0].size_mm[1]: expected a number in (0"},
            {"\"shapes\": [", "\"shapes\": [{\"name\": \"a\", " + sphere + "}, {\"name\": \"a\", " + sphere + "},",
             ":17: shapes[1].name: the name \"a\" given twice"},
            {"\"shapes\": [",
             "\"shapes\": [{\"type\": \"disk\", \"material\": \"glow\", \"radius_mm\": 1, \"body\": \"b\"},"
             "{\"type\": \"disk\", \"material\": \"floor\", \"radius_mm\": 1, \"body\": \"b\"},",
             ":17: shapes[1].body: expected one material in a body, got \"glow\" and \"floor\""},
        },
        folder.file("s.json"));
}

TEST_CASE("Shapes that single precision cannot hold where they are") {
    check({{"{\"scale\": 2}", "{\"scale\": 0.01}, {\"translate_mm\": [9e6, 9e6, 0]}",
            ":18: shapes[0]: expected a larger shape: too small for single precision at this distance"}});
}

TEST_CASE("The media that the reader lets through are those that tables can be made for") {
    CHECK_NOTHROW(dipole_boundary(largest_dipole_eta));
    CHECK_THROWS_AS(dipole_boundary(largest_dipole_eta + 0.1), InputError);
    CHECK_NOTHROW(HalfSpaceEscape(largest_green_eta, {1.0}));
    CHECK_THROWS_AS(HalfSpaceEscape(largest_green_eta + 0.1, {1.0}), InputError);
}

TEST_CASE("A file too large for the memory is an input error") {
    const TemporaryFolder folder;
    const std::string path = folder.file("huge.json");
    put_file(path, "");
    std::filesystem::resize_file(path, std::uintmax_t{1} << 40);
    rlimit before{};
    REQUIRE(::getrlimit(RLIMIT_AS, &before) == 0);
    rlimit limit = before;
    limit.rlim_cur = rlim_t{1} << 36;
    REQUIRE(::setrlimit(RLIMIT_AS, &limit) == 0);
    const std::string error = input_error([&] { read_scene(path); });
    REQUIRE(::setrlimit(RLIMIT_AS, &before) == 0);
    CHECK(error == path + ": cannot read: too large for the memory, 1048576 MiB");
}

TEST_CASE("A scene with nothing in it") {
    const std::size_t lights = base.find("\"lights\": [");
    const std::string beam_only = base.substr(0, lights) +
                                  R"("lights": [{"type": "beam", "section": "disk", "position_mm": [0, 9, 0],
        "direction": [0, -1, 0], "radius_mm": 1, "spectrum": "lamp", "irradiance_W_m2": 1}], "shapes": []})";
    CHECK(input_error([&] { parse_scene(beam_only, "s.json"); }) ==
          "s.json:1: nothing to see: no shapes, and no light with a surface");
}

TEST_CASE("Damaged scenes are errors and nothing worse") {
    for (std::size_t length = 0; length + 3 < base.size(); length += 7) {
        INFO(length);
        CHECK_FALSE(input_error([&] { parse_scene(base.substr(0, length), "s.json"); }).empty());
    }
    std::mt19937 random(1);
    int good = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string damaged = base;
        damaged[random() % damaged.size()] = static_cast<char>(32 + random() % 95);
        if (input_error([&] { parse_scene(damaged, "s.json"); }).empty()) ++good;
    }
    CHECK((good > 0 && good < 3000));
}
