// The virtual spectrofluorometer, and with it the transport models, against exact transport theory (PHYSICS
// sections 4 and 5). Comparisons are at 3 standard errors, those of the means over at least 32 batches: one
// in 200 fails by chance, for a given seed always or never.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/render/probe.hpp"
#include "host/subsurface/quadrature.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/half_space.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

ProbeMaterial medium_of(double sigma_t, double albedo, double eta = 1.0) {
    ProbeMaterial material;
    material.name = "medium";
    material.medium.emplace();
    material.medium->sigma_s = Spectrum::constant(sigma_t * albedo);
    material.medium->sigma_a = Spectrum::constant(sigma_t * (1.0 - albedo));
    material.medium->eta = eta;
    material.fresnel = eta > 1.0;
    return material;
}

// Emits between 400 and 520 nm, takes up below.
Fluorophore dye() {
    Fluorophore fluorophore;
    fluorophore.name = "dye";
    fluorophore.excitation = {{300.0, 450.0, 520.0}, {1.0, 0.8, 0.0}, Outside::zero};
    fluorophore.emission = {{400.0, 450.0, 520.0}, {0.0, 1.0, 0.0}, Outside::zero};
    fluorophore.quantum_yield = 0.9;
    return fluorophore;
}

// The sum over the whole nanometres that a wavelength of a grid in steps of 5 nm stands for.
template <class Value>
double sum_over_step(int lambda_nm, const Value& value) {
    double sum = 0.0;
    for (int lambda = lambda_nm - 2; lambda <= lambda_nm + 2; ++lambda) sum += value(lambda);
    return sum;
}

ProbeResult measured(const ProbeMaterial& material, const ProbeSettings& settings, int lambda_ex_nm = 365) {
    return HalfSpaceProbe(test_device(), material, settings).measure(lambda_ex_nm);
}

ProbeSettings settings_of(Transport transport, double angle_deg, std::int64_t photons) {
    ProbeSettings settings;
    settings.transport = transport;
    settings.first_collision_only = transport == Transport::walk;
    settings.angle_deg = angle_deg;
    settings.photons = photons;
    return settings;
}

// Standard errors that a comparison may differ by: where few are made, and where some 300 are, which at this many all
// hold but once in 100 choices of the seed (Student's distribution of 63 degrees of freedom).
constexpr double among_few = 3.0, among_many = 4.5;

void check_near(const Measured& measured, double expected, double tolerance = 0.0, double errors = among_few) {
    CAPTURE(measured.value, measured.standard_error, expected);
    CHECK(measured.standard_error < 5e-4);
    CHECK(std::abs(measured.value - expected) <= errors * measured.standard_error + tolerance);
}

double cosine_of(double angle_deg) { return std::cos(angle_deg * M_PI / 180.0); }

// Specular reflectance, and the share of the light within that leaves after one collision and ever.
struct Exact {
    double specular, single, total;
};

Exact exact_elastic(double albedo, double angle_deg, double eta) {
    const double mu = cosine_within(eta, cosine_of(angle_deg));
    const double specular = eta > 1.0 ? internal_reflectance(mu, eta) : 0.0;
    const Escaping share = escaping_share(eta, mu, albedo);
    return {specular, (1.0 - specular) * albedo * share.direct, (1.0 - specular) * albedo * share.total};
}

struct Case {
    double albedo, angle_deg, eta;
    std::int64_t photons;
};

// The tables' own totals are interpolated, to a few 1e-6 in what leaves: seen where the estimate hardly
// scatters.
constexpr double table_tolerance = 2e-5;

