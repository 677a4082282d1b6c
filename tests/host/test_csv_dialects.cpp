// Tables as spectrometers, spreadsheets and data bases write them. Expected values are those of the text.
#include "host/core/csv_spectrum.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"

using namespace stokes;

namespace {

using Values = std::vector<double>;

struct Dialect {
    const char* name;
    std::string text;
};

// The table of wavelengths 400 and 410 and a column "power" of 0.25 and 1.5, but for the files without names.
std::string utf16(const std::string& ascii, bool low_byte_first) {
    std::string bytes = low_byte_first ? "\xff\xfe" : "\xfe\xff";
    for (const char c : ascii) {
        const std::string unit = low_byte_first ? std::string{c, '\0'} : std::string{'\0', c};
        bytes += unit;
    }
    return bytes;
}

const std::string plain = "wavelength,power\n400,0.25\n410,1.5\n";

}  // namespace

TEST_CASE("tables with names are read by any separator, line end and encoding") {
    const Dialect dialects[] = {
        {"plain", plain},
        {"semicolons", "wavelength;power\n400;0.25\n410;1.5\n"},
        {"decimal commas", "wavelength;power\n400,0;0,25\n410,0;1,5\n"},
        {"tabs", "wavelength\tpower\n400\t0.25\n410\t1.5\n"},
        {"tabs and decimal commas", "wavelength\tpower\n400\t0,25\n410\t1,5\n"},
        {"blanks", "wavelength   power\n 400   0.25\n 410   1.5\n"},
        {"bars", "wavelength|power\n400|0.25\n410|1.5\n"},
        {"a separator and blanks", "wavelength , power\n400 , 0.25\n410 , 1.5\n"},
        {"quotes", "\"wavelength\",\"power\"\n\"400\",\"0.25\"\n\"410\",\"1.5\"\n"},
        {"quotes around names", "\"wavelength\",\"power\"\n400,0.25\n410,1.5\n"},
        {"quoted decimal commas", "wavelength,power\n\"400,0\",\"0,25\"\n\"410,0\",\"1,5\"\n"},
        {"a byte order mark", "\xef\xbb\xbf" + plain},
        {"a comment behind a byte order mark", "\xef\xbb\xbf# lamp\n" + plain},
        {"UTF-16, low byte first", utf16(plain, true)},
        {"UTF-16, high byte first", utf16(plain, false)},
        {"Latin-1", "# \xb5m\n" + plain},
        {"CR LF", "wavelength,power\r\n400,0.25\r\n410,1.5\r\n"},
        {"CR", "wavelength,power\r400,0.25\r410,1.5\r"},
        {"names behind #", "# a lamp\n# wavelength,power\n400,0.25\n410,1.5\n"},
        {"names behind #, of blanks", "#wavelength power\n400 0.25\n410 1.5\n"},
        {"other comments", "% a\n! b\n// c\n" + plain + "# d\n"},
        {"separators at the ends", "wavelength,power,\n400,0.25,\n410,1.5,\n"},
        {"separators at the ends of rows", "wavelength,power\n400,0.25,\n410,1.5,\n"},
        {"separators at the end of the names", "wavelength,power,\n400,0.25\n410,1.5\n"},
        {"empty lines", "\n\nwavelength,power\n\n400,0.25\n,\n410,1.5\n\n"},
        {"text before the names", "Report of 3 March, page 2 of 7\nlamp A\n\n" + plain},
        {"a separator said", "sep=;\nwavelength;power\n400;0.25\n410;1.5\n"},
        {"D exponents", "wavelength,power\n4.00D+02,2.5D-01\n410,1.5d0\n"},
        {"a line of units", "wavelength,power\nnm,W/nm\n400,0.25\n410,1.5\n"},
        {"no-break spaces",
         "wavelength\xc2\xa0,power\n400\xc2\xa0,\xc2\xa0"
         "0.25\n410\xe2\x80\xaf,1.5\n"},
        {"decreasing wavelengths", "wavelength,power\n410,1.5\n400,0.25\n"},
    };
    for (const Dialect& dialect : dialects) {
        INFO(dialect.name);
        const CsvTable table = parse_csv(dialect.text, "t.csv");
        CHECK(table.columns == std::vector<std::string>{"wavelength", "power"});
        const Spectrum power = csv_spectrum(table, "power", Outside::zero);
        CHECK(power.lambda_nm == Values{400, 410});
        CHECK(power.value == Values{0.25, 1.5});
    }
}

