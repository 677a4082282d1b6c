#include <nlohmann/json.hpp>

#include "host/core/error.hpp"
#include "host/subsurface/power_table.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;
using Json = nlohmann::json;

namespace {

PowerTable sample_table(bool multiple = false) {
    const Spectrum sigma_s{{300.0, 795.0}, {1.3, 0.7}, Outside::hold};
    const MediumSpectra medium{"jelly \"A\"", sigma_s, Spectrum::constant(0.0041), 1.5, 1.0};
    TableGrid grid;
    grid.r_mm = {0.0, 0.1, 0.7};
    grid.theta_deg = {0.0, 45.0, 89.1};
    grid.lambda_nm = {300.0, 555.5};
    return multiple ? make_multiple_table(medium, grid) : make_single_table(medium, grid);
}

}  // namespace

TEST_CASE("a table's file has the published keys, and every bit of the numbers", "[power_table_json]") {
    const TemporaryFolder folder;
    for (const bool multiple : {false, true}) {
        const PowerTable table = sample_table(multiple);
        write_power_table(table, folder.file("t.json"));
        const Json json = Json::parse(file_content(folder.file("t.json")));
        CHECK(json["format"] == "photon-power-table");
        CHECK(json["version"] == 1);
        CHECK(json["model"] == "paper");
        CHECK(json["component"] == (multiple ? "multiple" : "single"));
        CHECK(json["medium"]["name"] == "jelly \"A\"");
        CHECK(json["medium"]["sigma_s"].get<std::vector<double>>() == table.medium.sigma_s);
        CHECK(json["medium"]["sigma_a"].get<std::vector<double>>() == table.medium.sigma_a);
        CHECK(json["medium"]["eta"] == 1.5);
        CHECK(json["medium"]["dipole_eta"] == 1.0);
        REQUIRE(json["axes"].size() == (multiple ? 2 : 3));
        for (std::size_t i = 0; i < table.axes.size(); ++i) {
            CHECK(json["axes"][i]["name"] == table.axes[i].name);
            CHECK(json["axes"][i]["unit"] == table.axes[i].unit);
            CHECK(json["axes"][i]["values"].get<std::vector<double>>() == table.axes[i].values);
        }
        CHECK(json["axes"][0]["name"] == "r");
        CHECK(json["unit"] == (multiple ? "1/mm^2" : "1"));
        CHECK(json["values"].size() == (multiple ? 6 : 18));
        CHECK(json["values"].get<std::vector<double>>() == table.values);
    }
    CHECK(folder.names() == std::vector<std::string>{"t.json"});
}

TEST_CASE("a table that cannot be written leaves nothing behind", "[power_table_json]") {
    const TemporaryFolder folder;
    {
        const FullDisk full(100);
        CHECK_THROWS_AS(write_power_table(sample_table(), folder.file("t.json")), RunError);
    }
    CHECK(folder.names().empty());
}