void check_elastic(Transport transport, const std::vector<Case>& cases, double errors = among_few) {
    for (const Case& c : cases) {
        CAPTURE(word_of(transport), c.albedo, c.angle_deg, c.eta);
        const ProbeResult result =
            measured(medium_of(2.0, c.albedo, c.eta), settings_of(transport, c.angle_deg, c.photons));
        const Exact exact = exact_elastic(c.albedo, c.angle_deg, c.eta);
        check_near(result.totals[probe_specular], exact.specular, 0.0, errors);
        check_near(result.totals[probe_single], exact.single, 0.0, errors);
        check_near(result.totals[probe_multiple], exact.total - exact.single,
                   transport == Transport::conserving ? table_tolerance : 0.0, errors);
        check_near(result.totals[probe_total], exact.specular + exact.total, 0.0, errors);
        CHECK(result.totals[probe_fluorescence].value == 0.0);
        CHECK(result.dropped < 1e-4);
    }
}

// Light takes 1/2.5 mm to its first collision, and re-emitted 1/1 mm to each further one.
ProbeMaterial dyed_medium(double albedo, double eta) {
    ProbeMaterial material = medium_of(1.0, albedo, eta);
    const Spectrum shape = {{365.0, 390.0}, {2.5, 1.0}, Outside::hold};
    material.medium->sigma_s = shape.scaled(albedo);
    material.medium->sigma_a = shape.scaled(1.0 - albedo);
    material.dyes = {{dye(), 0.6}};
    return material;
}

void check_fluorescence(Transport transport, const std::vector<Case>& cases, double errors = among_few) {
    for (const Case& c : cases) {
        CAPTURE(word_of(transport), c.albedo, c.angle_deg, c.eta);
        const ProbeMaterial material = dyed_medium(c.albedo, c.eta);
        const ProbeResult result = measured(material, settings_of(transport, c.angle_deg, c.photons));
        const double mu = cosine_within(c.eta, cosine_of(c.angle_deg));
        const Exact elastic = exact_elastic(c.albedo, c.angle_deg, c.eta);
        const double escaping = escaping_share(c.eta, mu, c.albedo, 1.0 / 2.5).total;
        const Fluorophore& dot = material.dyes[0].fluorophore;
        const double taken_up = material.dyes[0].fraction * dot.excitation.at(365);
        const double photons = (1.0 - elastic.specular) * taken_up * dot.quantum_yield * escaping;
        const double emission = dot.emission.sum_1nm(300, 830);
        check_near(result.emitted_photons, photons, 0.0, errors);
        double energy = 0.0;
        for (std::size_t i = 0; i < result.lambda_nm.size(); ++i) {
            const int lambda = result.lambda_nm[i];
            const double in_step =
                sum_over_step(lambda, [&](int at) { return photons * dot.emission.at(at) / emission * 365.0 / at; });
            const double expected = in_step / 5.0;
            energy += in_step;
            const Measured& m = result.reflectance[probe_fluorescence][i];
            CAPTURE(lambda, m.value, m.standard_error, expected);
            CHECK(std::abs(m.value - expected) <= (errors + 1.0) * m.standard_error);
            CHECK(m.standard_error <= 0.01 * expected);
        }
        check_near(result.totals[probe_fluorescence], energy, 0.0, errors);
        check_near(result.totals[probe_single], (1.0 - taken_up) * elastic.single, 0.0, errors);
        check_near(result.totals[probe_multiple], (1.0 - taken_up) * (elastic.total - elastic.single), 0.0, errors);
        CHECK(result.dropped < 1e-4);
    }
}

}  // namespace

// Chandrasekhar's H function, to the digits of PHYSICS section 4.
TEST_CASE("the probe measures the reflectance that PHYSICS gives", "[probe]") {
    struct {
        double albedo, angle_deg, total, single;
    } const cases[] = {{0.9, 0.0, 0.4149475, 0.1380838},
                       {0.9, 60.0, 0.5079389, 0.2028122},
                       {0.5, 0.0, 0.1152259, 0.25 * (1.0 - std::log(2.0))}};
    for (const auto& c : cases) {
        CAPTURE(c.albedo, c.angle_deg);
        const ProbeResult result =
            measured(medium_of(1.3, c.albedo), settings_of(Transport::conserving, c.angle_deg, 200000));
        check_near(result.totals[probe_total], c.total);
        check_near(result.totals[probe_single], c.single);
    }
}

