#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "host/commands/error_curve.hpp"
#include "host/core/csv_table.hpp"
#include "host/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

// Of the k-th layer that a curve has.
std::string name_of(std::size_t k) { return k == 0 ? "whole" : layer_rows[k - 1].name; }

// The same light, Y in cd/m^2 and X = Y = Z, in every layer.
FilmImage even_film(int width, int height, float luminance) {
    FilmImage film(width, height);
    for (std::vector<float>& layer : film.xyz) std::fill(layer.begin(), layer.end(), luminance);
    return film;
}

Film film_size(int width, int height) {
    Film film;
    film.width = width;
    film.height = height;
    return film;
}

std::vector<std::uint32_t> due_passes(const ErrorCurve& curve, std::uint32_t last) {
    std::vector<std::uint32_t> passes;
    for (std::uint32_t pass = 1; pass <= last; ++pass)
        if (curve.due(pass)) passes.push_back(pass);
    return passes;
}

// A reference of the sphere, in the size of small_render.
struct Reference {
    TemporaryFolder folder;
    std::string file = folder.file("ref.exr"), csv = folder.file("e.csv");
    std::string options = " --quiet --rmse-against " + file + " --csv " + csv + " ";
    Reference() {
        if (run_stokes("render " + sphere_scene + small_render + "--seed 9 --quiet -o " + file).code != 0)
            throw std::runtime_error("no reference");
    }
};

}  // namespace

TEST_CASE("rows are due after powers of two, or after every so many passes", "[error_curve]") {
    const TemporaryFolder folder;
    write_exr(folder.file("r.exr"), even_film(3, 2, 1.0f), {});
    const auto curve = [&](int every) {
        return ErrorCurve(folder.file("r.exr"), folder.file("e.csv"), every, film_size(3, 2));
    };
    CHECK(due_passes(curve(0), 40) == std::vector<std::uint32_t>{1, 2, 4, 8, 16, 32});
    CHECK(due_passes(curve(7), 40) == std::vector<std::uint32_t>{7, 14, 21, 28, 35});
    CHECK(due_passes(curve(1), 4) == std::vector<std::uint32_t>{1, 2, 3, 4});
    CHECK(folder.names() == std::vector<std::string>{"r.exr"});
}

// X = Y = Z = v in each of four layers against 10: 4 |v - 10| in the whole, over 40.
TEST_CASE("each row adds the errors of that moment, and the file is whole after each", "[error_curve]") {
    const TemporaryFolder folder;
    write_exr(folder.file("r.exr"), even_film(3, 2, 10.0f), {});
    ErrorCurve curve(folder.file("r.exr"), folder.file("e.csv"), 0, film_size(3, 2));
    CHECK(curve.last() == 0);
    const std::vector<float> values = {14.0f, 8.0f, 10.5f};
    for (std::size_t row = 0; row < values.size(); ++row) {
        const auto passes = static_cast<std::uint32_t>(1u << row);
        curve.add(passes, 0.5 * passes, even_film(3, 2, values[row]));
        CHECK(curve.last() == passes);
        const CsvTable table = read_csv(folder.file("e.csv"));
        REQUIRE(table.values[0].size() == row + 1);
        CHECK(table.columns[0] == "passes");
        CHECK(table.columns[1] == "seconds");
        CHECK(table.values[0][row] == passes);
        CHECK(table.values[1][row] == 0.5 * passes);
        REQUIRE(table.columns.size() == 4 + 2 * layer_count);
        for (std::size_t k = 0; k < 1 + layer_count; ++k) {
            CHECK(table.columns[2 + 2 * k] == "rmse_" + name_of(k));
            CHECK(table.columns[3 + 2 * k] == "relative_rmse_" + name_of(k));
            const double error = std::abs(values[row] - 10.0);
            CHECK(table.values[2 + 2 * k][row] == Approx(error * (k == 0 ? double(layer_count) : 1.0)).epsilon(1e-5));
            CHECK(table.values[3 + 2 * k][row] == Approx(0.1 * error).epsilon(1e-5));
        }
    }
}

TEST_CASE("a curve that cannot be written does not end the render", "[error_curve]") {
    const TemporaryFolder folder;
    const std::string place = folder.file("gone");
    std::filesystem::create_directory(place);
    write_exr(folder.file("r.exr"), even_film(3, 2, 10.0f), {});
    ErrorCurve curve(folder.file("r.exr"), place + "/e.csv", 0, film_size(3, 2));
    std::filesystem::remove(place);
    CHECK_NOTHROW(curve.add(1, 0.1, even_film(3, 2, 9.0f)));
    CHECK_THROWS_AS(curve.write(), RunError);
    std::filesystem::create_directory(place);
    curve.add(2, 0.2, even_film(3, 2, 9.5f));
    CHECK(read_csv(place + "/e.csv").values[0] == std::vector<double>{1.0, 2.0});
}

