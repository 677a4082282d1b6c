#include <csignal>
#include <nlohmann/json.hpp>

#include "host/core/csv_table.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_stokes.hpp"
#include "tests/support/running_stokes.hpp"

using namespace stokes;

namespace {

// The words of a render of more passes than anyone waits for.
std::vector<std::string> long_render(const std::vector<std::string>& extra) {
    std::vector<std::string> words = {"render",    sphere_scene, "--passes", "100000000",
                                      "--photons", "4000",       "--size",   "24x16"};
    words.insert(words.end(), extra.begin(), extra.end());
    return words;
}

}  // namespace

TEST_CASE("an interrupted render writes the passes it has", "[command line]") {
    const TemporaryFolder folder;
    RunningStokes render(long_render({"--stats", folder.file("a.json"), "--png", folder.file("a.png")}));
    REQUIRE(render.wait_for("remaining "));
    CHECK(render.press_ctrl_c());
    CHECK(render.end() == 130);
    CHECK(render.shown().find("preparing") < render.shown().find("pass "));
    CHECK(folder.names() == std::vector<std::string>{"a.json", "a.png"});
    const auto stats = nlohmann::json::parse(file_content(folder.file("a.json")));
    CHECK(stats["passes"] >= 1);
    CHECK(stats["passes"] < 100000000);
}

TEST_CASE("an interrupted or killed render leaves its error curve up to there", "[command line]") {
    const TemporaryFolder folder;
    const std::string reference = folder.file("r.exr"), csv = folder.file("e.csv");
    REQUIRE(run_stokes("render " + sphere_scene + small_render + "--quiet -o " + reference).code == 0);
    {
        RunningStokes render(
            long_render({"--rmse-against", reference, "--csv", csv, "--stats", folder.file("a.json")}));
        REQUIRE(render.wait_for("pass 3"));
        CHECK(render.press_ctrl_c());
        CHECK(render.end() == 130);
    }
    const CsvTable curve = read_csv(csv);
    REQUIRE(curve.lines.size() >= 3);
    CHECK(curve.values[0][0] == 1);
    CHECK(curve.values[0][1] == 2);
    CHECK(curve.values[0].back() == nlohmann::json::parse(file_content(folder.file("a.json")))["passes"]);
    {
        RunningStokes render(long_render({"--rmse-against", reference, "--csv", csv, "--every", "1", "--quiet"}));
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        // The curve of the render before is replaced by that of this one, which has every pass.
        for (CsvTable rows = curve; rows.lines.size() < 30 || rows.values[0][29] != 30.0; rows = read_csv(csv)) {
            if (std::chrono::steady_clock::now() > end) FAIL("no row after two minutes");
            ::usleep(1000);
        }
    }  // killed
    const CsvTable left = read_csv(csv);
    CHECK(left.lines.size() >= 30);
    CHECK(left.values[0].back() == static_cast<double>(left.lines.size()));
    CHECK(file_content(csv).back() == '\n');
}

// With no compiled kernels at hand, so that the signal falls into a build: the driver's linker must not die
// of it.
TEST_CASE("a render interrupted before its first pass says so and writes nothing", "[command line]") {
    const TemporaryFolder folder;
    for (const useconds_t delay_us : {0u, 300000u, 900000u}) {
        const TemporaryFolder cache;
        RunningStokes render(long_render({"--png", folder.file("a.png")}), {}, cache.path());
        REQUIRE(render.wait_for("preparing (compiling kernels ...)"));
        ::usleep(delay_us);
        CHECK(render.press_ctrl_c());
        CHECK(render.end() == 130);
        CAPTURE(delay_us, render.shown());
        CHECK(render.shown().find("stokes: interrupted before the first pass: nothing was written") !=
              std::string::npos);
        CHECK(render.shown().find("rror") == std::string::npos);
        CHECK(folder.names().empty());
    }
}

TEST_CASE("a quiet render says nothing", "[command line]") {
    const TemporaryFolder folder;
    const Outcome outcome =
        run_stokes("render " + sphere_scene + small_render + "--quiet --png " + folder.file("a.png"));
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
    CHECK(outcome.out.empty());
}
