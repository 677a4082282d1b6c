#include <cmath>
#include <cstdlib>

#include "host/render/transport/green_walk.hpp"
#include "host/subsurface/escape.hpp"
#include "host/subsurface/green_table.hpp"
#include "host/subsurface/gzip.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

// Rows h1 = rho exp(-rho) with the exact totals.
GreenTable made_up_table(double eta = 1.2) {
    GreenTable table = green_table_nodes(eta);
    for (std::size_t a = 0; a < table.albedo.size(); ++a)
        for (std::size_t z = 0; z < table.z.size(); ++z)
            for (const double rho : table.rho)
                table.h1.push_back(a == 0 ? 0.0f : static_cast<float>(rho * std::exp(-rho)));
    normalise_green_rows(table);
    return table;
}

// Few of the nodes of the above.
GreenTable small_table() {
    const GreenTable all = made_up_table();
    const std::vector<std::size_t> rhos{0, 1, 19, 37, 55, 73, 91, 109, 127}, depths{0, 1, 14, 27, 40},
        albedos{0, 15, 25, 31};
    GreenTable table;
    table.eta = all.eta;
    for (const std::size_t r : rhos) table.rho.push_back(all.rho[r]);
    for (const std::size_t z : depths) {
        table.z.push_back(all.z[z]);
        table.u0.push_back(all.u0[z]);
    }
    for (const std::size_t a : albedos) {
        table.albedo.push_back(all.albedo[a]);
        for (const std::size_t z : depths) {
            table.u1.push_back(all.u1[a * all.z.size() + z]);
            for (const std::size_t r : rhos) table.h1.push_back(all.h1[all.row(a, z) + r]);
        }
    }
    normalise_green_rows(table);
    return table;
}

// The complaint about a table's text in which one piece is replaced by another.
std::string complaint(const std::string& text, const std::string& piece, const std::string& by) {
    std::string changed = text;
    const std::size_t at = changed.find(piece);
    REQUIRE(at != std::string::npos);
    changed.replace(at, piece.size(), by);
    return input_error([&] { parse_green_table(compress_gzip(changed), "table"); });
}

std::string text_of(const GreenTable& table, const TemporaryFolder& folder) {
    write_green_table(table, folder.file("table.json.gz"));
    return decompress_gzip(file_content(folder.file("table.json.gz")), "table", std::size_t{1} << 28);
}

// XDG_CACHE_HOME for as long as it lives.
class CacheHome {
  public:
    explicit CacheHome(const std::string& path) : before_(std::getenv("XDG_CACHE_HOME")) {
        if (before_ != nullptr) kept_ = before_;
        ::setenv("XDG_CACHE_HOME", path.c_str(), 1);
    }
    ~CacheHome() {
        if (before_ != nullptr)
            ::setenv("XDG_CACHE_HOME", kept_.c_str(), 1);
        else
            ::unsetenv("XDG_CACHE_HOME");
    }

  private:
    const char* before_;
    std::string kept_;
};

}  // namespace

TEST_CASE("rows are scaled to the exact totals", "[green_table]") {
    const GreenTable table = made_up_table();
    const HalfSpaceEscape escape(1.2, table.z);
    for (const std::size_t a : {0u, 7u, 20u, 31u}) {
        const std::vector<double> total = escape.total(table.albedo[a]);
        for (std::size_t z = 0; z < table.z.size(); ++z) {
            const double u1 = total[z] - escape.unscattered()[z];
            CHECK(green_row_integral(table, a, z) == Approx(u1).epsilon(1e-6).margin(1e-9));
        }
    }
}

