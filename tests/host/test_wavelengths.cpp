#include <cmath>
#include <functional>
#include <vector>

#include "host/core/error.hpp"
#include "host/render/pass_spectra.hpp"
#include "host/render/wavelengths.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

constexpr int first_nm = 300, last_nm = 780, all = last_nm - first_nm + 1;

// A spectrum that changes slowly, and one that is nothing but a line of 3 nm on a weak ground.
double smooth(int lambda_nm) { return 1.0 + 0.5 * std::sin(lambda_nm * 0.02); }
double spiky(int lambda_nm) { return std::abs(lambda_nm - 546) <= 1 ? 200.0 : 0.05; }

// Excitation and emission that overlap between 420 and 560 nm.
Fluorophore overlapping() {
    Fluorophore fluorophore;
    fluorophore.excitation = {{300.0, 460.0, 560.0}, {0.6, 1.0, 0.0}, Outside::zero};
    fluorophore.emission = {{420.0, 520.0, 700.0}, {0.0, 1.0, 0.0}, Outside::zero};
    return fluorophore;
}

}  // namespace

TEST_CASE("a wavelength set is sixteen different integers of the range, in order", "[wavelengths]") {
    for (std::uint32_t pass = 0; pass < 2000; ++pass) {
        const WavelengthSet set = draw_wavelengths(11, pass, first_nm, last_nm);
        REQUIRE(set.front() >= first_nm);
        REQUIRE(set.back() <= last_nm);
        for (std::size_t i = 1; i < set.size(); ++i) REQUIRE(set[i] > set[i - 1]);
    }
}

TEST_CASE("a wavelength set depends on seed and pass alone", "[wavelengths]") {
    const WavelengthSet set = draw_wavelengths(3, 7, first_nm, last_nm);
    draw_wavelengths(4, 8, first_nm, last_nm);
    CHECK(draw_wavelengths(3, 7, first_nm, last_nm) == set);
    CHECK(draw_wavelengths(3, 8, first_nm, last_nm) != set);
    CHECK(draw_wavelengths(4, 7, first_nm, last_nm) != set);
    CHECK(draw_wavelengths(7, 3, first_nm, last_nm) != set);
}

TEST_CASE("a range of sixteen wavelengths is drawn whole, a smaller one is refused", "[wavelengths]") {
    const WavelengthSet set = draw_wavelengths(1, 0, 400, 415);
    for (int i = 0; i < STOKES_WAVELENGTHS; ++i) CHECK(set[static_cast<std::size_t>(i)] == 400 + i);
    CHECK(image_weight_nm(400, 415) == 1.0);
    CHECK(pair_weight_nm(400, 415) == 1.0);
    CHECK_THROWS_AS(draw_wavelengths(1, 0, 400, 414), InputError);
}

TEST_CASE("the weights are those of section 2", "[wavelengths]") {
    CHECK(image_weight_nm(first_nm, last_nm) == 481.0 / 16.0);
    CHECK(pair_weight_nm(first_nm, last_nm) == 32.0);
}

// Drawn without replacement, the covariance of the counts is (1 - n/N) N/(N-1) times that of a multinomial,
// and so is Pearson's sum. One two-sided test, wrong once in 1000.
TEST_CASE("every wavelength is in a set equally often", "[wavelengths]") {
    constexpr std::uint32_t sets = 30000;
    std::vector<double> counts(all, 0.0);
    for (std::uint32_t pass = 0; pass < sets; ++pass)
        for (const int lambda_nm : draw_wavelengths(5, pass, first_nm, last_nm)) counts[lambda_nm - first_nm] += 1.0;
    const double share = double(STOKES_WAVELENGTHS) / all, expected = sets * share;
    double sum = 0.0;
    for (const double count : counts) sum += (count - expected) * (count - expected) / expected;
    const double p = chi_square_tail(sum / (1.0 - share) * (all - 1) / all, all - 1);
    CHECK(p > 5e-4);
    CHECK(p < 1.0 - 5e-4);
}

// 3.5 standard errors: each is wrong by chance once in 2000. The standard error itself is below 2 % of the
// sum.
TEST_CASE("the image weight makes the sum over a set estimate the sum over all wavelengths", "[wavelengths]") {
    const double weight = image_weight_nm(first_nm, last_nm);
    for (const auto& g : {std::function<double(int)>(smooth), std::function<double(int)>(spiky)}) {
        double full = 0.0;
        for (int lambda_nm = first_nm; lambda_nm <= last_nm; ++lambda_nm) full += g(lambda_nm);
        Sample estimates;
        for (std::uint32_t pass = 0; pass < 40000; ++pass) {
            double sum = 0.0;
            for (const int lambda_nm : draw_wavelengths(17, pass, first_nm, last_nm)) sum += g(lambda_nm);
            estimates.add(weight * sum);
        }
        CHECK(estimates.standard_error() < 0.02 * full);
        CHECK(std::abs(estimates.z(full)) < 3.5);
    }
}

