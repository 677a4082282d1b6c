// What the text above a table says of its columns. Every table that is read has the value 1 at 400 nm, 2 at 500 nm and
// 3 at 800 nm: 3.09960496, 2.47968397 and 1.54980248 eV, 749.481145, 599.584916 and 374.7405725 THz, by h c =
// 1239.84198 eV nm and c = 299792.458 nm THz.
#include "host/core/csv_headings.hpp"
#include "host/core/csv_spectrum.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

struct Table {
    const char *column, *text;
};

ColumnSpectrum read(const Table& table, const SampleRules& rules = {}) {
    return read_column(parse_csv(table.text, "t.csv"), table.column, Outside::zero, rules);
}

void check_values(const Table& table, const SampleRules& rules = {}) {
    INFO(table.text);
    const Spectrum spectrum = read(table, rules).spectrum;
    REQUIRE(spectrum.lambda_nm.size() == 3);
    const double lambda_nm[] = {400, 500, 800};
    for (std::size_t i = 0; i < 3; ++i) CHECK(spectrum.lambda_nm[i] == Approx(lambda_nm[i]).epsilon(1e-8));
    CHECK(spectrum.value == std::vector<double>{1, 2, 3});
}

void check_refused(const Table& table, const std::string& expected) {
    INFO(table.text);
    CHECK_THAT(input_error([&] { read(table); }), Contains(expected));
}

}  // namespace

TEST_CASE("a column has the wavelengths that stand on its left") {
    const Table tables[] = {
        {"Abs2", "Red,,Blue,\nWavelength (nm),Abs,Wavelength (nm),Abs2\n300,7,800,3\n310,7,500,2\n320,7,400,1\n"},
        {"Abs", "Wavelength (nm),Abs,Wavelength (nm),Abs2\n400,1,830,7\n500,2,820,7\n800,3,810,7\n"},
        {"4", "nm,T,nm,R\n600,7,400,1\n610,7,500,2\n620,7,800,3\n"},
        {"b", "lambda,a,wavelength (um),b\n600,7,0.4,1\n610,7,0.5,2\n620,7,0.8,3\n"},
        {"b", "nm,a,nm,b\n600,7,400,1\n610,7,500,2\n,,800,3\n"},
        {"a", "nm,a,nm,b\n400,1,600,7\n500,2,610,7\n800,3,620,7\n,,630,7\n"},
        {"v", "nm,Energy (eV),v\n400,3.0996,1\n500,2.4797,2\n800,1.5498,3\n"},
        {"v", "index,wavelength,v\n300,400,1\n301,500,2\n302,800,3\n"},
        {"v", "pixel;nm;v\n0;400;1\n1;500;2\n2;800;3\n"},
        {"v", "v,wavelength\n1,400\n2,500\n3,800\n"},
        {"R", "wavelength,fwhm,R\nnm,nm,%\n400,7,1\n500,7,2\n800,7,3\n"},
    };
    for (const Table& table : tables) check_values(table);
}

TEST_CASE("a table is refused where it is unclear which wavelengths a column has") {
    const std::string unclear = "it is unclear which column has the wavelengths of column ";
    check_refused({"4", "X,Y,X,Y\n300,7,800,3\n310,7,500,2\n320,7,400,1\n"}, unclear + "4: column 3");
    check_refused({"Y2", "X1,Y1,X2,Y2\n300,7,800,3\n310,7,500,2\n320,7,400,1\n"}, unclear + "4: column 3");
    check_refused({"4", "red,,blue,\n300,7,600,3\n310,7,590,2\n320,7,580,1\n330,7,570,1\n"}, unclear + "4: column 3");
    check_refused({"b", "nm,nm,a,b\n400,600,1,2\n500,610,1,2\n800,620,1,2\n"}, unclear + "4: column 2");
    check_refused({"3", "nm,T,nm,R\n400,7,400,1\n500,7,500,2\n"}, "column 3, \"nm\", has wavelengths");
    check_refused({"b", "nm,a,nm,b\n400,7,,1\n500,7,500,2\n"}, "t.csv:2: b: expected a wavelength in column 3");
    check_refused({"b", "nm,a,nm,b\n400,7,400,1\n500,7,350,2\n800,7,500,2\n"},
                  "t.csv:4: b: expected wavelengths in column 3 that increase, or decrease, throughout");
    check_values({"4", "X,Y,X,Y\n400,7,400,1\n500,7,500,2\n800,7,800,3\n"});
}