// Adding-doubling and a random walk agree on these to 5e-5 (PHYSICS section 4).
TEST_CASE("the probe measures the reflectance below a refracting surface", "[probe]") {
    struct {
        double albedo, eta, expected;
    } const cases[] = {{0.9, 1.5, 0.2599}, {0.99, 1.5, 0.6020}, {0.9, 1.33, 0.2948}};
    for (const auto& c : cases) {
        CAPTURE(c.albedo, c.eta);
        const ProbeResult result =
            measured(medium_of(1.0, c.albedo, c.eta), settings_of(Transport::conserving, 0.0, 200000));
        check_near(result.totals[probe_total], c.expected, 5e-5);
    }
}

TEST_CASE("a medium without loss gives back all light", "[probe]") {
    for (const double eta : {1.0, 1.5}) {
        CAPTURE(eta);
        const ProbeResult result = measured(medium_of(1.0, 1.0, eta), settings_of(Transport::conserving, 30.0, 300000));
        check_near(result.totals[probe_total], 1.0);
    }
}

TEST_CASE("the probe agrees with exact transport", "[probe]") {
    check_elastic(Transport::conserving, {{0.998, 60.0, 1.0, 150000}, {0.8, 60.0, 1.33, 300000}});
    check_elastic(Transport::walk, {{0.5, 0.0, 1.0, 420000}, {0.5, 60.0, 1.5, 500000}});
}

TEST_CASE("the probe measures the fluorescence of exact transport", "[probe]") {
    check_fluorescence(Transport::conserving, {{0.2, 0.0, 1.0, 450000}, {0.8, 60.0, 1.5, 120000}});
    check_fluorescence(Transport::walk, {{0.9, 45.0, 1.33, 300000}});
}

TEST_CASE("the probe agrees with exact transport, many cases", "[.long]") {
    std::vector<Case> cases;
    for (const double albedo : {0.3, 0.9, 0.998, 1.0})
        for (const double angle_deg : {0.0, 80.0})
            for (const double eta : {1.0, 1.33, 1.5}) cases.push_back({albedo, angle_deg, eta, 1600000});
    check_elastic(Transport::walk, cases, among_many);
    for (Case& c : cases) c.photons = 800000;
    check_elastic(Transport::conserving, cases, among_many);
}

TEST_CASE("the probe measures the fluorescence of exact transport, many cases", "[.long]") {
    std::vector<Case> cases;
    for (const double albedo : {0.0, 0.9, 0.99})
        for (const double angle_deg : {0.0, 60.0})
            for (const double eta : {1.0, 1.5}) cases.push_back({albedo, angle_deg, eta, 700000});
    check_fluorescence(Transport::walk, cases, among_many);
    for (Case& c : cases) c.photons = 2000000;
    check_fluorescence(Transport::conserving, cases, among_many);
}

namespace {

// The same material and angle by `conserving` and by `walk`, bin by bin of distance from the entry, which at
// an oblique angle holds the skew too: the sum of squared differences over their variances. Variances come
// from at least 32 batches, so that a square has the mean 31/29 at most. Bins that hardly any light reaches
// are left out.
void check_radial(const ProbeMaterial& material, double angle_deg, std::int64_t photons, std::size_t comparisons) {
    ProbeSettings settings = settings_of(Transport::conserving, angle_deg, photons);
    settings.bins = 24;
    const ProbeResult tables = measured(material, settings);
    settings.transport = Transport::walk;
    settings.first_collision_only = true;
    settings.seed = 2;
    const ProbeResult walked = measured(material, settings);
    REQUIRE(tables.r_mm == walked.r_mm);
    for (const std::size_t component : {probe_single, probe_multiple, probe_fluorescence}) {
        double sum = 0.0, compared = 0.0, share = 0.0;
        for (std::size_t bin = 0; bin + 1 < walked.r_mm.size(); ++bin) {
            const Measured a = tables.radial[component][bin], b = walked.radial[component][bin];
            if (!(b.standard_error < 0.1 * b.value && a.standard_error < 0.1 * a.value)) continue;
            sum += (a.value - b.value) * (a.value - b.value) /
                   (a.standard_error * a.standard_error + b.standard_error * b.standard_error);
            compared += 1.0;
            share += b.value * M_PI * (std::pow(walked.r_mm[bin + 1], 2) - std::pow(walked.r_mm[bin], 2));
        }
        CAPTURE(angle_deg, component, sum, compared);
        CHECK(share > 0.97 * walked.totals[component].value);
        CHECK(compared >= 12.0);
        CHECK(chi_square_tail(sum * 29.0 / 31.0, compared) > sidak_level(0.01, comparisons));
    }
}

}  // namespace

