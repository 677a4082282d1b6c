#include <nlohmann/json.hpp>
#include <stdexcept>

#include "host/image/exr.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;

namespace {

double imbalance(const nlohmann::json& ledger) {
    double balance = ledger["emitted"].get<double>() + ledger["created"].get<double>();
    for (const char* end : {"absorbed", "stokes_loss", "escaped", "dropped", "roulette"})
        balance -= ledger[end].get<double>();
    return std::abs(balance) / ledger["emitted"].get<double>();
}

// The sphere's scene with one part replaced, its files found from anywhere.
std::string edited_sphere_scene(const std::string& what, const std::string& with) {
    std::string text = file_content(sphere_scene);
    const std::size_t begin = text.find(what);
    if (begin == std::string::npos) throw std::logic_error("not in the scene: " + what);
    text.replace(begin, what.size(), with);
    for (std::size_t at = text.find("../"); at != std::string::npos; at = text.find("../"))
        text.replace(at, 3, source_path(""));
    return text;
}

}  // namespace

TEST_CASE("render writes the picture, the PNG and the figures", "[command line]") {
    const TemporaryFolder folder;
    const Outcome outcome = run_stokes("render " + sphere_scene + small_render + "--seed 7 -o " + folder.file("a.exr") +
                                       " --png " + folder.file("a.png") + " --stats " + folder.file("a.json"));
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(folder.names() == std::vector<std::string>{"a.exr", "a.json", "a.png"});
    CHECK(outcome.err.find("pass 2/2") != std::string::npos);

    const ExrImage image = read_exr(folder.file("a.exr"));
    CHECK(image.width == 24);
    CHECK(image.height == 16);
    REQUIRE(image.layers.size() == 1 + layer_count);
    double brightest = 0.0;
    for (std::size_t i = 0; i < image.layers.at("").size(); ++i) {
        float sum = 0.0f;
        for (const LayerRow& row : layer_rows) sum += image.layers.at(row.name)[i];
        CHECK(sum == Approx(image.layers.at("")[i]).epsilon(1e-5).margin(1e-5));
        brightest = std::max(brightest, static_cast<double>(sum));
    }
    CHECK(brightest > 0.0);
    CHECK(std::get<int>(image.attributes.at("stokes.passes")) == 2);

    const auto stats = nlohmann::json::parse(file_content(folder.file("a.json")));
    CHECK(stats["passes"] == 2);
    CHECK(stats["seed"] == 7);
    CHECK(stats["photons_emitted"] == 8000);
    CHECK(stats["rays_traced"].get<int>() >= 8000 + 2 * 24 * 16);
    CHECK(stats["radius_last_mm"] < stats["radius_first_mm"]);
    for (const char* kernel : {"emit_stratified", "trace_photons", "classify_photons", "gather_radiance"})
        CHECK(stats["stages"].contains(kernel));
    for (const char* cause : {"missed_exit", "map_full", "event_limit", "overflow"})
        CHECK(stats["dropped"].contains(cause));
    const auto& ledger = stats["ledger"];
    CHECK(imbalance(ledger) < 1e-4);
    CHECK(ledger["stored"].get<double>() > 0.0);
}