TEST_CASE("tables without names have their columns by number, and lose no row") {
    const Dialect dialects[] = {
        {"plain", "400,0.25\n410,1.5\n"},
        {"a comment", "# measured\n400,0.25\n410,1.5\n"},
        {"a spectrometer's header",
         "Data from lamp.txt Node\n\nIntegration Time (sec): 1.0E-1\n>>>>>Begin Spectral Data<<<<<\n400.000\t0.2500\n"
         "410.000\t1.5000\n>>>>>End Spectral Data<<<<<\n"},
        {"a spectrometer's header in columns",
         "Integration:\t0.1\n>>>>>Begin Processed Spectral Data<<<<<\n400.000\t0.2500\n410.000\t1.5000\n"},
        {"decimal commas", "400\t0,25\n410\t1,50\n"},
    };
    for (const Dialect& dialect : dialects) {
        INFO(dialect.name);
        const CsvTable table = parse_csv(dialect.text, "t.csv");
        CHECK_FALSE(table.named);
        CHECK(csv_spectrum(table, "2", Outside::zero).value == Values{0.25, 1.5});
        CHECK(input_error([&] { csv_spectrum(table, "power", Outside::zero); }) ==
              "t.csv: no column \"power\"; the file has no line of column names, so they go by number; expected one "
              "of: 2");
    }
}

TEST_CASE("other columns do not matter") {
    const CsvTable table =
        parse_csv("nm,dye ex,note,power,x,x\n400,0.5,,0.25,1,1\n405,,saturated,0.5,1,-7\n410,nan,,1.5,1,\n", "t.csv");
    CHECK(csv_spectrum(table, "power", Outside::zero).value == Values{0.25, 0.5, 1.5});
    CHECK_THAT(input_error([&] { csv_spectrum(table, "x", Outside::zero); }),
               Catch::Matchers::Contains("several columns are named \"x\""));
    CHECK(csv_spectrum(table, "5", Outside::zero).value == Values{1, 1, 1});
    CHECK_THAT(input_error([&] { csv_spectrum(table, "note", Outside::zero); }),
               Catch::Matchers::Contains("t.csv:3: note: expected a finite number, got \"saturated\""));
}

TEST_CASE("a column has no data where its cells are blank at its ends, and is refused where they are not") {
    const std::string text = "nm,ex,em,gap,none\n400,,,1,\n405,0.5,,,\n410,0.75,2,3,\n415,,4,,\n";
    const CsvTable table = parse_csv(text, "t.csv");
    const Spectrum ex = csv_spectrum(table, "ex", Outside::zero);
    CHECK(ex.lambda_nm == Values{405, 410});
    CHECK(ex.value == Values{0.5, 0.75});
    CHECK(csv_spectrum(table, "em", Outside::zero).lambda_nm == Values{410, 415});
    CHECK_THAT(input_error([&] { csv_spectrum(table, "gap", Outside::zero); }),
               Catch::Matchers::StartsWith("t.csv:3: gap: no value at 405 nm, but on both sides of it"));
    CHECK(input_error([&] { csv_spectrum(table, "none", Outside::zero); }) ==
          "t.csv: none: no value from 300 to 830 nm");
}

// -1.23e34 stands for a deleted channel in the USGS spectral library. What lies beyond 830 nm does not matter.
TEST_CASE("only what lies from 300 to 830 nm matters") {
    const CsvTable table =
        parse_csv("nm,r\n250,7e33\n290,-1.23e34\n350,0.5\n800,0.25\n840,0.75\n1400,-1.23e34\n2500,9\n", "t.csv");
    const Spectrum r = csv_spectrum(table, "r", Outside::hold);
    CHECK(r.lambda_nm == Values{350, 800, 840});
    CHECK(r.value == Values{0.5, 0.25, 0.75});
}

TEST_CASE("noise about a dark level becomes zero with a remark, more is refused unless it is asked for") {
    const CsvTable table = parse_csv("nm,a,b\n400,-0.02,-0.3\n410,1,1\n420,-0.001,0\n", "t.csv");
    const SampleRules unsaid, zero{{}, {}, Negative::zero}, refuse{{}, {}, Negative::refuse};
    const ColumnSpectrum a = read_column(table, "a", Outside::zero, unsaid);
    CHECK(a.spectrum.value == Values{0, 1, 0});
    CHECK(a.remarks == std::vector<std::string>{"t.csv: a: 2 values below zero, down to -0.02, taken for zero"});
    CHECK_THAT(input_error([&] { read_column(table, "b", Outside::zero, unsaid); }),
               Catch::Matchers::StartsWith("t.csv:2: b: expected no negative value, got -0.3; \"negative\": \"zero\""));
    CHECK(read_column(table, "b", Outside::zero, zero).spectrum.value == Values{0, 1, 0});
    CHECK(read_column(table, "b", Outside::zero, zero).remarks.empty());
    CHECK(input_error([&] { read_column(table, "a", Outside::zero, refuse); }) ==
          "t.csv:2: a: expected no negative value, got -0.02");
}

TEST_CASE("a table of probabilities that comes nowhere near 1 is in doubt") {
    CHECK_THAT(doubt_of_probability({{300, 400}, {0.0, 0.0476}, Outside::zero}),
               Catch::Matchers::StartsWith("the largest value is 0.0476"));
    CHECK(doubt_of_probability({{300, 400}, {0.0, 0.1}, Outside::zero}).empty());
    CHECK(doubt_of_probability(Spectrum::constant(0.01)).empty());
}
