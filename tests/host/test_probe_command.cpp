#include <nlohmann/json.hpp>

#include "host/core/csv_table.hpp"
#include "host/scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

const std::string few = " --photons 640 --device cpu ";
const std::string prisms = source_path("scenes/prisms.json");
const std::string components[] = {"specular", "single", "multiple", "fluorescence", "total"};

// Excitation and emission of a dye, each in a file of its own.
struct DyeFiles {
    explicit DyeFiles(const TemporaryFolder& folder) {
        put_file(folder.file("e.csv"), "# excitation\nwavelength_nm,E\n300,1\n450,0.8\n520,0\n");
        put_file(folder.file("f.csv"), "wavelength_nm,none,F\n400,0,0\n450,0,1\n520,0,0\n");
        flags = " --fraction 0.5 --excitation " + folder.file("e.csv") + " --emission " + folder.file("f.csv") + ":F ";
    }
    std::string flags;
};

nlohmann::json json_of(const std::string& path) { return nlohmann::json::parse(file_content(path)); }

}  // namespace

TEST_CASE("probe prints and writes what a material given by flags sends back", "[probe_command]") {
    const TemporaryFolder folder;
    const DyeFiles dye(folder);
    const std::string path = folder.file("probe.json");
    const Outcome run =
        run_stokes("probe --sigma-s 1.2 --sigma-a 0.1 --eta 1.5 --fresnel --quantum-yield 0.7" + dye.flags + few +
                   "--lambda 372 --angle 30 --seed 9 --step 10 --bins 7 --json " + path);
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    CHECK(run.err == "");
    CHECK_THAT(run.out, Contains("command line, conserving: 372 nm at 30 deg, 640 photons"));
    CHECK_THAT(run.out, Contains("fluorescence [1/nm]") && Contains("exitance [1/mm^2]") && Contains(path + "\n"));

    const nlohmann::json probe = json_of(path);
    CHECK(probe["model"] == "conserving");
    CHECK(probe["first_collision"] == false);
    CHECK(probe["lambda_ex_nm"] == 372);
    CHECK(probe["angle_deg"] == 30.0);
    CHECK(probe["photons"] == 640);
    CHECK(probe["seed"] == 9);
    CHECK(probe["step_nm"] == 10);
    const auto lambda = probe["lambda_nm"].get<std::vector<int>>();
    REQUIRE(lambda.size() == 50);
    CHECK(lambda[8] == 372);
    CHECK(probe["radial"]["r_mm"].size() == 8);
    CHECK(probe["radial"]["r_mm"][0] == 0.0);
    for (const std::string& component : components) {
        CAPTURE(component);
        double sum = 0.0;
        for (std::size_t i = 0; i < lambda.size(); ++i)
            sum += probe["reflectance"][component][i].get<double>() * (lambda[i] == 372 ? 1.0 : 10.0);
        CHECK(probe["totals"][component].get<double>() == Approx(sum).epsilon(1e-6));
        CHECK(probe["totals"][component].get<double>() > 0.0);
        CHECK(probe["totals_standard_error"][component].get<double>() > 0.0);
        CHECK(probe["standard_error"][component].size() == 50);
        if (component == "specular") continue;
        CHECK(probe["radial"][component].size() == 7);
        CHECK(probe["radial_standard_error"][component].size() == 7);
        CHECK(probe["beyond"].contains(component));
    }
}

TEST_CASE("probe takes materials and model from a scene", "[probe_command]") {
    const TemporaryFolder folder;
    const std::string path = folder.file("probe.json");
    const std::string scene = "probe " + prisms + " --material \"qdot545 subsurface\" --quiet --json " + path + few;
    REQUIRE(run_stokes(scene).code == 0);
    CHECK(json_of(path)["model"] == "paper");
    CHECK(json_of(path)["material"] == "qdot545 subsurface");
    const Outcome walk = run_stokes(scene + "--model walk --first-collision");
    REQUIRE(walk.code == 0);
    CHECK(walk.out == "");
    CHECK(json_of(path)["model"] == "walk");
    CHECK(json_of(path)["first_collision"] == true);
    const nlohmann::json surface = [&] {
        REQUIRE(run_stokes("probe " + prisms + " --material \"qdot655 surface\" --json " + path + few).code == 0);
        return json_of(path);
    }();
    CHECK(surface["totals"]["fluorescence"].get<double>() > 0.0);
    CHECK(surface["totals"]["single"] == 0.0);
}