TEST_CASE("a reference that cannot serve is bad input", "[error_curve]") {
    const TemporaryFolder folder;
    const std::string file = folder.file("r.exr");
    const auto error = [&](int width, int height) {
        return input_error([&] { ErrorCurve(file, folder.file("e.csv"), 0, film_size(width, height)); });
    };
    CHECK_THAT(error(3, 2), Contains("r.exr: cannot read: No such file"));
    FilmImage film = even_film(3, 2, 10.0f);
    write_exr(file, film, {});
    CHECK(error(2, 3) == file + ": expected 2 x 3 pixels, as the render has, got 3 x 2");
    CHECK(error(3, 2).empty());
    film.xyz[static_cast<std::size_t>(Layer::multiple)][4] = std::numeric_limits<float>::quiet_NaN();
    write_exr(file, film, {});
    CHECK(error(3, 2) == file + ": expected finite pixels, got 1 in layer whole that are not");
}

TEST_CASE("the curve's last row is what compare says of the picture", "[error_curve]") {
    const Reference reference;
    const std::string picture = reference.folder.file("a.exr"), stats = reference.folder.file("a.json");
    const Outcome run = run_stokes("render " + sphere_scene + " --photons 4000 --size 24x16 --passes 6 -o " + picture +
                                   " --stats " + stats + reference.options);
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    CHECK(run.err.empty());
    const CsvTable table = read_csv(reference.csv);
    CHECK(table.values[0] == std::vector<double>{1, 2, 4, 6});
    for (std::size_t row = 1; row < 4; ++row) CHECK(table.values[1][row] > table.values[1][row - 1]);
    const auto layers =
        nlohmann::json::parse(run_stokes("compare --json " + picture + " " + reference.file).out)["layers"];
    for (std::size_t k = 0; k < 1 + layer_count; ++k) {
        CAPTURE(name_of(k));
        CHECK(table.values[2 + 2 * k].back() > 0.0);
        CHECK(table.values[2 + 2 * k].back() == Approx(layers[name_of(k)]["rmse"].get<double>()).epsilon(1e-7));
        CHECK(table.values[3 + 2 * k].back() ==
              Approx(layers[name_of(k)]["relative_rmse"].get<double>()).epsilon(1e-7));
    }
    // Measuring takes no part in either.
    const double wall_s = nlohmann::json::parse(file_content(stats))["wall_s"];
    CHECK(table.values[1].back() == Approx(wall_s).epsilon(0.01).margin(1e-3));
}

TEST_CASE("measuring leaves the picture as it is, on any number of threads", "[error_curve]") {
    const Reference reference;
    const std::string render = "render " + sphere_scene + small_render + "--quiet -o ";
    const std::string plain = reference.folder.file("plain.exr"), measured = reference.folder.file("measured.exr");
    REQUIRE(run_stokes(render + plain).code == 0);
    std::vector<std::vector<double>> first;
    for (const char* threads : {"1", "2"}) {
        REQUIRE(run_stokes(render + measured + " --every 1 --threads " + threads + reference.options).code == 0);
        CHECK(read_exr(measured).layers == read_exr(plain).layers);
        std::vector<std::vector<double>> values = read_csv(reference.csv).values;
        CHECK(values[0] == std::vector<double>{1, 2});
        values[1].clear();
        if (!first.empty()) CHECK(values == first);
        first = values;
    }
    // The reference's own seed: no error.
    REQUIRE(run_stokes(render + measured + " --seed 9" + reference.options).code == 0);
    CHECK(read_csv(reference.csv).values[2].back() == 0.0);
}

TEST_CASE("what is wrong with a curve is said before the render begins", "[error_curve]") {
    const Reference reference;
    const std::string file = reference.file, csv = reference.csv;
    const std::string render = "render " + sphere_scene + " --passes 100000 --photons 4000 ";
    struct {
        std::string arguments, expected;
    } const cases[] = {
        {"--size 24x16 --rmse-against " + file, "--rmse-against requires --csv"},
        {"--size 24x16 --csv " + csv, "--csv requires --rmse-against"},
        {"--size 24x16 --png x.png --every 3", "--every requires --rmse-against"},
        {"--size 24x16 --every 0" + reference.options, "--every"},
        {"--size 25x16" + reference.options, file + ": expected 25 x 16 pixels, as the render has, got 24 x 16"},
        {"--size 24x16 --rmse-against none.exr --csv " + csv, "none.exr: cannot read"},
        {"--size 24x16 --rmse-against " + file + " --csv " + file, "this output would replace the reference"},
        {"--size 24x16 -o " + file + reference.options, "this output would replace the reference"},
        {"--size 24x16 --png " + csv + reference.options, "another file for each output"},
        {"--size 24x16 --rmse-against " + file + " --csv " + reference.folder.path() + "/none/e.csv", "none/e.csv"},
    };
    for (const auto& c : cases) {
        const Outcome run = run_stokes(render + c.arguments);
        CAPTURE(c.arguments, run.err);
        CHECK(run.code == 2);
        CHECK_THAT(run.err, Contains(c.expected));
    }
    CHECK(reference.folder.names() == std::vector<std::string>{"ref.exr"});
}
