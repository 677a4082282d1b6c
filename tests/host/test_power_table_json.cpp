#include <functional>
#include <nlohmann/json.hpp>

#include "host/core/error.hpp"
#include "host/subsurface/power_table_json.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;
using Catch::Matchers::Contains;
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

void check_equal(const PowerTable& a, const PowerTable& b) {
    CHECK(a.model == b.model);
    CHECK(a.component == b.component);
    CHECK(a.unit == b.unit);
    CHECK(a.medium.name == b.medium.name);
    CHECK(a.medium.sigma_s == b.medium.sigma_s);
    CHECK(a.medium.sigma_a == b.medium.sigma_a);
    CHECK(a.medium.eta == b.medium.eta);
    CHECK(a.medium.dipole_eta == b.medium.dipole_eta);
    REQUIRE(a.axes.size() == b.axes.size());
    for (std::size_t i = 0; i < a.axes.size(); ++i) {
        CHECK(a.axes[i].name == b.axes[i].name);
        CHECK(a.axes[i].unit == b.axes[i].unit);
        CHECK(a.axes[i].values == b.axes[i].values);
    }
    CHECK(a.values == b.values);
}

// Reads the sample table after a change to its JSON.
void read_changed(const std::function<void(Json&)>& change) {
    const TemporaryFolder folder;
    const std::string path = folder.file("t.json");
    write_power_table(sample_table(), path);
    Json json = Json::parse(file_content(path));
    change(json);
    put_file(path, json.dump());
    read_power_table(path);
}

}  // namespace

TEST_CASE("a table read back is the table written, bit for bit", "[power_table_json]") {
    const TemporaryFolder folder;
    for (bool multiple : {false, true}) {
        const PowerTable table = sample_table(multiple);
        write_power_table(table, folder.file("t.json"));
        check_equal(read_power_table(folder.file("t.json")), table);
    }
    CHECK(folder.names() == std::vector<std::string>{"t.json"});
}

TEST_CASE("the file has the published keys", "[power_table_json]") {
    const TemporaryFolder folder;
    write_power_table(sample_table(), folder.file("t.json"));
    const Json json = Json::parse(file_content(folder.file("t.json")));
    CHECK(json["format"] == "photon-power-table");
    CHECK(json["version"] == 1);
    CHECK(json["model"] == "paper");
    CHECK(json["component"] == "single");
    CHECK(json["medium"]["name"] == "jelly \"A\"");
    CHECK(json["medium"]["sigma_s"].size() == 2);
    CHECK(json["medium"]["sigma_a"].size() == 2);
    CHECK(json["medium"]["eta"] == 1.5);
    REQUIRE(json["axes"].size() == 3);
    CHECK(json["axes"][0]["name"] == "r");
    CHECK(json["axes"][1]["unit"] == "deg");
    CHECK(json["axes"][2]["values"] == Json({300.0, 555.5}));
    CHECK(json["unit"] == "1");
    CHECK(json["values"].size() == 18);
}

TEST_CASE("a table with a fault is refused with file and key", "[power_table_json]") {
    const auto complaint = [](const std::string& words) { return Contains("t.json: " + words); };
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["format"] = "mesh"; }), complaint("format: expected"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j.erase("format"); }), complaint("format: expected"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["version"] = 2; }), complaint("version: expected 1"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["model"] = "magic"; }),
                      complaint("model: expected one of \"paper\""));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["component"] = "triple"; }),
                      complaint("component: expected one of"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["unit"] = "mm"; }), complaint("unit: expected \"1\""));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["axes"].erase(1); }), complaint("axes: expected a list of 3"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["axes"][1] = 7; }), complaint("axes[1]: expected an object"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["axes"][0]["name"] = "rho"; }), complaint("axes[0].name"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["axes"][0]["unit"] = "m"; }), complaint("axes[0].unit"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["axes"][0]["values"][2] = 0.1; }),
                      complaint("axes[0].values[2]: expected strictly increasing"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["axes"][2]["values"] = Json::array(); }),
                      complaint("axes[2].values"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["medium"].erase("sigma_a"); }), complaint("medium.sigma_a"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["medium"]["sigma_s"].push_back(1); }), complaint("medium.sigma_s"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["medium"]["eta"] = "glass"; }), complaint("medium.eta"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["values"].push_back(0.0); }),
                      complaint("values: expected a list of 18 numbers, found 19"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["values"][4] = -1e-9; }), complaint("values[4]: expected"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j["values"][5] = nullptr; }), complaint("values[5]: expected"));
    CHECK_THROWS_WITH(read_changed([](Json& j) { j = Json::array(); }), complaint("expected an object"));
}

TEST_CASE("files that are no JSON, or not there, are refused in one line", "[power_table_json]") {
    const TemporaryFolder folder;
    CHECK_THROWS_WITH(read_power_table(folder.file("none.json")), Contains("none.json: cannot open"));
    put_file(folder.file("cut.json"), "{\"format\":\n\"photon-power-table\",\n");
    CHECK_THROWS_WITH(read_power_table(folder.file("cut.json")), Contains("cut.json:3: not valid JSON"));
    put_file(folder.file("huge.json"), "{\"values\": [1e999]}");
    CHECK_THROWS_AS(read_power_table(folder.file("huge.json")), InputError);
    CHECK_THROWS_AS(read_power_table(folder.path()), InputError);
}

TEST_CASE("a table that cannot be written leaves nothing behind", "[power_table_json]") {
    const TemporaryFolder folder;
    {
        const FullDisk full(100);
        CHECK_THROWS_AS(write_power_table(sample_table(), folder.file("t.json")), RunError);
    }
    CHECK(folder.names().empty());
}