// 6 comparisons, together wrong once in 100 choices of the seeds.
TEST_CASE("tables and walks send light back at the same distances", "[probe]") {
    for (const double angle_deg : {0.0, 60.0}) check_radial(dyed_medium(0.9, 1.0), angle_deg, 120000, 6);
}

// 24 comparisons.
TEST_CASE("tables and walks send light back at the same distances, to half a per cent", "[.long]") {
    for (const double angle_deg : {0.0, 60.0})
        for (const double eta : {1.0, 1.5})
            for (const double albedo : {0.8, 0.99}) check_radial(dyed_medium(albedo, eta), angle_deg, 2000000, 24);
}

namespace {

// The probability of leaving a half-space without loss after exactly n collisions, n = 1 .. count, for light
// that arrives at cosine mu and no refraction: the coefficients of R(a) = 1 - sqrt(1 - a) H(mu; a) in powers
// of a, by Cauchy's integral on a circle. H for complex albedos: log H = -mu/pi integral_0^inf log(1 - a
// atan(k)/k) / (1 + mu^2 k^2) dk (Chandrasekhar 1960), k = tan(t).
std::vector<double> escape_by_collisions(double mu, std::size_t count) {
    const std::size_t points = 1024;
    const double radius = 0.98;
    const GaussLegendre rule(40);
    std::vector<double> result(count, 0.0);
    for (std::size_t j = 0; j < points; ++j) {
        const double angle = 2.0 * M_PI * static_cast<double>(j) / static_cast<double>(points);
        const std::complex<double> a = std::polar(radius, angle);
        std::complex<double> integral = 0.0;
        for (int panel = 0; panel < 8; ++panel)
            for (std::size_t i = 0; i < rule.node.size(); ++i) {
                const double t = 0.5 * M_PI * (panel + rule.node[i]) / 8.0, k = std::tan(t), c = std::cos(t);
                const std::complex<double> value = std::log(1.0 - a * (t / k)) / (c * c + mu * mu * k * k * c * c);
                integral += 0.5 * M_PI / 8.0 * rule.weight[i] * value;
            }
        const std::complex<double> reflected = 1.0 - std::sqrt(1.0 - a) * std::exp(-mu / M_PI * integral);
        for (std::size_t n = 1; n <= count; ++n)
            result[n - 1] += (reflected * std::polar(std::pow(radius, -double(n)), -angle * double(n))).real() / points;
    }
    return result;
}

}  // namespace

TEST_CASE("the series over collisions gives Chandrasekhar's reflectance", "[probe]") {
    const std::vector<double> escape = escape_by_collisions(1.0, 300);
    double sum = 0.0, power = 1.0;
    for (const double p : escape) sum += p * (power *= 0.9);
    CHECK(sum == Approx(0.4149475).margin(2e-7));
    CHECK(0.9 * escape[0] == Approx(0.1380838).margin(1e-7));
}

