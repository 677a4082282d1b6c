#include <filesystem>

#include "host/core/csv_spectrum.hpp"
#include "host/core/text_input.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;

TEST_CASE("A CSV table has its columns, rows and their lines") {
    const CsvTable table = parse_csv("# title\n# STATUS: MODEL\n\nnm, a,b\n300, 1,+2.5\r\n\n400,1e-3,-4\n", "t.csv");
    CHECK(table.columns == std::vector<std::string>{"nm", "a", "b"});
    REQUIRE(table.values.size() == 3);
    CHECK(table.values[0] == std::vector<double>{300, 400});
    CHECK(table.values[1] == std::vector<double>{1, 1e-3});
    CHECK(table.values[2] == std::vector<double>{2.5, -4});
    CHECK(table.lines == std::vector<std::int64_t>{5, 7});
}

TEST_CASE("A CSV column becomes a spectrum") {
    const CsvTable table = parse_csv("nm,a,b\n300,1,2\n400,3,-4", "t.csv");
    const Spectrum a = csv_spectrum(table, "a", Outside::hold);
    CHECK(a.at(350) == Approx(2.0));
    CHECK(a.at(500) == 3.0);
    CHECK(csv_spectrum(table, "a", Outside::zero).at(500) == 0.0);
    CHECK(input_error([&] { csv_spectrum(table, "b", Outside::zero); }) ==
          "t.csv:3: b: expected no negative value, got -4");
    CHECK(csv_spectrum(table, "2", Outside::hold).value == a.value);
    CHECK(input_error([&] { csv_spectrum(table, "c", Outside::zero); }) ==
          "t.csv: no column \"c\"; expected one of: a, b");
    CHECK(input_error([&] { csv_spectrum(table, "nm", Outside::zero); }) ==
          "t.csv: no column \"nm\"; expected one of: a, b");
}

TEST_CASE("Bad CSV is one line with file and line") {
    struct Case {
        std::string text;
        std::string expected;
    };
    const Case cases[] = {
        {"", "t.csv:1: expected a line of column names and rows of numbers"},
        {"# only a header\n", "t.csv:2: expected a line of column names"},
        {"nm,a\n", "t.csv:2: expected a line of column names and rows"},
        {"nm\n300\n", "t.csv:2: expected a wavelength and at least one more number, got \"300\""},
        {"nm,a\n300,1\n400\n", "t.csv:3: expected 2 fields, got 1"},
        {"nm,a\n300,1,2\n", "t.csv:2: expected 2 fields, got 3; if its commas are decimal ones"},
        {"nm,a,b\n300,1\n", "t.csv:2: expected 3 fields, got 2"},
        {"nm,a\n300,0,5\n", "t.csv:2: expected 2 fields, got 3; if its commas are decimal ones"},
        {"nm,a\n300,white\n", "t.csv:2: expected a wavelength and at least one more number, got \"300,white\""},
        {"nm,a\n300,1 2\n", "t.csv:2: expected cells between commas or between blanks, got \"300,1 2\""},
        {"nm,a\n300,inf\n", "t.csv:2: expected a wavelength and at least one more number"},
        {"nm,a\n300,1e999\n", "t.csv:2: expected a wavelength and at least one more number"},
        {"nm,a\n300,1\nlate,1\n", "t.csv:3: nm: expected a finite number, got \"late\""},
        {"nm,a\n300,1\n300,2\n", "t.csv:3: nm: 300 given twice"},
        {"nm,a\n300,1\n310,1\n305,2\n", "t.csv:4: nm: expected wavelengths that increase as those before, got 305"},
        {"nm,a\n310,1\n300,1\n305,2\n", "t.csv:4: nm: expected wavelengths that decrease as those before, got 305"},
        {"nm,a\n-5,1\n", "t.csv:2: nm: expected a positive wavelength, got -5"},
        {"300,5x\n310,1\n", "t.csv:1: expected a wavelength and at least one more number, got \"300,5x\""},
        {"300nm,5\n310,1\n", "t.csv:1: expected column names or numbers, got \"300nm,5\""},
        {"300 nm,5\n310,1\n", "t.csv:1: expected a wavelength and at least one more number, got \"300 nm,5\""},
        {"{\"pairs\": [[300, 1]]}", "t.csv:1: expected a table, got JSON"},
        {"##TITLE=dye\n##XYDATA=(X++(Y..Y))\n400 1 2\n", "t.csv:1: expected a table, got JCAMP-DX"},
        {std::string("nm,a\n300,1\0\n", 12), "t.csv: expected text, got a byte 0"},
        {"nm;a\n300.5;0,5\n", "t.csv:2: expected either decimal points or decimal commas, got \"0,5\" and \"300.5\""},
        {"nm\ta\n300\t1,234\n310\t12,345\n", "t.csv:2: expected numbers without commas, got \"1,234\""},
    };
    for (const Case& c : cases) {
        INFO(c.text);
        CHECK_THAT(input_error([&] { parse_csv(c.text, "t.csv"); }), Catch::Matchers::StartsWith(c.expected));
    }
}

TEST_CASE("A CSV file that cannot be read says so") {
    const TemporaryFolder folder;
    CHECK(input_error([&] { read_csv(folder.file("no.csv")); }) ==
          folder.file("no.csv") + ": cannot read: No such file or directory");
    CHECK_THAT(input_error([&] { read_csv(folder.path()); }),
               Catch::Matchers::StartsWith(folder.path() + ": cannot read: "));
    put_file(folder.file("t.csv"), "nm,a\n300,7\n");
    CHECK(read_csv(folder.file("t.csv")).values[1] == std::vector<double>{7});
}

TEST_CASE("Every shipped table over wavelength can be read, without negative values") {
    int tables = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source_path("tables"))) {
        const std::string path = entry.path().string();
        if (entry.path().extension() != ".csv") continue;
        if (read_file(path).find("\nwavelength_nm,") == std::string::npos) continue;
        INFO(path);
        ++tables;
        const CsvTable table = read_csv(path);
        for (std::size_t i = 1; i < table.columns.size(); ++i) {
            CHECK_NOTHROW(csv_spectrum(table, table.columns[i], Outside::zero));
        }
    }
    CHECK(tables == 12);
}

TEST_CASE("Names that were probably meant are found") {
    const std::vector<std::string> names = {"radius_mm", "height_mm", "up", "power_W"};
    CHECK(closest_name("radius", names) == "radius_mm");
    CHECK(closest_name("Radius_MM", names) == "radius_mm");
    CHECK(closest_name("hieght_mm", names) == "height_mm");
    CHECK(closest_name("power_w", names) == "power_W");
    CHECK(closest_name("colour", names).empty());
    CHECK(closest_name("", names).empty());
    CHECK(edit_distance("kitten", "sitting") == 3);
}