TEST_CASE("totals between the nodes are those of exact transport", "[green_table]") {
    for (const double eta : {1.0, 1.5}) {
        const GreenTable nodes = green_table_nodes(eta);
        const GreenTotals totals(nodes);
        const std::vector<double> depths{0.0, 0.002, 0.008, 0.0107, 0.05, 0.3, 1.1, 3.7, 9.0, 20.0};
        const HalfSpaceEscape escape(eta, depths);
        for (const double a : {0.1, 0.45, 0.8, 0.9, 0.985, 0.998, 0.9995, 0.99995, 1.0}) {
            const std::vector<double> total = escape.total(a);
            for (std::size_t i = 0; i < depths.size(); ++i) {
                CAPTURE(eta, a, depths[i]);
                CHECK(std::abs(totals.at(depths[i], a) - (total[i] - escape.unscattered()[i])) < 1e-4);
            }
        }
    }
}

TEST_CASE("smoothing keeps power laws and halves noise", "[green_table]") {
    GreenTable table = green_table_nodes(1.0);
    for (std::size_t row = 0; row < table.albedo.size() * table.z.size(); ++row)
        for (const double rho : table.rho) table.h1.push_back(static_cast<float>(rho * rho));
    const GreenTable exact = table;
    smooth_green_rows(table);
    for (std::size_t i = 0; i < exact.h1.size(); ++i) REQUIRE(table.h1[i] == Approx(exact.h1[i]).epsilon(1e-5));

    // A single value that stands out keeps 17/35 of its logarithm in each direction.
    const std::size_t place = table.row(5, 20) + 60;
    table.h1[place] *= 2.0f;
    smooth_green_rows(table);
    CHECK(table.h1[place] / exact.h1[place] == Approx(std::pow(2.0, std::pow(17.0 / 35.0, 2))).epsilon(1e-4));
}

TEST_CASE("a written table reads back", "[green_table]") {
    const TemporaryFolder folder;
    const GreenTable table = made_up_table();
    const std::string path = folder.file("table.json.gz");
    write_green_table(table, path);
    const GreenTable read = read_green_table(path);
    CHECK(read.eta == 1.2);
    CHECK((read.rho == table.rho));
    CHECK((read.z == table.z));
    CHECK((read.albedo == table.albedo));
    REQUIRE(read.h1.size() == table.h1.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < table.h1.size(); ++i)
        if (table.h1[i] > 1e-20f) worst = std::max(worst, std::abs(double(read.h1[i]) / double(table.h1[i]) - 1.0));
    CHECK(worst < 1.1e-3);  // four digits, and the row's scale
    for (std::size_t i = 0; i < table.u1.size(); ++i) CHECK(read.u1[i] == Approx(table.u1[i]).epsilon(1e-7));
    for (std::size_t z = 0; z < table.z.size(); ++z) {
        CHECK(read.u0[z] == Approx(table.u0[z]).epsilon(1e-7));
        CHECK(green_row_integral(read, 20, z) == Approx(read.u1[20 * table.z.size() + z]).epsilon(1e-6));
    }
}

TEST_CASE("bad table files are told apart", "[green_table]") {
    const TemporaryFolder folder;
    const std::string text = text_of(small_table(), folder);
    const auto check = [&](const std::string& piece, const std::string& by, const std::string& words) {
        CHECK_THAT(complaint(text, piece, by), StartsWith("table:1: " + words));
    };
    check(R"("conserving")", R"("paper")", R"(model: expected "conserving", got "paper")");
    check(R"("version":1)", R"("version":2)", "version: expected an integer in [1, 1]");
    check(R"("eta":1.2)", R"("eta":0.5)", "eta: expected a number in [1, ");
    check(R"("name":"z")", R"("name":"depth")", R"(axes[1].name: expected "z")");
    check("[0.0,0.003", "[0.0,0.004", "axes[0].values[2]: expected logarithmic steps");
    check("[0.0,0.003", "[0.0,0.0", "axes[0].values[1]: expected strictly increasing values");
    check("[0.0,0.003", "[0.001,0.003", "axes[0].values[0]: expected 0");
    check(R"("u1":[0.0,)", R"("u1":[)", "u1: expected an array of 20 numbers, got an array of 19");
    check(R"("1/mfp","values":[0.0)", R"("1/mfp","values":[-1)", "values[0]: expected a number in [0, ");
    check(R"("u1":[0.0)", R"("u1":[0.9)", "u1[0]: expected at most 1");
    check(R"("u1":[0.0)", R"("u1":[0.2)", "values: expected an integral");
    CHECK_THAT(complaint(text, "]}\n", ""), StartsWith("table:1: JSON syntax error"));

    const std::string path = folder.file("table.json.gz");
    const std::string whole = file_content(path);
    put_file(path, whole.substr(0, whole.size() / 2));
    CHECK(input_error([&] { read_green_table(path); }) == path + ": not a whole gzip file");
    put_file(path, whole + "x");
    CHECK(input_error([&] { read_green_table(path); }) == path + ": not a whole gzip file");
    put_file(path, "");
    CHECK(input_error([&] { read_green_table(path); }) == path + ": not a whole gzip file");
    CHECK_THAT(input_error([&] { read_green_table(folder.file("none")); }), Contains("cannot read"));
}