TEST_CASE("a unit is read from any line above the table") {
    const Table tables[] = {
        {"v", "Frequency (THz),v\n749.481145,1\n599.584916,2\n374.7405725,3\n"},
        {"2", "Frequency (THz) R\n749.481145 1\n599.584916 2\n374.7405725 3\n"},
        {"R", "# Frequency (THz), R\n# -----\n749.481145 1\n599.584916 2\n374.7405725 3\n"},
        {"2", "# Frequency (THz), R\n# measured in spring 2019\n749.481145 1\n599.584916 2\n374.7405725 3\n"},
        {"Sample", "Frequency\tR\nTHz\t1\n\tSample\n749.481145\t1\n599.584916\t2\n374.7405725\t3\n"},
        {"R", "Frequency\tR\nTHz\t1\n\tSample\n749.481145\t1\n599.584916\t2\n374.7405725\t3\n"},
        {"R", "Energy,R\neV,%\n3.09960496,1\n2.47968397,2\n1.54980248,3\n"},
        {"v", "# wavelength in um\nx,v\n0.4,1\n0.5,2\n0.8,3\n"},
        {"v", "# Energy (eV) of the lamp's line: 2.3\nwavelength,v\n400,1\n500,2\n800,3\n"},
        {"v", "slit 25 um\nwavelength,v\n400,1\n500,2\n800,3\n"},
        {"v", "Path (um)\t10\nEnergy of the lamp:\t3\nx\tv\n400\t1\n500\t2\n800\t3\n"},
        {"2", "Integration Time (sec): 0.1\n>>>>>Begin Spectral Data<<<<<\n400\t1\n500\t2\n800\t3\n"},
        {"2", "# Temperature: 25\n400 1\n500 2\n800 3\n"},
        {"v", "Time\t10\nx\tv\n400\t1\n500\t2\n800\t3\n"},
        {"v", "1/cm,v\n25000,1\n20000,2\n12500,3\n"},
        {"%R", "Sample:\tX\nData points\t3\nnm\t%R\n400\t1\n500\t2\n800\t3\n"},
    };
    for (const Table& table : tables) check_values(table);
}

TEST_CASE("a first column that is named as no wavelength is refused, unless its unit is said") {
    for (const char* name : {"Frequency", "frequency", "Frequency (10^12 Hz)", "Energy (kJ/mol)", "Energy (meV)",
                             "photon energy", "Wavenumber (m^-1)", "pixel", "time", "meV"}) {
        INFO(name);
        const std::string text = std::string(name) + ",v\n749.481145,1\n599.584916,2\n374.7405725,3\n";
        check_refused({"v", text.c_str()}, "t.csv: column 1 is named \"" + std::string(name) +
                                               "\": expected wavelengths, or energies in eV, wavenumbers in cm-1 or "
                                               "frequencies in THz");
        check_values({"v", text.c_str()}, {WavelengthUnit::thz, {}, {}});
    }
    check_refused({"2", "Frequency R corrected\n749 1\n599 2\n"}, "column 1 is named \"Frequency R corrected\"");
}

TEST_CASE("what is in percent, or per centimetre, is found in any line above the table") {
    struct Case {
        const char *text, *said;
    };
    const Case percent[] = {
        {"wl,%R\n400,1\n", "%R"},
        {"wl,R percent\n400,1\n", "R percent"},
        {"wl;R\nnm;%\n400;1\n", "%"},
        {"wavelength;R\nnm;%\n400;1\n", "%"},
        {"Reflectance in %\nwl;R\n400;1\n", "Reflectance in %"},
        {"# all values in percent\nwl;R\n400;1\n", "all values in percent"},
        {"Humidity: 40 %\nwl;R\n400;1\n", ""},
        {"Humidity\t40 %\nwl\tR\n400\t1\n", ""},
        {"R1 in %\nwl\tR\n400\t1\n", "R1 in %"},
        {"wl,R,%T\n400,1,1\n", ""},
    };
    for (const Case& c : percent) {
        INFO(c.text);
        CHECK(percent_above(parse_csv(c.text, "t.csv"), 1) == c.said);
    }
    const Case per_cm[] = {
        {"wavelength (nm),mua (cm-1)\n400,1\n", "mua (cm-1)"},
        {"nm,mus (1/cm)\n400,1\n", "mus (1/cm)"},
        {"nm,mus [cm^-1]\n400,1\n", "mus [cm^-1]"},
        {"nm,mus [cm\xe2\x81\xbb\xc2\xb9]\n400,1\n", "mus [cm\xe2\x81\xbb\xc2\xb9]"},
        {"nm,mus [/cm]\n400,1\n", "mus [/cm]"},
        {"nm,sigma_per_cm\n400,1\n", "sigma_per_cm"},
        {"wl;a\nnm;cm-1\n400;1\n", "cm-1"},
        {"# absorption in cm-1\nwl;a\n400;1\n", "absorption in cm-1"},
        {"# from cm-1 to mm-1\nwl;a\n400;1\n", ""},
        {"# resolution 4 cm-1\nwavenumber (cm-1);a\n20000;1\n", ""},
        {"Resolution\t4 cm-1\nwl\ta\n400\t1\n", ""},
        {"nm,mua (mm-1)\n400,1\n", ""},
        {"nm,irradiance (W/cm2)\n400,1\n", ""},
    };
    for (const Case& c : per_cm) {
        INFO(c.text);
        CHECK(per_cm_above(parse_csv(c.text, "t.csv"), 1) == c.said);
    }
}