// Where the extinction is the same at all wavelengths, the way does not depend on the colour: after n
// collisions the light at all wavelengths is M^n times what arrived, M scattering on its diagonal and
// re-radiation below it. So what leaves is the sum of p_n M^n, p_n as above, with re-absorption at every
// collision. The 119 emitting nanometres share eight sets, so that light which is re-radiated again comes from
// wavelengths that are in the set by chance. Read in steps of 5 nm it is the same light.
TEST_CASE("light that is taken up again and again is weighted right", "[probe]") {
    const auto rule = GENERATE(StokesRule::keep_yield, StokesRule::truncate);
    ProbeMaterial material = medium_of(1.0, 0.7);
    material.dyes = {{dye(), 0.7}};
    material.dyes[0].fluorophore.stokes_rule = rule;
    ProbeSettings settings = settings_of(Transport::walk, 0.0, 125000);
    settings.first_collision_only = false;
    const ProbeResult result = measured(material, settings);
    CHECK(result.sets == 8);

    const Fluorophore& dot = material.dyes[0].fluorophore;
    constexpr int first_nm = 365, last_nm = 530;
    constexpr std::size_t count = last_nm - first_nm + 1;
    const auto nm = [](std::size_t i) { return first_nm + static_cast<int>(i); };
    const auto uptake = [&](std::size_t i) { return 0.7 * dot.excitation.at(nm(i)); };
    std::vector<double> light(count, 0.0), leaving(count, 0.0), whole(count);
    for (std::size_t i = 0; i < count; ++i)
        whole[i] = dot.emission.sum_1nm(rule == StokesRule::keep_yield ? nm(i) + 1 : 300, 830);
    light[0] = 1.0;
    for (const double escape : escape_by_collisions(1.0, 300)) {
        std::vector<double> next(count, 0.0);
        for (std::size_t to = 0; to < count; ++to) {
            next[to] = light[to] * (1.0 - uptake(to)) * 0.7;
            for (std::size_t from = 0; from < to; ++from)
                if (whole[from] > 0.0)
                    next[to] += light[from] * uptake(from) * dot.quantum_yield * dot.emission.at(nm(to)) / whole[from] *
                                nm(from) / nm(to);
        }
        light = next;
        for (std::size_t i = 0; i < count; ++i) leaving[i] += escape * light[i];
    }
    check_near(result.totals[probe_total], std::accumulate(leaving.begin(), leaving.end(), 0.0));
    check_near(result.totals[probe_fluorescence], std::accumulate(leaving.begin() + 1, leaving.end(), 0.0));
    for (std::size_t i = 0; i < result.lambda_nm.size(); ++i) {
        if (result.lambda_nm[i] <= first_nm + 5 || result.lambda_nm[i] > last_nm - 5) continue;
        const double expected = sum_over_step(
            result.lambda_nm[i], [&](int at) { return leaving[static_cast<std::size_t>(at - first_nm)] / 5.0; });
        const Measured& m = result.reflectance[probe_fluorescence][i];
        CAPTURE(result.lambda_nm[i], m.value, m.standard_error, expected);
        CHECK(std::abs(m.value - expected) <= 4.0 * m.standard_error);
        CHECK(m.standard_error <= 0.04 * expected);
    }
}

namespace {

// Takes up everything and scatters nothing. Of what is emitted at the depth t, exp(-t) of the beam, the half that goes
// up escapes with exp(-t/mu): the integral of mu/(1 + mu) over mu, halved, is (1 - ln 2)/2.
ProbeMaterial ink(const Spectrum& emission) {
    ProbeMaterial material = medium_of(1.0, 0.0);
    Fluorophore fluorophore;
    fluorophore.name = "ink";
    fluorophore.excitation = Spectrum::constant(1.0);
    fluorophore.emission = emission.at_whole_nanometres();
    fluorophore.quantum_yield = 0.9;
    material.dyes = {{fluorophore, 1.0}};
    return material;
}

const double ink_escape = 0.5 * (1.0 - std::log(2.0));

}  // namespace