// The medium of the scene's prisms, by flags.
TEST_CASE("probe measures the same by flags and by scene", "[probe_command]") {
    const TemporaryFolder folder;
    const std::string tables = source_path("tables/");
    put_file(folder.file("scene.json"),
             R"({"format": "stokes-scene", "version": 1, "camera": {"position_mm": [0, 9, 9], "target_mm": [0, 0, 0]},
                 "media": {"marble": {"sigma_s_per_mm": {"file": ")" +
                 tables + R"(media/marble_spectral_model.csv",
                                      "column": "ss_lin"}, "sigma_a_per_mm": 0.25, "eta": 1.5}},
                 "fluorophores": {"dot": {"excitation": 0.5, "quantum_yield": 0.75,
                    "emission": {"file": ")" +
                 tables + R"(fluorophores/qdot545_model.csv", "column": "emission"}}},
                 "materials": {"stone": {"type": "translucent", "medium": "marble", "fluorophore": "dot",
                                         "fluorescent_fraction": 0.25, "fresnel": true}},
                 "lights": [{"type": "beam", "section": "disk", "position_mm": [0, 9, 0], "direction": [0, -1, 0],
                             "radius_mm": 1, "irradiance_W_m2": 10, "spectrum": 1}],
                 "shapes": [{"type": "sphere", "radius_mm": 5, "material": "stone"}]})");
    const std::string scene_json = folder.file("a.json"), flags_json = folder.file("b.json");
    const Outcome scene =
        run_stokes("probe " + folder.file("scene.json") + " --material stone --json " + scene_json + few);
    CAPTURE(scene.err);
    REQUIRE(scene.code == 0);
    REQUIRE(run_stokes("probe --sigma-s " + tables +
                       "media/marble_spectral_model.csv --sigma-a 0.25 --eta 1.5 --fresnel "
                       "--fraction 0.25 --excitation 0.5 --quantum-yield 0.75 --emission " +
                       tables + "fluorophores/qdot545_model.csv:emission --json " + flags_json + few)
                .code == 0);
    nlohmann::json a = json_of(scene_json), b = json_of(flags_json);
    CHECK(a["material"] == "stone");
    CHECK(b["material"] == "command line");
    a.erase("material");
    b.erase("material");
    CHECK((a == b));
}

TEST_CASE("probe writes the effective re-radiation matrix", "[probe_command]") {
    const TemporaryFolder folder;
    const DyeFiles dye(folder);
    const std::string path = folder.file("matrix.csv");
    const Outcome run = run_stokes("probe --sigma-s 1 --sigma-a 0.1" + dye.flags + few +
                                   "--step 20 --lambda-min 340 --lambda-max 560 --matrix " + path);
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    CHECK_THAT(run.err, Contains("50 %\n") && Contains("100 %\n"));
    const CsvTable matrix = read_csv(path);
    REQUIRE(matrix.columns.size() == 14);
    CHECK(matrix.columns[0] == "lambda_ex_nm");
    CHECK(matrix.columns[1] == "elastic");
    CHECK(matrix.columns[2] == "340");
    REQUIRE(matrix.values[0].size() == 12);
    for (std::size_t ex = 0; ex < 12; ++ex) {
        const double lambda_ex = 340.0 + 20.0 * static_cast<double>(ex);
        CHECK(matrix.values[0][ex] == lambda_ex);
        CHECK(matrix.values[1][ex] > 0.0);
        CHECK(matrix.values[1][ex] < 1.0);
        for (std::size_t em = 0; em < 12; ++em) {
            const double lambda_em = 340.0 + 20.0 * static_cast<double>(em);
            CAPTURE(lambda_ex, lambda_em);
            // At the nanometres from -9 to +10 about lambda_em, between 400 and 520 nm and above lambda_ex.
            const bool emits =
                lambda_em + 10.0 > std::max(lambda_ex, 400.0) && lambda_em - 9.0 < 520.0 && lambda_ex < 520.0;
            CHECK((matrix.values[2 + em][ex] > 0.0) == emits);
        }
    }
    CHECK(run_stokes("probe --sigma-s 1 --sigma-a 0.1 --quiet --matrix " + path + few +
                     "--step 50 --lambda-min 400 --lambda-max 500")
              .err == "");
}

