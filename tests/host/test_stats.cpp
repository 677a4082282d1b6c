#include <limits>
#include <nlohmann/json.hpp>

#include "host/core/error.hpp"
#include "host/render/stats.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;

namespace {

RenderStats example() {
    RenderStats stats;
    stats.scene = "scenes/prisms.json";
    stats.device = "pthread-cpu";
    stats.driver = "3.1";
    stats.ray_kernel = "avx2";
    stats.transport = "walk";
    stats.tables = false;
    stats.wavelengths = "importance";
    stats.branches = "both";
    stats.distances = "importance";
    stats.emission = "aimed";
    stats.direct = "rays";
    stats.radii = "one";
    stats.exits = 3;
    stats.passes = 12;
    stats.seed = 4000000000u;
    stats.width = 640;
    stats.height = 360;
    stats.wall_s = 2.5;
    stats.processor_s = 4.75;
    stats.trials_processor_s = 0.375;
    stats.photons_emitted = 12000000000ull;  // beyond 32 bits
    stats.rays_traced = 50;
    stats.deposits = 7;
    stats.stages = {{"emit_photons", 0.125}, {"trace_closest", 1.0 / 3.0}};
    stats.dropped = {{"missed_exit", 3}, {"map_full", 0}};
    stats.ledger.power.emitted = 2.0;
    stats.ledger.power.absorbed = 1.5;
    stats.ledger.power.stokes_loss = 0.25;
    stats.ledger.power.escaped = 0.125;
    stats.ledger.power.dropped = 0.0625;
    stats.ledger.power.roulette = 0.0625;
    stats.ledger.power.stored = 9.0;
    stats.ledger.photons.emitted = 3e18;
    stats.ledger.photons.absorbed = 2e18;
    stats.ledger.photons.escaped = 1e18;
    stats.ledger.paths = 10;
    stats.ledger.escaped_paths = 4;
    stats.radius_first_mm = 0.1;
    stats.radius_last_mm = 1e-7;
    return stats;
}

nlohmann::json written(const RenderStats& stats) {
    const TemporaryFolder folder;
    write_stats(stats, folder.file("stats.json"));
    return nlohmann::json::parse(file_content(folder.file("stats.json")));
}

}  // namespace

TEST_CASE("the statistics hold every figure under its name", "[stats]") {
    const nlohmann::json json = written(example());
    CHECK(json.at("passes") == 12);
    CHECK(json.at("transport") == "walk");
    CHECK(json.at("ray_kernel") == "avx2");
    CHECK(json.at("tables") == false);
    CHECK(json.at("wavelengths") == "importance");
    CHECK(json.at("branches") == "both");
    CHECK(json.at("distances") == "importance");
    CHECK(json.at("emission") == "aimed");
    CHECK(json.at("direct") == "rays");
    CHECK(json.at("radii") == "one");
    CHECK(json.at("exits") == 3);
    CHECK(json.at("seed") == 4000000000u);
    CHECK(json.at("wall_s") == 2.5);
    CHECK(json.at("processor_s") == 4.75);
    CHECK(json.at("trials_processor_s") == 0.375);
    CHECK(json.at("photons_emitted") == 12000000000ull);
    CHECK(json.at("photons_per_second") == 4.8e9);
    CHECK(json.at("rays_traced") == 50);
    CHECK(json.at("rays_per_second") == 20.0);
    CHECK(json.at("device") == "pthread-cpu");
    CHECK(json.at("radius_first_mm") == 0.1);
    CHECK(json.at("radius_last_mm") == 1e-7);
    CHECK(json.at("stages").size() == 2);
    CHECK(json.at("stages").at("trace_closest") == 1.0 / 3.0);  // every digit
    CHECK(json.at("dropped").at("missed_exit") == 3);
    CHECK(json.at("dropped").at("map_full") == 0);
    const nlohmann::json& ledger = json.at("ledger");
    CHECK(ledger.at("emitted") == 2.0);
    CHECK(ledger.at("absorbed") == 1.5);
    CHECK(ledger.at("stokes_loss") == 0.25);
    CHECK(ledger.at("stored") == 9.0);
    CHECK(ledger.at("escaped") == 0.125);
    CHECK(ledger.at("imbalance") == 0.0);
    CHECK(json.at("ledger_photons").at("emitted") == 3e18);
    CHECK(json.at("ledger_photons").at("imbalance") == 0.0);
    CHECK(json.at("paths").at("emitted") == 10);
    CHECK(json.at("paths").at("escaped") == 4);
}

TEST_CASE("statistics of nothing are still JSON", "[stats]") {
    const nlohmann::json json = written(RenderStats{});
    CHECK(json.at("photons_per_second") == 0.0);
    CHECK(json.at("stages").empty());
    CHECK(json.at("tables") == true);
    CHECK(json.at("dropped").empty());
}

TEST_CASE("a figure that is not a number is null", "[stats]") {
    RenderStats stats = example();
    stats.ledger.power.emitted = std::numeric_limits<double>::quiet_NaN();
    stats.stages["broken"] = std::numeric_limits<double>::infinity();
    const nlohmann::json json = written(stats);
    CHECK(json.at("ledger").at("emitted").is_null());
    CHECK(json.at("stages").at("broken").is_null());
}

TEST_CASE("names come back as they were, whatever they hold", "[stats]") {
    std::string name = "a \"b\" c\\d/\u00e9\u20ac \x7f";
    for (char c = 1; c < 0x20; ++c) name += c;
    RenderStats stats = example();
    stats.scene = stats.device = stats.driver = name;
    stats.stages = {{name, 1.0}};
    stats.dropped = {{name, 1}};
    const nlohmann::json json = written(stats);
    for (const char* key : {"scene", "device", "driver"}) CHECK(json.at(key) == name);
    CHECK(json.at("stages").at(name) == 1.0);
    CHECK(json.at("dropped").at(name) == 1);
}

TEST_CASE("statistics that cannot be written are an error and leave nothing", "[stats]") {
    const TemporaryFolder folder;
    CHECK_THROWS_AS(write_stats(example(), folder.file("absent/stats.json")), RunError);
    CHECK(folder.names().empty());
}