// Lines of 3 nm, as those of europium: most of what they emit lies between the wavelengths that are read.
TEST_CASE("what the probe reads does not depend on its step", "[probe]") {
    const ProbeMaterial material = ink({{590.5, 592, 593.5, 610.9, 612.4, 613.9}, {0, 0.3, 0, 0, 1, 0}, Outside::zero});
    for (const int step : {50, 7, 5, 2, 1}) {
        CAPTURE(step);
        ProbeSettings settings = settings_of(Transport::conserving, 0.0, 100000);
        settings.step_nm = step;
        const ProbeResult result = measured(material, settings, 400);
        check_near(result.emitted_photons, 0.9 * ink_escape);
        double sum = 0.0;
        for (const Measured& m : result.reflectance[probe_fluorescence]) sum += step * m.value;
        CHECK(sum == Approx(result.totals[probe_fluorescence].value));
    }
}

// Excited within its own band, a dye emits what is left of it above: all of its yield, or the share that is left.
TEST_CASE("a dye that is excited in its own band keeps its yield", "[probe]") {
    const Spectrum band{{539, 540, 560, 561}, {0, 1, 1, 0}, Outside::zero};
    const auto emitted = [&](Transport transport, int lambda_ex_nm, std::optional<StokesRule> rule) {
        ProbeMaterial material = ink(band);
        material.dyes[0].fluorophore.stokes_rule = rule;
        ProbeSettings settings = settings_of(transport, 0.0, 100000);
        settings.step_nm = 1;
        return measured(material, settings, lambda_ex_nm).emitted_photons;
    };
    const double all = 0.9 * ink_escape;
    for (const int lambda_ex : {400, 545, 550, 555}) {
        CAPTURE(lambda_ex);
        check_near(emitted(Transport::conserving, lambda_ex, std::nullopt), all);
        // Whole nanometres from 541 to 559 have 1, the others add up to the area of the trapezium, 21.
        const double left = lambda_ex == 400 ? 1.0 : (559.0 - lambda_ex + (21.0 - 19.0) / 2.0) / 21.0;
        check_near(emitted(Transport::conserving, lambda_ex, StokesRule::truncate), all * left);
    }
    CHECK(emitted(Transport::conserving, 561, std::nullopt).value == 0.0);
    for (const auto& [rule, share] : {std::pair{StokesRule::keep_yield, 1.0}, {StokesRule::truncate, 10.0 / 21.0}}) {
        const Measured walked = emitted(Transport::walk, 550, rule);
        CHECK(walked.standard_error < 2e-3);
        CHECK(std::abs(walked.value - all * share) < 3.0 * walked.standard_error);
    }
}

// Without subsurface light c E QY of the photons leave where they came in, no noise but that of the draw of
// c.
TEST_CASE("surface fluorescence leaves at the beam", "[probe]") {
    ProbeMaterial material;
    material.name = "paint";
    material.dyes = {{dye(), 0.5}};
    const ProbeResult result = measured(material, settings_of(Transport::conserving, 20.0, 20000));
    const double expected = 0.5 * material.dyes[0].fluorophore.excitation.at(365) * 0.9;
    CHECK(std::abs(result.emitted_photons.value - expected) <= 3.0 * result.emitted_photons.standard_error);
    CHECK(result.emitted_photons.standard_error < 0.01 * expected);
    CHECK(result.totals[probe_total].value == Approx(result.totals[probe_fluorescence].value));
    CHECK(result.radial[probe_fluorescence][0].value * M_PI * result.r_mm[1] * result.r_mm[1] ==
          Approx(result.totals[probe_fluorescence].value));
}

// Takes up and emits at longer wavelengths than dye().
Fluorophore second_dye() {
    Fluorophore fluorophore = dye();
    fluorophore.name = "second dye";
    fluorophore.excitation = {{300.0, 450.0, 560.0}, {0.3, 0.6, 0.0}, Outside::zero};
    fluorophore.emission = {{460.0, 500.0, 600.0}, {0.0, 1.0, 0.0}, Outside::zero};
    fluorophore.quantum_yield = 0.5;
    return fluorophore;
}

