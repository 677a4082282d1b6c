#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "host/image/compare.hpp"
#include "host/image/error_map.hpp"
#include "host/image/exr.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

// Grey light, of the same XYZ / (0.95, 1, 1.09) in every layer; a quarter of it in each.
FilmImage grey(int width, int height, float luminance) {
    FilmImage film(width, height);
    for (std::vector<float>& layer : film.xyz)
        for (std::size_t i = 0; i < layer.size(); i += 3) {
            layer[i] = 0.95f * luminance / 4;
            layer[i + 1] = luminance / 4;
            layer[i + 2] = 1.09f * luminance / 4;
        }
    return film;
}

// R, G, B alone.
void write_plain(const std::string& path, int width, int height) {
    Imf::Header header(width, height);
    std::vector<float> values(static_cast<std::size_t>(width * height), 1.0f);
    Imf::FrameBuffer frame;
    for (const char* name : {"R", "G", "B"}) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        frame.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float),
                                      sizeof(float) * static_cast<std::size_t>(width)));
    }
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(height);
}

struct Pictures {
    TemporaryFolder folder;
    std::string a = folder.file("a.exr"), b = folder.file("b.exr");
    FilmImage film = grey(4, 3, 110.0f);
    Pictures() {
        write_exr(a, film, {});
        write_exr(b, grey(4, 3, 100.0f), {});
    }
    Outcome compare(const std::string& options = "") const { return run_stokes("compare " + a + " " + b + options); }
};