TEST_CASE("probe gives the same bits whatever the number of threads", "[probe_command]") {
    const TemporaryFolder folder;
    const DyeFiles dye(folder);
    std::string first;
    for (const char* threads : {"1", "2"}) {
        const std::string path = folder.file(threads);
        REQUIRE(run_stokes("probe --sigma-s 1 --sigma-a 0.1 --model walk" + dye.flags + few + "--threads " + threads +
                           " --json " + path)
                    .code == 0);
        if (first.empty()) first = file_content(path);
        CHECK(file_content(path) == first);
    }
}

// A table without a line of names, or with that line behind #, loses no row, and a table in um is that in nm.
TEST_CASE("probe reads tables of any dialect alike", "[probe_command]") {
    const TemporaryFolder folder;
    put_file(folder.file("names.csv"), "wavelength_nm,sigma_s\n300,5\n400,1\n800,1\n");
    put_file(folder.file("none.csv"), "300,5\n400,1\n800,1\n");
    put_file(folder.file("hash.csv"), "# wavelength_nm,sigma_s\n300,5\n400,1\n800,1\n");
    put_file(folder.file("commas.csv"), "nm;sigma_s\n300,0;5,0\n400,0;1,0\n800,0;1,0\n");
    put_file(folder.file("um.csv"), "w,sigma_s\n0.3,5\n0.4,1\n0.8,1\n");
    std::string first;
    for (const std::string file :
         {"names.csv", "none.csv", "none.csv:2", "hash.csv:sigma_s", "commas.csv", "um.csv --wavelength-unit um"}) {
        CAPTURE(file);
        const std::string json = folder.file("q.json");
        const Outcome run = run_stokes("probe --sigma-a 0.1 --lambda 320 --quiet --sigma-s " + folder.file(file) + few +
                                       "--json " + json);
        CAPTURE(run.err);
        REQUIRE(run.code == 0);
        if (first.empty()) first = file_content(json);
        CHECK(file_content(json) == first);
        CHECK(run.err == "");
    }
}

