#include <cmath>
#include <functional>
#include <vector>

#include "host/subsurface/paper_transport.hpp"
#include "host/subsurface/power_table.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;

namespace {

// The marble of the paper's scenes: Jensen et al. 2001, scattering halved, linear between the primaries'
// wavelengths.
MediumSpectra marble() {
    return {"marble",
            {{464.3, 549.1, 611.4}, {1.5, 1.31, 1.095}, Outside::hold},
            {{464.3, 549.1, 611.4}, {0.0071, 0.0041, 0.0021}, Outside::hold},
            1.5,
            1.0};
}

double value_at(const PowerTable& table, std::size_t r, std::size_t theta, std::size_t lambda) {
    return table.values[(r * 100 + theta) * 100 + lambda];
}

double simpson(double a, double b, double fa, double fm, double fb) { return (b - a) / 6.0 * (fa + 4.0 * fm + fb); }

double refine(const std::function<double(double)>& f, double a, double b, double fa, double fm, double fb, double whole,
              double tolerance, int depth) {
    const double m = 0.5 * (a + b), fl = f(0.5 * (a + m)), fr = f(0.5 * (m + b));
    const double left = simpson(a, m, fa, fl, fm), right = simpson(m, b, fm, fr, fb);
    const double change = left + right - whole;
    if (depth == 0 || (depth < 36 && std::abs(change) < 15.0 * tolerance)) return left + right + change / 15.0;
    return refine(f, a, m, fa, fl, fm, left, 0.5 * tolerance, depth - 1) +
           refine(f, m, b, fm, fr, fb, right, 0.5 * tolerance, depth - 1);
}

// Adaptive Simpson of the integrals exactly as printed, over t, split where s(t) is smallest; `offset` is
// taken out of the exponent to stay within the range of double. Shares nothing with the product's formulas.
double integral_over_t(double sigma_t, double r, double theta_deg, bool path_in_exponent, double offset) {
    const double sine = std::sin(theta_deg * M_PI / 180.0);
    const auto f = [&](double t) {
        const double s = std::sqrt(r * r + t * t - 2.0 * r * t * sine);
        return std::exp(-sigma_t * ((path_in_exponent ? t + s : s) - offset));
    };
    double sum = 0.0;
    const double split = r * sine, nearest = r * std::sqrt(1.0 - sine * sine);
    const double far = std::sqrt(45.0 / sigma_t * (2.0 * nearest + 45.0 / sigma_t));  // s = nearest + 45 / sigma_t
    std::vector<double> ends = {0.0, 0.5 * split, split};
    for (double step = 1e-3; step <= 1.0; step *= 10.0) ends.push_back(split + far * step);
    for (std::size_t i = 1; i < ends.size(); ++i) {
        const double a = ends[i - 1], b = ends[i], fa = f(a), fm = f(0.5 * (a + b)), fb = f(b);
        if (b > a) sum += refine(f, a, b, fa, fm, fb, simpson(a, b, fa, fm, fb), 1e-9 / sigma_t, 40);
    }
    return sum;
}

const std::vector<std::size_t> spread_r = {0, 1, 2, 7, 20, 50, 99};
const std::vector<std::size_t> spread_theta = {0, 1, 17, 50, 83, 97, 98, 99};

}  // namespace

// Expected values: worked by hand in the model's specification, to their printed digits.
TEST_CASE("power functions take their worked values", "[power_tables]") {
    const double sigma_s = 1.31, sigma_a = 0.0041, sigma_t = sigma_s + sigma_a;
    const RefractionAngle normal = RefractionAngle::from_degrees(0.0), oblique = RefractionAngle::from_degrees(30.0);
    CHECK(fluorescence_power(sigma_t, 0.0, normal) == Approx(0.76098).margin(0.5e-5));
    CHECK(fluorescence_power(sigma_t, 1.0, oblique) == Approx(0.56622).margin(0.5e-5));
    CHECK(single_power(sigma_s, sigma_t, 1.0, oblique) == Approx(0.020859).margin(0.5e-6));
    CHECK(multiple_power(sigma_a, sigma_t, dipole_boundary(1.0), 1.0) == Approx(0.093982).margin(0.5e-6));
}

