#include <nlohmann/json.hpp>

#include "tests/support/catch.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;

TEST_CASE("--no-tables renders model paper without tables, and says so", "[no_tables]") {
    const TemporaryFolder folder;
    for (const bool tables : {true, false}) {
        const std::string file = folder.file(tables ? "with.json" : "without.json");
        const Outcome outcome = run_stokes("render " + sphere_scene + small_render + "--quiet --transport paper " +
                                           (tables ? "" : "--no-tables ") + "--stats " + file);
        CAPTURE(outcome.err);
        REQUIRE(outcome.code == 0);
        const auto stats = nlohmann::json::parse(file_content(file));
        CHECK(stats["tables"] == tables);
        CHECK(stats["stages"].contains("resample_table") == tables);
        CHECK(stats["stages"].contains("integrate_power") == !tables);
    }
}

TEST_CASE("--no-tables is refused with the other models", "[no_tables]") {
    const TemporaryFolder folder;
    for (const std::string transport : {"conserving", "walk"}) {
        const Outcome outcome = run_stokes("render " + sphere_scene + small_render + "--no-tables --transport " +
                                           transport + " --stats " + folder.file("a.json"));
        CHECK(outcome.code == 2);
        CHECK(outcome.err == "stokes: --no-tables: expected transport \"paper\", got \"" + transport + "\"\n");
        CHECK(folder.names().empty());
    }
}
