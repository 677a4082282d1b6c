#include "host/core/csv_spectrum.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"

using namespace stokes;
using Unit = WavelengthUnit;
using Values = std::vector<double>;

// hc/e = 1239.84198 eV nm and c = 299792.458 nm THz by the SI of 2019.
TEST_CASE("wavelengths follow from any unit") {
    CHECK(wavelength_nm(Unit::um, 0.5) == Approx(500));
    CHECK(wavelength_nm(Unit::angstrom, 5461) == Approx(546.1));
    CHECK(wavelength_nm(Unit::m, 5e-7) == Approx(500));
    CHECK(wavelength_nm(Unit::ev, 2.47968396) == Approx(500).epsilon(1e-7));
    CHECK(wavelength_nm(Unit::per_cm, 20000) == Approx(500));
    CHECK(wavelength_nm(Unit::thz, 599.584916) == Approx(500));
    CHECK(word_of(Unit::per_cm) == "cm-1");
}

TEST_CASE("densities per unit become densities per nm") {
    for (const Unit unit : {Unit::nm, Unit::um, Unit::angstrom, Unit::m, Unit::ev, Unit::per_cm, Unit::thz}) {
        INFO(word_of(unit));
        // The difference quotient of x over one nanometre about 500 nm.
        const auto x_of = [&](double lambda_nm) {
            return is_reciprocal(unit) ? wavelength_nm(unit, 1.0) / lambda_nm : lambda_nm / wavelength_nm(unit, 1.0);
        };
        CHECK(units_per_nm(unit, 500.0) == Approx(std::abs(x_of(500.5) - x_of(499.5))).epsilon(1e-5));
    }
}

TEST_CASE("a unit is read from a column's name where it is there once") {
    const std::pair<const char*, Unit> names[] = {{"nm", Unit::nm},
                                                  {"wavelength_nm", Unit::nm},
                                                  {"Wavelength (nm)", Unit::nm},
                                                  {"wavelength_um", Unit::um},
                                                  {"lambda [\xc2\xb5m]", Unit::um},
                                                  {"\xce\xbcm", Unit::um},
                                                  {"Wavelength [microns]", Unit::um},
                                                  {"Wavelength (\xc3\x85)", Unit::angstrom},
                                                  {"angstrom", Unit::angstrom},
                                                  {"WL (A)", Unit::angstrom},
                                                  {"Energy (eV)", Unit::ev},
                                                  {"wavenumber (cm^-1)", Unit::per_cm},
                                                  {"cm-1", Unit::per_cm},
                                                  {"1/cm", Unit::per_cm},
                                                  {"frequency_THz", Unit::thz},
                                                  {"wavelength (m)", Unit::m}};
    for (const auto& [name, unit] : names) {
        INFO(name);
        REQUIRE(unit_in(name));
        CHECK(*unit_in(name) == unit);
    }
    for (const char* name : {"wavelength", "lambda", "wl", "w", "a", "nm or eV", "number", "1"}) {
        INFO(name);
        CHECK_FALSE(unit_in(name));
    }
}

TEST_CASE("tables in other units become spectra over nm") {
    const Values nm{400, 500, 800}, values{1, 2, 3};
    const std::string tables[] = {"wavelength_um,v\n0.4,1\n0.5,2\n0.8,3\n", "angstrom,v\n4000,1\n5000,2\n8000,3\n",
                                  "wavenumber_cm-1,v\n12500,3\n20000,2\n25000,1\n",
                                  "E (eV),v\n3.09960496,1\n2.47968397,2\n1.54980248,3\n",
                                  "wl,v\num,1\n0.4,1\n0.5,2\n0.8,3\n"};
    for (const std::string& text : tables) {
        INFO(text);
        const Spectrum spectrum = read_column(parse_csv(text, "t.csv"), "v", Outside::zero, {}).spectrum;
        REQUIRE(spectrum.lambda_nm.size() == 3);
        for (std::size_t i = 0; i < 3; ++i) CHECK(spectrum.lambda_nm[i] == Approx(nm[i]).epsilon(1e-8));
        CHECK(spectrum.value == values);
    }
}

TEST_CASE("a unit that is said has the last word, and values may be per that unit") {
    const CsvTable table = parse_csv("wavelength,v\n0.4,1\n0.8,2\n", "t.csv");
    const ColumnSpectrum um = read_column(table, "v", Outside::zero, {Unit::um, Per::unit, {}});
    CHECK(um.spectrum.value == Values{1e-3, 2e-3});
    CHECK(um.remarks.empty());
    const CsvTable named = parse_csv("wavelength_nm,v\n2,1\n3,1\n", "t.csv");
    const ColumnSpectrum ev = read_column(named, "v", Outside::zero, {Unit::ev, {}, {}});
    CHECK(ev.spectrum.lambda_nm[0] == Approx(1239.84198 / 3));
    CHECK(ev.remarks == std::vector<std::string>{"t.csv: read in eV, while its column names say nm"});
    CHECK_THAT(ev.density_doubt, Catch::Matchers::StartsWith("values over eV are taken for values per nm"));
    const ColumnSpectrum per_ev = read_column(named, "v", Outside::zero, {Unit::ev, Per::unit, {}});
    CHECK(per_ev.spectrum.value[0] == Approx(1239.84198 / (413.280661 * 413.280661)).epsilon(1e-6));
    CHECK(per_ev.density_doubt.empty());
}

TEST_CASE("a table without a wavelength of light is refused, with the units in which it would have one") {
    const auto refused = [](const std::string& text) {
        return input_error([&] { csv_spectrum(parse_csv(text, "t.csv"), "2", Outside::hold); });
    };
    const std::string expected = "t.csv: expected wavelengths from 300 to 830 nm, got ";
    CHECK(refused("w,v\n0.3,1\n0.83,2\n") ==
          expected + "0.3 to 0.83 nm; if they are in um, say \"unit\" (--wavelength-unit)");
    CHECK(refused("w,v\n0.35,1\n2.5,2\n") ==
          expected + "0.35 to 2.5 nm; if they are in um or eV, say \"unit\" (--wavelength-unit)");
    CHECK(refused("w,v\n3000,1\n8300,2\n") ==
          expected + "3000 to 8300 nm; if they are in angstrom, say \"unit\" (--wavelength-unit)");
    CHECK(refused("w,v\n2,1\n4,2\n") == expected + "2 to 4 nm; if they are in eV, say \"unit\" (--wavelength-unit)");
    CHECK(refused("w,v\n900,1\n1700,2\n") == expected + "900 to 1700 nm");
    const auto unsaid = [](const std::string& text) {
        return input_error([&] { read_column(parse_csv(text, "t.csv"), "v", Outside::hold, {}); });
    };
    // Reaches 300 nm as it stands, but no lamp or paper is tabulated from 0.2 nm on.
    CHECK_THAT(unsaid("w,v\n0.2,1\n500,2\n"), Catch::Matchers::Contains("if they are in um or eV"));
}