TEST_CASE("bad input is one line and exit code 2, and leaves no file", "[command line]") {
    const TemporaryFolder folder;
    const std::string out = " --png " + folder.path() + "/x.png";
    put_file(folder.file("bad.json"), "{\n  \"format\": \"stokes-scene\",\n  \"version\": 1,\n  \"camra\": {}\n}\n");
    struct Case {
        std::string arguments, expected;
    };
    for (const Case& c : std::vector<Case>{
             {"", "subcommand"},
             {"frobnicate", "\"frobnicate\" is no subcommand; there are: render, tables, probe, compare, devices"},
             {"render", "scene"},
             {"render " + sphere_scene, "output"},
             {"render nowhere.json" + out, "nowhere.json"},
             {"render " + folder.file("bad.json") + out, "bad.json:4: unknown key \"camra\"; did you mean \"camera\"?"},
             {"render " + sphere_scene + " --passes 0" + out, "passes"},
             {"render " + sphere_scene + " --passes x" + out, "passes"},
             {"render " + sphere_scene + " --photons -3" + out, "photons"},
             {"render " + sphere_scene + " --size 10" + out, "--size"},
             {"render " + sphere_scene + " --size 0x4" + out, "--size"},
             {"render " + sphere_scene + " --alpha 2" + out, "alpha"},
             {"render " + sphere_scene + " --radius 0" + out, "radius"},
             {"render " + sphere_scene + " --wavelengths some" + out, "--wavelengths"},
             {"render " + sphere_scene + " --sampling rich" + out, "--sampling"},
             {"render " + sphere_scene + " --branches one" + out, "--branches"},
             {"render " + sphere_scene + " --emission some" + out, "--emission"},
             {"render " + sphere_scene + " --direct light" + out, "--direct"},
             {"render " + sphere_scene + " --radii two" + out, "--radii"},
             {"render " + sphere_scene + " --exits 0" + out, "--exits"},
             {"render " + sphere_scene + " --transport walk --branches both" + out,
              "--branches: expected transport \"paper\" or \"conserving\", got \"walk\""},
             {"render " + sphere_scene + " --transport paper --distances far" + out, "--distances"},
             {"render " + sphere_scene + " --distances table" + out,
              "--distances: expected transport \"paper\", got \"conserving\""},
             {"render " + sphere_scene + " --transport paper --no-tables --distances table" + out,
              "--distances: expected power tables, got none"},
             {"render " + sphere_scene + " --transport paper --exits 2" + out,
              "--exits: expected transport \"conserving\", got \"paper\""},
             {"render " + sphere_scene + " --alpha nan" + out, "--alpha: expected a number"},
             {"render " + sphere_scene + " --radius nan" + out, "--radius: expected a number"},
             {"render " + sphere_scene + " --exposure nan" + out, "--exposure: expected a number"},
             {"render " + sphere_scene + " --exposure inf" + out, "--exposure: expected a number"},
             {"render " + sphere_scene + " --max-memory nan" + out, "--max-memory: expected a number"},
             {"render " + sphere_scene + " --photons 268435457" + out, "--photons: expected an integer"},
             {"render " + sphere_scene + " --seed -1" + out, "--seed"},
             {"render " + sphere_scene + " --png /dev/null", "/dev/null: cannot write: not a regular file"},
             {"render " + sphere_scene + " --stats " + folder.path() + "/x.png" + out, "another file for each output"},
             {"render " + folder.file("bad.json") + " -o " + folder.file("bad.json"), "would replace the scene"},
             {"render " + sphere_scene + " --colour red" + out, "--colour"},
             {"render " + sphere_scene + " --device abacus" + out, "abacus"},
             {"render " + sphere_scene + " --ray-kernel sse" + out, "--ray-kernel: expected"},
             {"render " + sphere_scene + small_render + "--quiet --max-memory 0.001" + out, "memory"},
             {"render " + sphere_scene + " --png " + folder.path() + "/none/x.png", "none/x.png"},
             {"tables " + sphere_scene, "-o"},
         }) {
        const Outcome outcome = run_stokes(c.arguments);
        CAPTURE(c.arguments, outcome.err);
        CHECK(outcome.code == 2);
        CHECK(outcome.err.find("stokes: ") == 0);
        CHECK(outcome.err.find(c.expected) != std::string::npos);
        CHECK(outcome.out.empty());
    }
    CHECK(folder.names() == std::vector<std::string>{"bad.json"});
}

TEST_CASE("a device named in the environment that PoCL does not know is refused", "[command line]") {
    const Outcome outcome = run_stokes("devices", "POCL_DEVICES=pthrad");
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find("pthrad") != std::string::npos);
}

TEST_CASE("devices lists at least one CPU", "[command line]") {
    const Outcome outcome = run_stokes("devices");
    CHECK(outcome.code == 0);
    CHECK(outcome.out.find("0:0") == 0);
    CHECK(outcome.out.find("CPU") != std::string::npos);
}

