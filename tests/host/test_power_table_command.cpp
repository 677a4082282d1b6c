#include <nlohmann/json.hpp>
#include <string>

#include "host/subsurface/power_table.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_stokes.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

Outcome run_tables(const std::string& scene, const std::string& folder) {
    return run_stokes("tables \"" + scene + "\" -o \"" + folder + "\"");
}

const std::string camera = R"({"format": "stokes-scene", "version": 1,
  "camera": {"position_mm": [0, 60, 130], "target_mm": [0, 16, 0]},)";
const std::string lamp_and_box = R"("lights": [{"type": "disk", "center_mm": [0, 90, 0], "normal": [0, -1, 0],
  "radius_mm": 5, "power_W": 1, "spectrum": 1}], "shapes": [{"type": "sphere", "material": "jelly", "radius_mm": 5}]})";

}  // namespace

TEST_CASE("stokes tables writes the three tables of each translucent material", "[power_table_command]") {
    const TemporaryFolder work;
    put_file(work.file("jelly.json"),
             camera +
                 R"("media": {"gel": {"sigma_s_per_mm": 0.8, "sigma_a_per_mm": 0.1, "eta": 1.4, "dipole_eta": 1.4}},
               "materials": {"jelly": {"type": "translucent", "medium": "gel"}},)" +
                 lamp_and_box);
    const std::string folder = work.file("new/tables");
    const Outcome run = run_tables(work.file("jelly.json"), folder);
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    const MediumSpectra gel{"gel", Spectrum::constant(0.8), Spectrum::constant(0.1), 1.4, 1.4};
    for (const PowerTable& expected :
         {make_fluorescence_table(gel), make_single_table(gel), make_multiple_table(gel)}) {
        const std::string path = folder + "/jelly." + expected.component + ".json";
        CHECK_THAT(run.out, Contains(path + "\n"));
        const auto written = nlohmann::json::parse(file_content(path));
        CHECK(written["component"] == expected.component);
        CHECK(written["medium"]["name"] == "gel");
        CHECK(written["medium"]["dipole_eta"] == 1.4);
        CHECK((written["values"].get<std::vector<double>>() == expected.values));
    }
}

TEST_CASE("stokes tables ends with 2 for scenes it cannot use and 1 for folders it cannot make",
          "[power_table_command]") {
    const TemporaryFolder work;
    put_file(work.file("plain.json"), camera + R"("materials": {"jelly": {"type": "black"}},)" + lamp_and_box);
    const Outcome plain = run_tables(work.file("plain.json"), work.file("t"));
    CHECK(plain.code == 2);
    CHECK_THAT(plain.err, Contains("no translucent material"));
    CHECK(run_tables(work.file("none.json"), work.file("t")).code == 2);

    put_file(work.file("clear.json"), camera +
                                          R"("media": {"void": {"sigma_s_per_mm": 0, "sigma_a_per_mm": 0, "eta": 1.4}},
               "materials": {"jelly": {"type": "translucent", "medium": "void"}},)" +
                                          lamp_and_box);
    const Outcome clear = run_tables(work.file("clear.json"), work.file("t"));
    CHECK(clear.code == 2);
    CHECK_THAT(clear.err, Contains("void"));
    CHECK(work.names() == std::vector<std::string>{"clear.json", "plain.json"});

    put_file(work.file("jelly.json"),
             camera + R"("media": {"gel": {"sigma_s_per_mm": 0.8, "sigma_a_per_mm": 0.1, "eta": 1.4}},
               "materials": {"jelly": {"type": "translucent", "medium": "gel"}},)" +
                 lamp_and_box);
    put_file(work.file("t"), "a file");
    CHECK(run_tables(work.file("jelly.json"), work.file("t")).code == 1);
}
