#include <cmath>

#include "host/subsurface/distance_mixture.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"

using namespace stokes;

namespace {

TableGrid two_wavelengths() {
    TableGrid grid;
    grid.lambda_nm = {400.0, 500.0};
    return grid;
}

float at(const MediumMixture& mixture, unsigned row, unsigned i) {
    return mixture.rows[row * mixture.record.count + i];
}

}  // namespace

// sigma_t 1 and 4, sigma_s 0.5 and 4: weights 1 and 1/16, 1 and 1/4, 1/2 and 1/4, 1/2 and 1.
TEST_CASE("a mixture weighs its wavelengths as the envelopes of the power functions do", "[distance_mixture]") {
    const MediumSpectra medium{
        "m", {{400.0, 500.0}, {0.5, 4.0}, Outside::hold}, {{400.0, 500.0}, {0.5, 0.0}, Outside::hold}};
    const MediumMixture mixture = make_medium_mixture(medium, 11, two_wavelengths());
    CHECK(mixture.record.first == 11);
    CHECK(mixture.record.count == 2);
    CHECK(mixture.record.r_max_mm == 9.9f);
    CHECK(mixture.record.theta_max_deg == 89.1f);
    CHECK(double(mixture.record.reach_f_mm) == Approx((1.0 + 1.0 / 16.0) / (1.0 + 1.0 / 4.0)));
    CHECK(double(mixture.record.reach_s_mm) == Approx((0.5 + 0.25) / (0.5 + 1.0)));
    REQUIRE(mixture.rows.size() == STOKES_MIX_ROWS * 2);
    CHECK(at(mixture, STOKES_MIX_SIGMA_T, 0) == 1.0f);
    CHECK(at(mixture, STOKES_MIX_SIGMA_T, 1) == 4.0f);
    CHECK(double(at(mixture, STOKES_MIX_SIGMA_TR, 0)) == Approx(std::sqrt(1.5)));
    CHECK(at(mixture, STOKES_MIX_SIGMA_TR, 1) == 0.0f);
    CHECK(double(at(mixture, STOKES_MIX_V_HIGH, 1)) == Approx(std::asinh(4.0 * 9.9)));
    CHECK(double(at(mixture, STOKES_MIX_V_LOW, 1)) == Approx(std::asinh(4.0 * 9.9 * 3.0 / 7.0)));
    CHECK(double(at(mixture, STOKES_MIX_F_DENSE, 0)) == Approx(16.0 / 17.0));
    CHECK(double(at(mixture, STOKES_MIX_F_THIN, 0)) == Approx(4.0 / 5.0));
    CHECK(double(at(mixture, STOKES_MIX_S_DENSE, 0)) == Approx(2.0 / 3.0));
    CHECK(double(at(mixture, STOKES_MIX_S_THIN, 0)) == Approx(1.0 / 3.0));
    const double a = std::sqrt(1.5), one = (std::asinh(9.9) - std::asinh(9.9 * 3.0 / 7.0)) * (1.0 + a) * std::exp(-a);
    const double four = 4.0 * (std::asinh(39.6) - std::asinh(39.6 * 3.0 / 7.0));
    CHECK(double(at(mixture, STOKES_MIX_M, 0)) == Approx(one / (one + four)));
    for (unsigned row = STOKES_MIX_F_DENSE; row < STOKES_MIX_ROWS; ++row) CHECK(at(mixture, row, 1) == 1.0f);
}

TEST_CASE("a mixture of a medium that does not scatter reaches nowhere by single scattering", "[distance_mixture]") {
    const MediumMixture mixture = make_medium_mixture({"ink", Spectrum::constant(0.0), Spectrum::constant(1.0)});
    CHECK(mixture.record.reach_s_mm == 0.0f);
    for (const float value : mixture.rows) CHECK(std::isfinite(value));
}

TEST_CASE("a mixture complains about its medium as a table does", "[distance_mixture]") {
    const MediumSpectra vacuum{"vacuum", Spectrum::constant(0.0), Spectrum::constant(0.0)};
    const std::string complaint = input_error([&] { make_medium_mixture(vacuum); });
    CHECK(complaint == input_error([&] { make_fluorescence_table(vacuum); }));
    CHECK(complaint.find("vacuum") != std::string::npos);
    CHECK_FALSE(input_error([] {
                    make_medium_mixture({"m", Spectrum::constant(1.0), Spectrum::constant(0.0), 1.0, 4.0});
                }).empty());
}