// sum over ex < em of Phi(ex) E(ex) F(em), for each em that is in the set: the estimate by reradiation_rows,
// averaged over the sets that hold em, against the full sum. Over the whole range it would hold for any em;
// those chosen have few, some and many wavelengths below them. In all 2 x 3 comparisons at 3.5 standard
// errors.
TEST_CASE("the pair weight makes re-radiated flux unbiased given the emitted wavelength", "[wavelengths]") {
    const Fluorophore fluorophore = overlapping();
    const double weight = pair_weight_nm(first_nm, last_nm);
    for (const auto& flux : {std::function<double(int)>(smooth), std::function<double(int)>(spiky)}) {
        std::vector<Sample> estimates(all);
        for (std::uint32_t pass = 0; pass < 200000; ++pass) {
            const WavelengthSet set = draw_wavelengths(23, pass, first_nm, last_nm);
            for (std::size_t j = 0; j < set.size(); ++j) {
                if (set[j] % 60 != 10) continue;  // 430, 490, 550, 610, 670
                double sum = 0.0;
                for (std::size_t i = 0; i < set.size(); ++i)
                    if (set[i] < set[j])
                        sum += flux(set[i]) * fluorophore.excitation.at(set[i]) * fluorophore.emission.at(set[j]);
                estimates[set[j] - first_nm].add(weight * sum);
            }
        }
        for (const int em : {490, 550, 610}) {
            double full = 0.0;
            for (int ex = first_nm; ex < em; ++ex)
                full += flux(ex) * fluorophore.excitation.at(ex) * fluorophore.emission.at(em);
            const Sample& sample = estimates[em - first_nm];
            CAPTURE(em, full, sample.mean(), sample.standard_error());
            CHECK(sample.count() > 6000);
            CHECK(sample.standard_error() < 0.06 * full);
            CHECK(std::abs(sample.z(full)) < 3.5);
        }
    }
}

TEST_CASE("re-radiation rows hold eq. 1-2 with the pair weight, and nothing at or below the excitation",
          "[wavelengths]") {
    Fluorophore fluorophore = overlapping();
    fluorophore.conversion = 0.013;
    const WavelengthSet set = draw_wavelengths(2, 9, 420, 560);  // within the overlap
    const auto rows = reradiation_rows(fluorophore, Transport::paper, set, 32.0);
    for (std::size_t ex = 0; ex < set.size(); ++ex)
        for (std::size_t em = 0; em < set.size(); ++em) {
            const double expected =
                em > ex ? 0.013 * 32.0 * fluorophore.excitation.at(set[ex]) * fluorophore.emission.at(set[em]) : 0.0;
            CHECK(static_cast<double>(rows[ex].v[em]) == Approx(expected).epsilon(1e-6));
            if (em <= ex) CHECK(rows[ex].v[em] == 0.0f);
        }
    CHECK(rows[0].v[1] > 0.0f);
}

// sum over a < b < c of f(a) g(b) h(c): light re-radiated twice, so that three wavelengths must be in the set. With
// N/n, (N-1)/(n-1) and (N-2)/(n-2) the mean over sets is the full sum; with the pair weight twice it would fall short
// by 1 - (N-1)(n-2)/((N-2)(n-1)) = 6.5 %.
TEST_CASE("the k-th conversion of a chain weighs (N-k)/(n-k)", "[wavelengths]") {
    const auto f = [](int l) { return l < 420 ? 1.0 : 0.1; };
    const auto g = [](int l) { return l > 450 && l < 620 ? 1.0 : 0.05; };
    const auto h = [](int l) { return l > 560 ? 1.0 : 0.02; };
    double full = 0.0, below = 0.0, pairs = 0.0;
    for (int l = first_nm; l <= last_nm; ++l) {
        full += pairs * h(l);
        pairs += below * g(l);
        below += f(l);
    }
    const double n = STOKES_WAVELENGTHS, all_nm = last_nm - first_nm + 1;
    const double weight =
        image_weight_nm(first_nm, last_nm) * pair_weight_nm(first_nm, last_nm) * (all_nm - 2.0) / (n - 2.0);
    Sample estimates;
    for (std::uint32_t pass = 0; pass < 60000; ++pass) {
        double sum = 0.0, b = 0.0, ab = 0.0;
        for (const int l : draw_wavelengths(31, pass, first_nm, last_nm)) {
            sum += ab * h(l);
            ab += b * g(l);
            b += f(l);
        }
        estimates.add(weight * sum);
    }
    CAPTURE(full, estimates.mean(), estimates.standard_error());
    CHECK(estimates.standard_error() < 0.005 * full);
    CHECK(std::abs(estimates.z(full)) < 3.5);
}
