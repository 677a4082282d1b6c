// Means over nanometres against integrals by hand.
#include "host/core/spectrum.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;

TEST_CASE("straight lines have their middle as the mean, but where they bend") {
    const Spectrum roof{{300, 400, 500}, {0, 10, 0}, Outside::zero};
    CHECK(roof.mean_1nm(350) == Approx(5.0));
    CHECK(roof.mean_1nm(350.25) == Approx(5.025));
    CHECK(roof.mean_1nm(400) == Approx(10.0 - 0.1 / 4));  // two halves, whose middles are 0.25 nm off
    const Spectrum constant = Spectrum::constant(0.7);
    CHECK(constant.mean_1nm(555) == 0.7);
    CHECK(constant.at_whole_nanometres().value == std::vector<double>{0.7});
}

// A triangle of base 0.4 nm and height 5 has the area 1.
TEST_CASE("a line between whole nanometres is not lost") {
    const Spectrum line{{300, 404.36, 404.56, 404.76, 800}, {0, 0, 5, 0, 0}, Outside::zero};
    const Spectrum grid = line.at_whole_nanometres();
    CHECK(grid.at(404) + grid.at(405) == Approx(1.0));
    CHECK(grid.at(404) == Approx(0.5 * 0.14 * (0.14 / 0.2 * 5.0)));  // up to 404.5 nm: a triangle of base 0.14 nm
    CHECK(grid.sum_1nm() == Approx(1.0));
}

TEST_CASE("the integral over many nanometres is that of the straight lines") {
    Spectrum comb;
    double area = 0.0;
    for (int i = 0; i <= 4000; ++i) {
        comb.lambda_nm.push_back(350.0 + 0.1 * i);
        comb.value.push_back(i < 10 || i > 3990 ? 0.0 : i % 37 == 5 ? 3.0 : 0.25 * (i % 3));
        if (i > 0) area += 0.05 * (comb.value[comb.value.size() - 2] + comb.value.back());
    }
    CHECK(comb.at_whole_nanometres().sum_1nm() == Approx(area));
}

TEST_CASE("where a table ends") {
    const Spectrum zero{{400, 700}, {1, 1}, Outside::zero}, hold{{400, 700}, {1, 2}, Outside::hold};
    CHECK(zero.mean_1nm(400) == Approx(1.0));  // half of it is in the table, whose end holds
    const Spectrum rises{{400, 410}, {0, 10}, Outside::zero};
    CHECK(rises.mean_1nm(400) == Approx(0.5 * 0.5 * 0.5));
    CHECK(rises.mean_1nm(410) == Approx(0.5 * 9.75 + 0.5 * 10));
    CHECK(zero.mean_1nm(399) == 0.0);
    CHECK(zero.mean_1nm(701) == 0.0);
    CHECK(hold.mean_1nm(399) == 1.0);
    CHECK(hold.mean_1nm(900) == 2.0);
    CHECK(hold.mean_1nm(400) == Approx(1.0 + 0.5 * 0.5 / 300 / 2));
    const Spectrum narrow{{404.9, 405.1}, {1, 1}, Outside::zero};
    CHECK(narrow.mean_1nm(405) == Approx(0.2));
    const Spectrum one{{404.75}, {8}, Outside::zero};
    CHECK(one.mean_1nm(405) == Approx(6.0));
    CHECK(one.mean_1nm(404) == Approx(2.0));
}