TEST_CASE("the fluorescence factor exceeds 1 at grazing angles", "[power_tables]") {
    const PowerTable table = make_fluorescence_table(marble());
    CHECK(value_at(table, 20, 99, 80) == Approx(1.7).margin(0.05));  // 2 mm, 89.1 degrees, 700 nm
}

TEST_CASE("fluorescence and single scattering agree with adaptive Simpson of eq. 3 and 4", "[power_tables]") {
    const PowerTable fluorescence = make_fluorescence_table(marble()), single = make_single_table(marble());
    for (std::size_t r : spread_r)
        for (std::size_t theta : spread_theta)
            for (std::size_t lambda : {0, 40, 55, 99}) {
                const double r_mm = 0.1 * static_cast<double>(r), theta_deg = 0.9 * static_cast<double>(theta);
                const double sigma_s = fluorescence.medium.sigma_s[lambda];
                const double sigma_t = sigma_s + fluorescence.medium.sigma_a[lambda];
                const double nearest = r_mm * std::cos(theta_deg * M_PI / 180.0);  // smallest s(t)
                CAPTURE(r_mm, theta_deg, sigma_t);
                const double f = integral_over_t(sigma_t, r_mm, theta_deg, false, nearest);
                CHECK(value_at(fluorescence, r, theta, lambda) ==
                      Approx(f * std::exp(-sigma_t * nearest)).epsilon(1e-7));
                // t + s(t) is at least r.
                const double s = integral_over_t(sigma_t, r_mm, theta_deg, true, r_mm);
                CHECK(value_at(single, r, theta, lambda) ==
                      Approx(sigma_s / (4.0 * M_PI) * s * std::exp(-sigma_t * r_mm)).epsilon(1e-7));
            }
}

TEST_CASE("thin and dense media agree with adaptive Simpson too", "[power_tables]") {
    for (double sigma_t : {1e-3, 0.05, 8.0, 60.0})
        for (double r_mm : {0.0, 0.1, 1.0, 9.9})
            for (double theta_deg : {0.0, 45.0, 88.2, 89.1}) {
                const RefractionAngle theta = RefractionAngle::from_degrees(theta_deg);
                const double nearest = r_mm * std::cos(theta_deg * M_PI / 180.0);
                CAPTURE(r_mm, theta_deg, sigma_t);
                CHECK(fluorescence_power(sigma_t, r_mm, theta) ==
                      Approx(integral_over_t(sigma_t, r_mm, theta_deg, false, nearest) * std::exp(-sigma_t * nearest))
                          .epsilon(1e-6));
                CHECK(single_power(4.0 * M_PI, sigma_t, r_mm, theta) ==
                      Approx(integral_over_t(sigma_t, r_mm, theta_deg, true, r_mm) * std::exp(-sigma_t * r_mm))
                          .epsilon(1e-6));
            }
}

TEST_CASE("at normal incidence the fluorescence integral is r K_1(sigma_t r)", "[power_tables]") {
    for (double sigma_t : {0.01, 1.3141, 20.0})
        for (double r_mm = 0.1; r_mm < 9.95; r_mm += 0.1)
            CHECK(fluorescence_power(sigma_t, r_mm, RefractionAngle::from_degrees(0.0)) ==
                  Approx(r_mm * std::cyl_bessel_k(1.0, sigma_t * r_mm)).epsilon(1e-11));
}