std::size_t lines(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

// 110 against 100 everywhere: every figure but PSNR and the largest error is a tenth of the mean of 0.95, 1, 1.09.
TEST_CASE("compare prints the errors of every layer", "[compare_command]") {
    const Pictures pictures;
    const Outcome table = pictures.compare();
    CAPTURE(table.out, table.err);
    CHECK(table.code == 0);
    CHECK(table.err.empty());
    CHECK(lines(table.out) == 3 + layer_count);
    CHECK_THAT(table.out, Contains("\nwhole "));
    for (const LayerRow& row : layer_rows) CHECK_THAT(table.out, Contains(std::string("\n") + row.name + " "));

    const Outcome run = pictures.compare(" --json");
    CHECK(run.code == 0);
    const nlohmann::json json = nlohmann::json::parse(run.out);
    CHECK(json["picture"] == pictures.a);
    CHECK(json["reference"] == pictures.b);
    CHECK(json["width"] == 4);
    CHECK(json["height"] == 3);
    CHECK(json["passed"] == true);
    CHECK(json["tolerance"].is_null());
    CHECK(json["diff"].is_null());
    REQUIRE(json["layers"].size() == 5);
    const double squares = 0.95 * 0.95 + 1.0 + 1.09 * 1.09, sum = 0.95 + 1.0 + 1.09;
    for (const auto& [name, e] : json["layers"].items()) {
        CAPTURE(name);
        const double scale = name == "whole" ? 1.0 : 0.25;
        CHECK(e["rmse"].get<double>() == Approx(10.0 * scale * std::sqrt(squares / 3.0)).epsilon(1e-5));
        CHECK(e["relative_rmse"].get<double>() == Approx(0.1 * std::sqrt(3.0 * squares) / sum).epsilon(1e-5));
        CHECK(e["psnr_db"].get<double>() == Approx(20.0 * std::log10(10.9 / std::sqrt(squares / 3.0))).epsilon(1e-5));
        CHECK(e["mean_error"].get<double>() == Approx(10.0 * scale * sum / 3.0).epsilon(1e-5));
        CHECK(e["max_error"].get<double>() == Approx(10.9 * scale).epsilon(1e-5));
        CHECK(e["max_error_channel"] == "Z");
        CHECK(e["rmse_xyz"][1].get<double>() == Approx(10.0 * scale).epsilon(1e-5));
        CHECK(e["pixels"] == 12);
        CHECK(e["not_finite"] == 0);
    }
}

TEST_CASE("compare of the same picture finds nothing, and JSON has no infinity", "[compare_command]") {
    const Pictures pictures;
    const Outcome run = run_stokes("compare " + pictures.a + " " + pictures.a + " --json --tolerance 0");
    CHECK(run.code == 0);
    const nlohmann::json json = nlohmann::json::parse(run.out);
    CHECK(json["layers"]["whole"]["rmse"] == 0.0);
    CHECK(json["layers"]["whole"]["psnr_db"].is_null());
    CHECK(json["tolerance"] == 0.0);
}

// The relative RMSE is 0.1001632.
TEST_CASE("compare fails where a relative RMSE is above the tolerance, in one line", "[compare_command]") {
    const Pictures pictures;
    CHECK(pictures.compare(" --tolerance 0.1002").code == 0);
    const Outcome fails = pictures.compare(" --tolerance 0.1001");
    CHECK(fails.code == 1);
    CHECK(lines(fails.out) == 7);
    CHECK(fails.err ==
          "stokes: relative RMSE above the tolerance 0.1001: whole 0.10016, fluorescence 0.10016, single 0.10016, "
          "multiple 0.10016, surface 0.10016\n");
    const Outcome json = pictures.compare(" --tolerance 0.1001 --json");
    CHECK(json.code == 1);
    CHECK(nlohmann::json::parse(json.out)["passed"] == false);
}

TEST_CASE("compare keeps to one layer where it is told to", "[compare_command]") {
    Pictures pictures;
    for (float& value : pictures.film.xyz[static_cast<std::size_t>(Layer::single)]) value *= 2.0f;
    write_exr(pictures.a, pictures.film, {});
    CHECK(pictures.compare(" --tolerance 0.11").err ==
          "stokes: relative RMSE above the tolerance 0.11: whole 0.37561, single 1.202\n");
    CHECK(pictures.compare(" --tolerance 0.11 --layer multiple").code == 0);
    CHECK(pictures.compare(" --tolerance 0.11 --layer whole").code == 1);
    const Outcome one = pictures.compare(" --json --layer single");
    CHECK(nlohmann::json::parse(one.out)["layers"].size() == 1);
    const Outcome none = pictures.compare(" --layer glow");
    CHECK(none.code == 2);
    CHECK(none.err == "stokes: --layer: no \"glow\" in " + pictures.a +
                          "; there are: whole, fluorescence, single, multiple, surface\n");
}

TEST_CASE("compare counts pixels that are not finite, and fails", "[compare_command]") {
    Pictures pictures;
    auto& single = pictures.film.xyz[static_cast<std::size_t>(Layer::single)];
    single[3 * 5] = std::numeric_limits<float>::quiet_NaN();
    single[3 * 7 + 2] = std::numeric_limits<float>::infinity();
    write_exr(pictures.a, pictures.film, {});
    const Outcome run = pictures.compare(" --json");
    CHECK(run.code == 1);
    CHECK(run.err == "stokes: pixels of " + pictures.a + " that are not finite: whole 2, single 2\n");
    const nlohmann::json layers = nlohmann::json::parse(run.out)["layers"];
    CHECK(layers["single"]["not_finite"] == 2);
    CHECK(layers["single"]["reference_not_finite"] == 0);
    CHECK(layers["single"]["pixels"] == 10);
    CHECK(layers["single"]["rmse"].get<double>() > 0.0);
    CHECK(layers["multiple"]["not_finite"] == 0);
    CHECK(pictures.compare(" --layer multiple").code == 0);

    for (float& value : single) value = std::numeric_limits<float>::quiet_NaN();
    write_exr(pictures.a, pictures.film, {});
    const Outcome all = run_stokes("compare " + pictures.b + " " + pictures.a + " --json --tolerance 1");
    CHECK(all.code == 1);
    CHECK(all.err == "stokes: pixels of " + pictures.a + " that are not finite: whole 12, single 12\n");
    const nlohmann::json dark = nlohmann::json::parse(all.out)["layers"]["single"];
    CHECK(dark["rmse"].is_null());
    CHECK(dark["max_error_pixel"].is_null());
    CHECK(dark["reference_not_finite"] == 12);
}

TEST_CASE("compare draws the error and says what the colours mean", "[compare_command]") {
    const Pictures pictures;
    const std::string png = pictures.folder.file("d.png");
    const Outcome run = pictures.compare(" --layer surface --diff " + png);
    CAPTURE(run.out, run.err);
    CHECK(run.code == 0);
    // 2.5 sqrt(3.0906 / 3) = 2.5375, upwards to two digits.
    const std::string scale =
        "error of surface, root mean square of X, Y, Z, linear from black, 0, by violet, red and "
        "orange to white, 2.6 cd/m^2";
    CHECK_THAT(run.out, Contains(png + ": " + scale + "\n"));
    CHECK_THAT(file_content(png), Contains("Description") && Contains(scale));

    const Outcome fixed = pictures.compare(" --json --diff-max 5 --diff " + png);
    const nlohmann::json diff = nlohmann::json::parse(fixed.out)["diff"];
    CHECK(diff["file"] == png);
    CHECK(diff["layer"] == "whole");
    CHECK(diff["from"] == 0);
    CHECK(diff["to"] == 5.0);
    CHECK(diff["pixels_above"] == 12);
    CHECK_THAT(file_content(png), Contains("white, 5 cd/m^2 and above (12 pixels)"));
    CHECK(pictures.folder.names() == std::vector<std::string>{"a.exr", "b.exr", "d.png"});
}

TEST_CASE("compare says in one line what it cannot compare", "[compare_command]") {
    const Pictures pictures;
    const std::string &a = pictures.a, &b = pictures.b;
    const std::string wide = pictures.folder.file("wide.exr"), plain = pictures.folder.file("plain.exr"),
                      text = pictures.folder.file("text.exr");
    write_exr(wide, grey(5, 3, 1.0f), {});
    write_plain(plain, 4, 3);
    put_file(text, "no picture");
    struct {
        std::string arguments, expected;
    } const cases[] = {
        {"", "picture"},
        {a, "reference"},
        {a + " " + wide, "expected pictures of the same size; " + a + " has 4 x 3 pixels, " + wide + " 5 x 3"},
        {a + " " + plain, plain + ": no layer fluorescence, single, multiple, surface, which " + a + " has"},
        {plain + " " + a, plain + ": no layer fluorescence, single, multiple, surface, which " + a + " has"},
        {a + " " + plain + " --layer single", "--layer: no \"single\" in " + plain + "; there are: whole"},
        {a + " " + text, text + ": not a readable OpenEXR file"},
        {a + " none.exr", "none.exr: cannot read"},
        {a + " " + b + " --tolerance -1", "--tolerance: expected a number"},
        {a + " " + b + " --tolerance nan", "--tolerance: expected a number"},
        {a + " " + b + " --diff-max 2", "--diff"},
        {a + " " + b + " --diff " + b, b + ": this output would replace a picture that is compared"},
        {a + " " + b + " --diff " + pictures.folder.path() + "/none/d.png", "none/d.png: cannot write"},
    };
    const std::vector<std::string> before = pictures.folder.names();
    for (const auto& c : cases) {
        const Outcome run = run_stokes("compare " + c.arguments);
        CAPTURE(c.arguments, run.err);
        CHECK(run.code == 2);
        CHECK(run.out.empty());
        CHECK_THAT(run.err, Contains(c.expected));
        CHECK(lines(run.err) == 1);
    }
    CHECK(pictures.folder.names() == before);
    CHECK(run_stokes("compare " + plain + " " + plain).code == 0);
    CHECK(run_stokes("compare " + a + " " + plain + " --layer whole").code == 0);
}

TEST_CASE("the guide to commands names every key of the comparison's JSON", "[compare_command]") {
    const Pictures pictures;
    const Outcome run = pictures.compare(" --json --diff " + pictures.folder.file("d.png"));
    const std::string guide = file_content(source_path("scenes/COMMANDS.md"));
    const nlohmann::json json = nlohmann::json::parse(run.out);
    for (const nlohmann::json& object : {json, json["layers"]["whole"], json["diff"]})
        for (const auto& item : object.items()) {
            CAPTURE(item.key());
            CHECK(guide.find('`' + item.key() + '`') != std::string::npos);
        }
}