TEST_CASE("help and version are no errors", "[command line]") {
    CHECK(run_stokes("--help").code == 0);
    CHECK(run_stokes("render --help").out.find("--photons") != std::string::npos);
    CHECK(run_stokes("--version").code == 0);
}

TEST_CASE("a device is chosen by its index, by its kind and by a part of its name", "[command line]") {
    const std::string name = run_stokes("devices").out;
    REQUIRE(name.find("0:0  CPU  ") == 0);
    const std::size_t begin = std::string("0:0  CPU  ").size();
    std::string part = name.substr(begin, name.find("  ", begin) - begin);
    part = part.substr(part.size() / 4, part.size() / 2);
    for (char& c : part) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    for (const std::string& selector : {std::string("0:0"), std::string("cpu"), part}) {
        const TemporaryFolder folder;
        const Outcome outcome = run_stokes("render " + sphere_scene + small_render + "--quiet --device '" + selector +
                                           "' --stats " + folder.file("a.json"));
        CAPTURE(selector, outcome.err);
        REQUIRE(outcome.code == 0);
        const auto stats = nlohmann::json::parse(file_content(folder.file("a.json")));
        CHECK(name.find(stats["device"].get<std::string>()) == begin);
    }
    const Outcome none = run_stokes("render " + sphere_scene + " --device 9:9 --png x.png");
    CHECK(none.code == 2);
    CHECK(none.err.find("0:0") != std::string::npos);
}

TEST_CASE("the command line's transport takes the scene's place, and the outputs name it", "[command line]") {
    for (const std::string transport : {"", "paper", "conserving", "walk"}) {
        const TemporaryFolder folder;
        const std::string option = transport.empty() ? "" : "--transport " + transport;
        const Outcome outcome = run_stokes("render " + sphere_scene + small_render + "--quiet " + option + " -o " +
                                           folder.file("a.exr") + " --stats " + folder.file("a.json"));
        CAPTURE(transport, outcome.err);
        REQUIRE(outcome.code == 0);
        const std::string used = transport.empty() ? "conserving" : transport;
        CHECK(nlohmann::json::parse(file_content(folder.file("a.json")))["transport"] == used);
        CHECK(std::get<std::string>(read_exr(folder.file("a.exr")).attributes.at("stokes.transport")) == used);
    }
}

TEST_CASE("a scene's crop is rendered, and the picture says which it is", "[command line]") {
    const TemporaryFolder folder;
    const std::string render = "render " + folder.file("s.json") + small_render + "--quiet -o " + folder.file("a.exr");
    const auto crop_scene = [&](const std::string& left) {
        put_file(folder.file("s.json"),
                 edited_sphere_scene("\"camera\": {", "\"camera\": {\"crop\": {\"left\": " + left +
                                                          ", \"top\": 0.125, \"width\": 0.5, \"height\": 0.5}, "));
    };
    crop_scene("0.25");
    REQUIRE(run_stokes(render).code == 0);
    const ExrImage image = read_exr(folder.file("a.exr"));
    CHECK(image.width == 24);
    CHECK(image.height == 16);
    CHECK(std::get<std::string>(image.attributes.at("stokes.crop")) == "0.25 0.125 0.5 0.5");
    crop_scene("0.75");
    const Outcome outside = run_stokes(render);
    CHECK(outside.code == 2);
    CHECK(outside.err ==
          "stokes: " + folder.file("s.json") + ":5: camera.crop: expected left + width up to 1, got 1.25\n");
}

TEST_CASE("a transport that there is not is bad input, in one line", "[command line]") {
    const Outcome outcome = run_stokes("render " + sphere_scene + " --png x.png --transport dipole");
    CHECK(outcome.code == 2);
    CHECK(outcome.err == "stokes: --transport: expected \"paper\", \"conserving\" or \"walk\", got \"dipole\"\n");
}