// What two fluorophores send back of each photon that meets them is c E QY of the one and of the other, each with its
// own spectrum: on the surface all of it leaves; below it, with one collision that counts, the share that escapes from
// where light of 1/2.5 mm mean free path collides first.
TEST_CASE("two fluorophores emit the sum of what each of them does", "[probe]") {
    for (const bool surface : {true, false}) {
        ProbeMaterial material = dyed_medium(0.5, 1.0);
        if (surface) material.medium.reset();
        material.dyes = {{dye(), 0.3}, {second_dye(), 0.5}};
        const ProbeResult result = measured(material, settings_of(Transport::conserving, 20.0, 200000));
        const double escaping = surface ? 1.0 : escaping_share(1.0, cosine_of(20.0), 0.5, 1.0 / 2.5).total;
        const auto photons = [&](const ProbeDye& of) {
            return of.fraction * of.fluorophore.excitation.at(365) * of.fluorophore.quantum_yield * escaping;
        };
        CAPTURE(surface);
        check_near(result.emitted_photons, photons(material.dyes[0]) + photons(material.dyes[1]));
        for (std::size_t i = 0; i < result.lambda_nm.size(); ++i) {
            double expected = 0.0;
            for (const ProbeDye& of : material.dyes)
                expected += sum_over_step(result.lambda_nm[i], [&](int at) {
                    return photons(of) * of.fluorophore.emission.at(at) / of.fluorophore.emission.sum_1nm(300, 830) *
                           365.0 / at / 5.0;
                });
            const Measured& m = result.reflectance[probe_fluorescence][i];
            CAPTURE(result.lambda_nm[i], m.value, m.standard_error, expected);
            CHECK(std::abs(m.value - expected) <= 4.0 * m.standard_error);
            CHECK(m.standard_error <= 0.01 * expected);
        }
    }
}

// The half-space has no length but the mean free path.
TEST_CASE("the probe does not depend on the unit of length", "[probe]") {
    for (const Transport transport : {Transport::conserving, Transport::walk}) {
        ProbeSettings settings = settings_of(transport, 85.0, 8000);
        settings.bins = 8;
        const ProbeResult middle = measured(medium_of(1.0, 0.9), settings);
        for (const double scale : {0x1p-24, 0x1p24}) {
            CAPTURE(word_of(transport), scale);
            const ProbeResult result = measured(medium_of(scale, 0.9), settings);
            CHECK(result.totals[probe_total].value == Approx(middle.totals[probe_total].value).epsilon(1e-4));
            CHECK(result.dropped == 0.0);
            for (std::size_t bin = 0; bin + 1 < result.r_mm.size(); ++bin) {
                CHECK(result.r_mm[bin + 1] * scale == Approx(middle.r_mm[bin + 1]));
                CHECK(result.radial[probe_total][bin].value / (scale * scale) ==
                      Approx(middle.radial[probe_total][bin].value).epsilon(0.03));
            }
        }
    }
}

TEST_CASE("a probe's result depends on its material, settings and wavelength alone", "[probe]") {
    const ProbeSettings settings = settings_of(Transport::conserving, 10.0, 6000);
    HalfSpaceProbe probe(test_device(), dyed_medium(0.9, 1.0), settings);
    const ProbeResult first = probe.measure(365);
    CHECK(probe.measure(420).totals[probe_total].value != first.totals[probe_total].value);
    const ProbeResult again = probe.measure(365);
    CHECK(again.totals[probe_total].value == first.totals[probe_total].value);
    CHECK(again.totals[probe_total].standard_error == first.totals[probe_total].standard_error);
    CHECK(again.photons == 6016);  // 32 batches of 188
    CHECK(again.batches == 32);
}