TEST_CASE("text survives compression, and bombs are refused", "[gzip]") {
    const std::string text(1000000, 'a');
    const std::string packed = compress_gzip(text);
    CHECK(packed.size() < 5000);
    CHECK((decompress_gzip(packed, "name", text.size() + 1) == text));
    CHECK(input_error([&] { decompress_gzip(packed, "name", 1000); }) == "name: expected at most 1000 bytes of text");
    CHECK(decompress_gzip(compress_gzip(""), "name", 10).empty());
}

TEST_CASE("the shipped tables are in the program", "[green_table]") {
    const TemporaryFolder folder;
    const CacheHome cache(folder.path());
    for (const double eta : {1.0, 1.33, 1.5}) {
        const GreenTable table = green_table_for(test_device(), eta);
        CHECK(table.eta == eta);
        CHECK(table.albedo.size() == STOKES_GREEN_ALBEDOS);
        const HalfSpaceEscape escape(eta, table.z);
        for (const std::size_t a : {3u, 15u, 25u, 31u}) {
            const std::vector<double> total = escape.total(table.albedo[a]);
            for (std::size_t z = 0; z < table.z.size(); ++z)
                CHECK(green_row_integral(table, a, z) + escape.unscattered()[z] == Approx(total[z]).margin(1e-6));
        }
    }
    CHECK_FALSE(std::filesystem::exists(folder.file("stokes")));
}

TEST_CASE("the cache serves other refractive indices", "[green_table]") {
    const TemporaryFolder folder;
    const CacheHome cache(folder.path());
    std::filesystem::create_directory(folder.file("stokes"));
    const std::string path = folder.file("stokes/green-1.2.json.gz");
    write_green_table(made_up_table(), path);
    bool walked = false;
    const GreenTable table = green_table_for(test_device(), 1.2, [&](double) { walked = true; });
    CHECK_FALSE(walked);
    CHECK((table.h1 == read_green_table(path).h1));
}

TEST_CASE("a table that cannot be made says why", "[green_table]") {
    CHECK(input_error([] { make_green_table(test_device(), 0.8, 100); }) ==
          "eta 0.8: expected a refractive index from 1 to 4");
    CHECK(input_error([] { make_green_table(test_device(), 1.0, 0); }) ==
          "0 walks: expected a number from 1 to 4294901760");
}

// Recomputes what is in the cache when it is corrupt: slow.
TEST_CASE("a corrupt cache is made anew", "[green_table][.long]") {
    const TemporaryFolder folder;
    const CacheHome cache(folder.path());
    std::filesystem::create_directory(folder.file("stokes"));
    const std::string path = folder.file("stokes/green-1.25.json.gz");
    put_file(path, "rubbish");
    double share = 0.0;
    const GreenTable table = green_table_for(test_device(), 1.25, [&](double s) {
        CHECK(s >= share);
        share = s;
    });
    CHECK(share == Approx(1.0));
    CHECK(table.eta == 1.25);
    const GreenTable cached = read_green_table(path);
    CHECK((cached.albedo == table.albedo));
    CHECK(cached.h1[cached.row(20, 20) + 60] == Approx(table.h1[table.row(20, 20) + 60]).epsilon(1e-3));
}
