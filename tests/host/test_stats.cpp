#include <limits>
#include <nlohmann/json.hpp>

#include "host/core/error.hpp"
#include "host/render/stats.hpp"
#include "host/scene/settings/settings.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;

namespace {

RenderStats example() {
    RenderStats stats;
    stats.settings = resolved({});
    stats.ray_kernel = "avx2";
    stats.wall_s = 2.5;
    stats.processor_s = 4.75;
    stats.trials_processor_s = 0.375;
    stats.photons_emitted = 12000000000ull;  // beyond 32 bits
    stats.rays_traced = 50;
    stats.stages = {{"trace_closest", 1.0 / 3.0}};
    stats.ledger.power.emitted = 2.0;
    stats.ledger.power.absorbed = 1.5;
    stats.ledger.power.escaped = 0.25;
    stats.ledger.photons.emitted = 3e18;
    stats.ledger.photons.absorbed = 1e18;
    stats.ledger.paths = 10;
    stats.ledger.escaped_paths = 4;
    return stats;
}

nlohmann::json written(const RenderStats& stats) {
    const TemporaryFolder folder;
    write_stats(stats, folder.file("stats.json"));
    return nlohmann::json::parse(file_content(folder.file("stats.json")));
}

}  // namespace

TEST_CASE("the statistics hold what follows from the figures, to every digit", "[stats]") {
    const nlohmann::json json = written(example());
    CHECK(json.at("photons_emitted") == 12000000000ull);
    CHECK(json.at("photons_per_second") == 4.8e9);  // 12e9 in 2.5 s
    CHECK(json.at("rays_per_second") == 20.0);      // 50 in 2.5 s
    CHECK(json.at("stages").at("trace_closest") == 1.0 / 3.0);
    CHECK(json.at("ledger").at("imbalance") == 0.125);                                    // 2 - 1.5 - 0.25, of 2
    CHECK(json.at("ledger_photons").at("imbalance").get<double>() == Approx(2.0 / 3.0));  // 3 - 1, of 3
}

// Scripts and people read these by name.
TEST_CASE("figures stand under their own names", "[stats]") {
    const nlohmann::json json = written(example());
    CHECK(json.at("ray_kernel") == "avx2");
    CHECK(json.at("wall_s") == 2.5);
    CHECK(json.at("processor_s") == 4.75);
    CHECK(json.at("trials_processor_s") == 0.375);
    CHECK(json.at("rays_traced") == 50);
    CHECK(json.at("ledger").at("absorbed") == 1.5);
    CHECK(json.at("ledger").at("escaped") == 0.25);
    CHECK(json.at("ledger_photons").at("absorbed") == 1e18);
    CHECK(json.at("paths").at("emitted") == 10);
    CHECK(json.at("paths").at("escaped") == 4);
}

TEST_CASE("the statistics hold every setting by its key, with the value that was rendered", "[stats]") {
    RenderStats stats = example();
    for (const Setting& setting : settings()) {
        INFO(setting.key);
        const bool only_the_scene_knows = setting.key == "radius_mm" || setting.key == "exposure_ev";
        CHECK(written(stats).contains(setting.key) == !only_the_scene_knows);
    }
    RenderSettings given;
    given.transport = Transport::paper;
    given.tables = false;
    given.distances = Distances::importance;  // nothing without tables
    given.seed = 4000000000u;                 // beyond 31 bits
    given.radius_mm = 0.1;
    stats.settings = resolved(given);
    stats.film.exposure_ev = -1.5;
    const nlohmann::json json = written(stats);
    CHECK(json.at("transport") == "paper");
    CHECK(json.at("tables") == false);
    CHECK(json.at("distances") == "table");
    CHECK(json.at("wavelengths") == "uniform");  // the default of transport paper
    CHECK(json.at("seed") == 4000000000u);
    CHECK(json.at("radius_mm") == 0.1);
    CHECK(json.at("exposure_ev") == -1.5);
}

TEST_CASE("statistics of nothing are still JSON", "[stats]") {
    const nlohmann::json json = written(RenderStats{});
    CHECK(json.at("photons_per_second") == 0.0);
    CHECK(json.at("stages").empty());
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