// What leaves in the bins and beyond them is what leaves at all wavelengths.
TEST_CASE("a probe's sums agree", "[probe]") {
    for (const Transport transport : {Transport::paper, Transport::conserving, Transport::walk}) {
        CAPTURE(word_of(transport));
        ProbeSettings settings = settings_of(transport, 40.0, 6000);
        settings.r_max_mm = 0.7;
        settings.bins = 12;
        const ProbeResult result = measured(dyed_medium(0.9, 1.5), settings, 372);  // not on the grid
        REQUIRE(result.lambda_nm.size() == 98);
        CHECK(std::is_sorted(result.lambda_nm.begin(), result.lambda_nm.end()));
        CHECK(result.r_mm.size() == 13);
        CHECK(result.r_mm.back() == 0.7);
        double shares = 0.0;
        for (std::size_t component = 0; component < probe_component_count; ++component) {
            CAPTURE(component);
            const bool fluorescent = component == probe_fluorescence;
            double total = 0.0, radial = result.beyond[component].value;
            for (std::size_t i = 0; i < result.lambda_nm.size(); ++i) {
                const double value = result.reflectance[component][i].value;
                if (result.lambda_nm[i] < 372) CHECK(value == 0.0);
                if (result.lambda_nm[i] == 372)
                    CHECK((value > 0.0) == (!fluorescent && result.totals[component].value > 0.0));
                if (result.lambda_nm[i] > 372 && !fluorescent && component != probe_total) CHECK(value == 0.0);
                total += value * (result.lambda_nm[i] == 372 ? 1.0 : 5.0);
            }
            for (std::size_t bin = 0; bin < 12; ++bin)
                radial += result.radial[component][bin].value * M_PI *
                          (std::pow(result.r_mm[bin + 1], 2) - std::pow(result.r_mm[bin], 2));
            CHECK(result.totals[component].value == Approx(total).margin(1e-12));
            const double specular = component == probe_total ? result.totals[probe_specular].value : 0.0;
            if (component != probe_specular)
                CHECK(radial + specular == Approx(result.totals[component].value).margin(1e-12));
            if (component != probe_total) shares += result.totals[component].value;
        }
        CHECK(shares == Approx(result.totals[probe_total].value));
        CHECK((result.totals[probe_specular].value > 0.0) == (transport != Transport::paper));
    }
}

TEST_CASE("the probe refuses what it cannot measure", "[probe]") {
    const auto complaint = [](const ProbeMaterial& material, const ProbeSettings& settings, int lambda_ex_nm = 365) {
        return input_error([&] { measured(material, settings, lambda_ex_nm); });
    };
    const ProbeMaterial good = medium_of(1.0, 0.9);
    ProbeSettings settings;
    settings.photons = 64;
    CHECK(complaint(good, settings) == "");
    CHECK_THAT(complaint(ProbeMaterial{}, settings), Contains("a medium, a fluorophore or both"));
    CHECK_THAT(complaint(good, settings, 299), Contains("an excitation wavelength in [300, 830] nm, got 299"));
    for (const double angle : {-1.0, 90.0, std::nan("")}) {
        ProbeSettings bad = settings;
        bad.angle_deg = angle;
        CHECK_THAT(complaint(good, bad), Contains("an angle of incidence in [0, 89.9] deg"));
    }
    ProbeSettings few = settings, narrow = settings, coarse = settings, bins = settings, first = settings;
    few.photons = 63;
    narrow.lambda_max_nm = 314;
    coarse.step_nm = 51;
    bins.bins = 1;
    first.first_collision_only = true;
    CHECK_THAT(complaint(good, few), Contains("photons in [64, 1e12]"));
    CHECK_THAT(complaint(good, narrow), Contains("at least 16 whole nanometres"));
    CHECK_THAT(complaint(good, coarse), Contains("a step in [1, 50] nm"));
    CHECK_THAT(complaint(good, bins), Contains("bins"));
    CHECK_THAT(complaint(good, first), Contains("first collision only with the transport walk"));
}
