#include <cmath>

#include "host/core/error.hpp"
#include "host/core/srgb.hpp"
#include "host/image/colour.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;

namespace {

void check_equal(const glm::dvec3& found, const glm::dvec3& expected, double margin) {
    for (int c = 0; c < 3; ++c) CHECK(found[c] == Approx(expected[c]).margin(margin).epsilon(0.0));
}

Spectrum line(double lambda_nm) { return {{lambda_nm - 1.0, lambda_nm, lambda_nm + 1.0}, {0.0, 1.0, 0.0}}; }

}  // namespace

// CIE 018:2019, table 1: the functions are normalised to equal sums; 106.857 at 1 nm.
TEST_CASE("the colour matching functions have the standard's sums and peak") {
    const ColourMatching& matching = cie1931();
    CHECK(matching.x.sum_1nm(360, 830) == Approx(106.865).margin(0.001));
    CHECK(matching.y.sum_1nm(360, 830) == Approx(106.857).margin(0.001));
    CHECK(matching.z.sum_1nm(360, 830) == Approx(106.892).margin(0.001));
    CHECK(matching.y.at(555.0) == 1.0);
    CHECK(matching.y.maximum() == Approx(1.0).margin(1e-4));
    CHECK(matching.y.at(300.0) == 0.0);
    CHECK(matching.y.at(900.0) == 0.0);
}

// IEC 61966-2-1 and ITU-R BT.709 give the primaries; the exact fractions that follow from them are published
// in W3C CSS Color 4, section 18 (sample code, lin_sRGB conversion).
TEST_CASE("the Rec. 709 matrix is the published one") {
    const glm::dvec3 rows[3] = {{12831.0 / 3959.0, -329.0 / 214.0, -1974.0 / 3959.0},
                                {-851781.0 / 878810.0, 1648619.0 / 878810.0, 36519.0 / 878810.0},
                                {705.0 / 12673.0, -2585.0 / 12673.0, 705.0 / 667.0}};
    for (int column = 0; column < 3; ++column)
        check_equal(rec709_from_xyz()[column], {rows[0][column], rows[1][column], rows[2][column]}, 1e-12);
}

// ITU-R BT.709-6 item 3.2: E'Y = 0.2126 R + 0.7152 G + 0.0722 B.
TEST_CASE("luminance weights are those of Rec. 709") {
    CHECK(xyz_of_rec709({1, 0, 0}).y == Approx(0.2126).margin(5e-5));
    CHECK(xyz_of_rec709({0, 1, 0}).y == Approx(0.7152).margin(5e-5));
    CHECK(xyz_of_rec709({0, 0, 1}).y == Approx(0.0722).margin(5e-5));
    check_equal(xyz_of_rec709(rec709_of_xyz({0.3, 0.4, 0.5})), {0.3, 0.4, 0.5}, 1e-14);
}

// Ottosson's table of XYZ -> Lab pairs, given to three decimals.
TEST_CASE("Oklab has its author's values and inverts") {
    check_equal(oklab_of_rec709(rec709_of_xyz({0.950, 1.000, 1.089})), {1.000, 0.000, 0.000}, 2e-3);
    check_equal(oklab_of_rec709(rec709_of_xyz({1.000, 0.000, 0.000})), {0.450, 1.236, -0.019}, 2e-3);
    check_equal(oklab_of_rec709(rec709_of_xyz({0.000, 1.000, 0.000})), {0.922, -0.671, 0.263}, 2e-3);
    check_equal(oklab_of_rec709(rec709_of_xyz({0.000, 0.000, 1.000})), {0.153, -1.415, -0.449}, 2e-3);
    check_equal(rec709_of_oklab(oklab_of_rec709({0.7, -0.1, 3.0})), {0.7, -0.1, 3.0}, 1e-12);
}

// CIE 15:2018 table T.3: chromaticity of D65 for the 2-degree observer x = 0.31272, y = 0.32903.
TEST_CASE("the D65 spectrum is white") {
    const glm::dvec3 xyz = xyz_of(cie_spectrum("illuminants_1nm.csv", "D65"));
    const double sum = xyz.x + xyz.y + xyz.z;
    CHECK(xyz.x / sum == Approx(0.31272).margin(1e-5));
    CHECK(xyz.y / sum == Approx(0.32903).margin(1e-5));
    const glm::dvec3 rgb = rec709_of_xyz(xyz) / xyz.y;
    check_equal(rgb, {1.0, 1.0, 1.0}, 1e-3);
}

// One nanometre of 1 W m^-2 sr^-1 nm^-1. At 555 nm the table has x 0.51205, y 1, z 0.00575 (CIE 018:2019).
TEST_CASE("monochromatic light has the table's colour and 683.002 lm/W") {
    check_equal(xyz_of(line(555.0)), 683.002 * glm::dvec3(0.51205, 1.0, 0.00575), 1e-6);
    const glm::dvec3 green = rec709_of_xyz(xyz_of(line(520.0)));
    CHECK(green.r < 0.0);
    CHECK(green.g > 0.0);
    CHECK(green.b < 0.0);
}

TEST_CASE("a constant spectrum has nearly equal X, Y and Z") {
    const glm::dvec3 xyz = xyz_of(Spectrum::constant(1.0));
    CHECK(xyz.y == Approx(683.002 * 106.857).epsilon(1e-5));
    CHECK(xyz.x / xyz.y == Approx(1.0).margin(1e-3));
    CHECK(xyz.z / xyz.y == Approx(1.0).margin(1e-3));
}

TEST_CASE("an absent table or column is an input error") {
    CHECK_THROWS_WITH(cie_spectrum("none.csv", "x"), "tables/cie/none.csv: no such table in this program");
    CHECK_THROWS_WITH(cie_spectrum("illuminants_1nm.csv", "D99"), Catch::Contains("no column \"D99\""));
}

// IEC 61966-2-1: 18 % grey encodes to 0.4613561; the pieces meet at 0.0031308.
TEST_CASE("the sRGB transfer function inverts and is continuous") {
    CHECK(srgb_encode(0.0) == 0.0);
    CHECK(srgb_encode(1.0) == Approx(1.0).margin(1e-12));
    CHECK(srgb_encode(0.18) == Approx(0.4613561).margin(1e-6));
    CHECK(srgb_encode(0.0031308) == Approx(srgb_encode(0.0031309)).margin(2e-6));
    for (int i = 0; i <= 1000; ++i) CHECK(srgb_encode(srgb_decode(i / 1000.0)) == Approx(i / 1000.0).margin(1e-6));
}