TEST_CASE("at 90 degrees the integrals are elementary", "[power_tables]") {
    const RefractionAngle grazing = RefractionAngle::from_degrees(90.0);
    for (double sigma_t : {0.01, 1.3141, 20.0})
        for (double r_mm : {0.0, 0.1, 5.0}) {
            // s(t) = |r - t|
            CHECK(fluorescence_power(sigma_t, r_mm, grazing) ==
                  Approx((2.0 - std::exp(-sigma_t * r_mm)) / sigma_t).epsilon(1e-12));
            CHECK(single_power(4.0 * M_PI, sigma_t, r_mm, grazing) ==
                  Approx((r_mm + 0.5 / sigma_t) * std::exp(-sigma_t * r_mm)).epsilon(1e-12));
        }
}

TEST_CASE("multiple scattering is the dipole of eq. 5 as printed", "[power_tables]") {
    MediumSpectra medium = marble();
    for (double dipole_eta : {1.0, 1.5}) {
        medium.dipole_eta = dipole_eta;
        const PowerTable table = make_multiple_table(medium);
        const long double eta = dipole_eta;
        const long double f_dr = -1.440L / (eta * eta) + 0.710L / eta + 0.668L + 0.0636L * eta;
        const long double boundary = dipole_eta == 1.0 ? 1.0L : (1.0L + f_dr) / (1.0L - f_dr);
        for (std::size_t lambda : {0, 55, 99})
            for (std::size_t r : spread_r) {
                const long double sigma_a = table.medium.sigma_a[lambda];
                const long double sigma_t = table.medium.sigma_s[lambda] + sigma_a, r_mm = 0.1L * r;
                const long double d = 1.0L / (3.0L * sigma_t), sigma_tr = std::sqrt(3.0L * sigma_a * sigma_t);
                const long double z_r = 1.0L / sigma_t, z_v = z_r + 4.0L * boundary * d;
                const long double d_r = std::sqrt(r_mm * r_mm + z_r * z_r), d_v = std::sqrt(r_mm * r_mm + z_v * z_v);
                const long double expected =
                    (std::exp(-sigma_tr * d_r) / d_r - std::exp(-sigma_tr * d_v) / d_v) / (4.0L * std::acos(-1.0L) * d);
                CHECK(table.values[r * 100 + lambda] == Approx(static_cast<double>(expected)).epsilon(1e-10));
            }
    }
}

TEST_CASE("without absorption the dipole is the difference of two inverse distances", "[power_tables]") {
    // sigma_tr = 0; sigma_t = 1: z_r = 1, z_v = 7/3, 1/(4 pi D) = 3/(4 pi).
    CHECK(multiple_power(0.0, 1.0, 1.0, 0.0) == Approx(3.0 / (4.0 * M_PI) * (1.0 - 3.0 / 7.0)).epsilon(1e-14));
    // Far away the sources' distances differ by less than double precision resolves: (z_v^2 - z_r^2)/(2 r^3).
    CHECK(multiple_power(0.0, 1.0, 1.0, 1e6) == Approx(3.0 / (4.0 * M_PI) * (40.0 / 9.0) / 2e18).epsilon(1e-9));
}

// E_2(1) = exp(-1) - E_1(1), E_1(1) = 0.219383934395520 (Abramowitz and Stegun, table 5.1); E_2(0) = 1; far
// out E_2(z) ~ exp(-z)/(z + 2).
TEST_CASE("the exponential integral is exact on both sides of its switch", "[power_tables]") {
    CHECK(exponential_integral_2(0.0) == 1.0);
    CHECK(exponential_integral_2(1.0) == Approx(std::exp(-1.0) - 0.219383934395520).epsilon(1e-13));
    CHECK(exponential_integral_2(std::nextafter(1.0, 0.0)) == Approx(exponential_integral_2(1.0)).epsilon(1e-13));
    CHECK(exponential_integral_2(0.5) == Approx(std::exp(-0.5) + 0.5 * std::expint(-0.5)).epsilon(1e-13));
    CHECK(exponential_integral_2(500.0) == Approx(std::exp(-500.0) / 502.0).epsilon(1e-5));
}