TEST_CASE("walking through a thing with a hole is bad input", "[command line]") {
    const TemporaryFolder folder;
    put_file(folder.file("hole.obj"), "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
    put_file(
        folder.file("s.json"),
        edited_sphere_scene("\"type\": \"sphere\", \"material\": \"glow\", \"radius_mm\": 20",
                            "\"name\": \"hole\", \"type\": \"mesh\", \"material\": \"glow\", \"file\": \"hole.obj\""));
    const Outcome outcome =
        run_stokes("render " + folder.file("s.json") + small_render + "--transport walk --png " + folder.file("a.png"));
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find("stokes: " + folder.file("s.json") +
                           ": shape \"hole\": transport \"walk\" expects a closed mesh or a flat sheet, got 3 edges "
                           "without a neighbour, one at (") == 0);
}

TEST_CASE("a ball smaller than its light's reach is rendered with one warning", "[command line]") {
    const TemporaryFolder folder;
    const std::string rest = small_render + "--quiet --png " + folder.file("a.png");
    CHECK(run_stokes("render " + sphere_scene + rest).err.empty());
    const std::string render = "render " + folder.file("s.json") + rest;
    put_file(folder.file("s.json"), edited_sphere_scene("\"material\": \"glow\", \"radius_mm\": 20",
                                                        "\"material\": \"glow\", \"radius_mm\": 3"));
    CHECK(run_stokes(render).err.find(": materials.glow: shape \"shape 1\" is thinner than its light reaches") !=
          std::string::npos);
    CHECK(run_stokes(render + " --transport walk").err.empty());
}

TEST_CASE("a scene that gives off more than it takes up is rendered with one warning", "[command line]") {
    const TemporaryFolder folder;
    put_file(folder.file("s.json"),
             edited_sphere_scene("\"fluorophores\": {",
                                 "\"fluorophores\": {\"glow\": {\"excitation\": 1, \"emission\": 1, "
                                 "\"conversion_per_nm\": 0.5}, "));
    const std::string render =
        "render " + folder.file("s.json") + small_render + "--quiet --png " + folder.file("a.png");
    CHECK(run_stokes(render).err.empty());
    const Outcome outcome = run_stokes(render + " --transport paper");
    CHECK(outcome.err == "stokes: warning: " + folder.file("s.json") +
                             ": fluorophores.glow: emits up to 266 times what it takes up (conversion_per_nm times the "
                             "sum of its emission)\n");
    CHECK(outcome.code == 0);
}

// Two white sheets with a lamp between them: a photon is stored some ten times, the map begins with one slot
// each.
TEST_CASE("a map that finds no memory to grow drops deposits, says so, and the ledger closes", "[command line]") {
    const TemporaryFolder folder;
    put_file(folder.file("s.json"), R"({"format": "stokes-scene", "version": 1,
        "camera": {"position_mm": [0, 20, 90], "target_mm": [0, 20, 0]},
        "materials": {"white": {"type": "diffuse", "reflectance": 0.95}},
        "shapes": [
            {"type": "rectangle", "material": "white", "width_mm": 200, "height_mm": 200},
            {"type": "rectangle", "material": "white", "width_mm": 200, "height_mm": 200, "transform":
             [{"rotate_axis": [1, 0, 0], "angle_deg": 180}, {"translate_mm": [0, 10, 0]}]}],
        "lights": [{"type": "sphere", "center_mm": [0, 5, 0], "radius_mm": 2, "power_W": 5,
                    "spectrum": {"constant": 1}}]})");
    const Outcome outcome =
        run_stokes("render " + folder.file("s.json") +
                   " --passes 2 --photons 60000 --size 24x16 --max-memory 0.06 --stats " + folder.file("a.json"));
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    const auto stats = nlohmann::json::parse(file_content(folder.file("a.json")));
    const std::uint64_t dropped = stats["dropped"]["map_full"];
    CHECK(dropped > 100000);
    CHECK(outcome.err.find("dropped: " + std::to_string(dropped) + " map_full of ") != std::string::npos);
    CHECK(imbalance(stats["ledger"]) < 1e-4);
    CHECK(stats["device_memory_bytes"] <= 0.06 * (1 << 30));
}