TEST_CASE("probe says in one line what it cannot do", "[probe_command]") {
    const TemporaryFolder folder;
    const DyeFiles dye(folder);
    const std::string medium = "--sigma-s 1 --sigma-a 0 ";
    put_file(folder.file("bad.csv"), "wavelength_nm,a\n300,1\n400,-2\n");
    put_file(folder.file("um.csv"), "w,a\n0.3,5\n0.4,1\n0.8,1\n");
    put_file(folder.file("noise.csv"), "wavelength_nm,a\n300,-0.01\n400,1\n");
    put_file(folder.file("high.csv"), "wavelength_nm,a\n300,1\n400,1.5\n");
    put_file(folder.file("dark.csv"), "wavelength_nm,a\n300,0\n400,0\n");
    struct {
        std::string arguments, expected;
    } const cases[] = {
        {"", "expected a scene and --material, or a material by --sigma-s and --sigma-a"},
        {prisms, "expected --material, a name in " + prisms},
        {prisms + " --material x --eta 1.5", "expected a scene or the material by flags, not both"},
        {prisms + " --material x", "no material \"x\"; translucent are: qdot545 subsurface"},
        {prisms + " --material white", "material \"white\" is not translucent"},
        {"--material x --sigma-s 1 --sigma-a 1", "--material: expected a scene that has it"},
        {folder.file("none.json") + " --material x", "none.json: cannot read"},
        {"--sigma-s 1", "--sigma-s: expected --sigma-a as well"},
        {"--eta 1.5", "expected --sigma-s and --sigma-a"},
        {"--sigma-s 0 --sigma-a 0", "expected a sum in [1e-09, 1e+09] 1/mm from 300 to 830 nm, got 0 at 300 nm"},
        {"--sigma-s -1 --sigma-a 2", "--sigma-s: expected a number in [0, 1e+12], got -1"},
        {"--sigma-s nan --sigma-a 2", "--sigma-s: expected a number in"},
        {"--sigma-s 1 --sigma-a " + folder.file("none.csv"), "--sigma-a: " + folder.file("none.csv") + ": cannot read"},
        {"--sigma-s 1 --sigma-a " + folder.file("bad.csv"), "bad.csv:3: a: expected no negative value, got -2"},
        {"--sigma-s 1 --sigma-a " + folder.file("e.csv") + ":x", "e.csv: no column \"x\"; expected one of: E"},
        {medium + "--eta 0.9", "--eta: expected a number, 1 to 4"},
        {medium + "--fraction 0.5", "--fraction: expected --emission as well"},
        {medium + "--stokes-rule truncate", "--stokes-rule: expected --fraction, --excitation and --emission as well"},
        {medium + "--wavelength-unit mm", "--wavelength-unit"},
        {"--sigma-s 1 --sigma-a " + folder.file("e.csv") + " --per unit", "--per: expected --fraction"},
        {medium + "--fraction 1 --excitation 1 --emission 1 --per unit", "--per: expected a file in --emission"},
        {"--sigma-s 1 --sigma-a " + folder.file("um.csv"),
         "um.csv: expected wavelengths from 300 to 830 nm, got 0.3 to 0.8 nm; if they are in um"},
        {"--sigma-s 1 --sigma-a " + folder.file("noise.csv") + " --negative refuse",
         "noise.csv:2: a: expected no negative value, got -0.01"},
        {medium + "--quantum-yield 0.5", "--quantum-yield: expected --fraction, --excitation and --emission as well"},
        {medium + dye.flags + "--quantum-yield 1.1", "--quantum-yield: expected a number, 0 to 1"},
        {medium + "--fraction 1 --excitation " + folder.file("high.csv") + " --emission 1",
         "--excitation: expected values in [0, 1], got 1.5"},
        {medium + "--fraction 1 --excitation 1 --emission " + folder.file("dark.csv"), "--emission: expected some"},
        {medium + "--model exact", "--transport: expected \"paper\", \"conserving\" or \"walk\", got \"exact\""},
        {medium + "--first-collision", "--first-collision: expected transport \"walk\", got \"conserving\""},
        {medium + "--angle 90", "--angle: expected a number, 0 to 89.9"},
        {medium + "--lambda 299", "--lambda"},
        {medium + "--lambda 365.5", "--lambda"},
        {medium + "--photons 10", "--photons: expected a number, 64"},
        {medium + "--lambda-min 500 --lambda-max 510", "expected a range of at least 16 whole nanometres"},
        {medium + "--json " + folder.path() + "/none/x.json", "none"},
        {medium + "--json " + folder.file("x") + " --matrix " + folder.file("x"), "another file for each output"},
    };
    const std::vector<std::string> before = folder.names();
    for (const auto& c : cases) {
        CAPTURE(c.arguments);
        const Outcome run = run_stokes("probe " + c.arguments);
        CHECK(run.code == 2);
        CHECK(run.out == "");
        CHECK_THAT(run.err, Contains(c.expected));
        CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
    }
    CHECK(folder.names() == before);
}

TEST_CASE("the guide to commands names every key of the probe's JSON", "[probe_command]") {
    const TemporaryFolder folder;
    REQUIRE(run_stokes("probe --sigma-s 1 --sigma-a 1 --json " + folder.file("a.json") + few).code == 0);
    const std::string guide = file_content(source_path("scenes/COMMANDS.md"));
    const nlohmann::json probe = json_of(folder.file("a.json"));
    for (const auto& item : probe.items()) {
        CAPTURE(item.key());
        CHECK(guide.find('`' + item.key() + '`') != std::string::npos);
    }
}
