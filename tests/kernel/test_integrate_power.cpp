#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "host/subsurface/distance_mixture.hpp"
#include "host/subsurface/paper_transport.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/subsurface_fixture.hpp"

using namespace stokes;

namespace {

constexpr std::uint32_t components[] = {STOKES_MAP_FLUORESCENCE, STOKES_MAP_SINGLE, STOKES_MAP_MULTIPLE};

// T_F, T_S or T_M in double precision by the host's own quadratures.
double power_twin(std::uint32_t component, double sigma_s, double sigma_a, double dipole_a, double r_mm,
                  double theta_deg) {
    const RefractionAngle theta = RefractionAngle::from_degrees(theta_deg);
    const double sigma_t = sigma_s + sigma_a;
    if (component == STOKES_MAP_FLUORESCENCE) return fluorescence_power(sigma_t, r_mm, theta);
    if (component == STOKES_MAP_SINGLE) return single_power(sigma_s, sigma_t, r_mm, theta);
    return multiple_power(sigma_a, sigma_t, dipole_a, r_mm);
}

double power_twin(std::uint32_t component, const PassMedium& medium, std::size_t k, double r_mm, double theta_deg) {
    return power_twin(component, double(medium.sigma_s[k]), double(medium.sigma_a[k]), double(medium.dipole_a), r_mm,
                      theta_deg);
}

constexpr std::uint32_t before = 3, after = 4;  // entries about those that are written
constexpr float unwritten = -7.0f;

// The powers at exits of one component.
std::vector<Flux16> integrated(const std::vector<ExitPoint>& exits, const std::vector<PassMedium>& media,
                               std::uint32_t component) {
    std::vector<ExitPoint> all(before);
    all.insert(all.end(), exits.begin(), exits.end());
    EventRound round{};
    round.count = std::uint32_t(exits.size());
    round.component = component;
    round.sampler = STOKES_SAMPLER_INTEGRATED;
    round.first_exit = before;
    const Buffer<Flux16> power =
        on_device(std::vector<Flux16>(before + exits.size() + after, constant_flux(unwritten)));
    Program(test_device(), "integrate_power.cl")
        .kernel("integrate_power")
        .launch(exits.size(), Arguments()
                                  .add("round", round)
                                  .add("exits", on_device(all))
                                  .add("materials", on_device(translucent_materials()))
                                  .add("media", on_device(media))
                                  .add("exit_powers", power));
    std::vector<Flux16> result = power.download();
    for (std::size_t i = 0; i < result.size(); ++i)
        if (i < before || i >= before + exits.size()) CHECK(result[i].v[0] == unwritten);
    result.erase(result.begin(), result.begin() + before);
    result.resize(exits.size());
    return result;
}

ExitPoint exit_of(std::uint32_t material, double r_mm, double theta_deg) {
    ExitPoint exit_point{};
    exit_point.material = material;
    exit_point.r_mm = float(r_mm);
    exit_point.row = float(theta_deg);
    return exit_point;
}

// Medium 0: like marble. Medium 1: coefficients between 1/100 and 100 per mm, albedos up to 1 - 1e-6, another
// A.
std::vector<PassMedium> test_media() {
    std::mt19937 generator(8);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<PassMedium> media(2);
    for (std::size_t k = 0; k < 16; ++k) {
        media[0].sigma_s[k] = float(1.5 - 0.03 * double(k));
        media[0].sigma_a[k] = float(0.0071 - 0.0003 * double(k));
        const double sigma_t = std::pow(10.0, 4.0 * uniform(generator) - 2.0);
        const double loss = k == 0 ? 1.0 : std::pow(10.0, -6.0 * uniform(generator));
        media[1].sigma_s[k] = k == 0 ? 0.0f : float((1.0 - loss) * sigma_t);
        media[1].sigma_a[k] = float(loss * sigma_t);
    }
    media[0].dipole_a = 1.0f;
    media[1].dipole_a = float(dipole_boundary(1.5));
    return media;
}

// Random exits, and the corners of the tables' range.
std::vector<ExitPoint> random_exits(std::size_t count) {
    std::mt19937 generator(9);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<ExitPoint> exits;
    for (const double r : {0.0, 1e-4, 9.9})
        for (const double theta : {0.0, 41.8, 89.1})
            for (const std::uint32_t material : {0u, 1u}) exits.push_back(exit_of(material, r, theta));
    while (exits.size() < count) {
        const double r = 9.9 * std::pow(uniform(generator), 2.0);
        exits.push_back(exit_of(std::uint32_t(exits.size() % 3), r, 89.1 * uniform(generator)));
    }
    return exits;
}

// Errors relative to the value. Where less than 1e-12 of the value at r = 0 is left, which single precision's
// exponentials are less precise for (exp(-x) to some 2^-24 x), relative to that value instead. The bounds are
// those that kernels/lib/integrated_power.clh states, of a closed form some roundings.
void check_powers(std::size_t count) {
    const std::vector<PassMedium> media = test_media();
    const std::vector<ExitPoint> exits = random_exits(count);
    const double bounds[] = {4e-4, 7e-4, 2e-5};
    for (const std::uint32_t component : components) {
        const std::vector<Flux16> found = integrated(exits, media, component);
        double worst = 0.0;
        std::string where;
        for (std::size_t i = 0; i < exits.size(); ++i) {
            const MaterialRecord material = translucent_materials()[exits[i].material];
            const std::uint32_t medium = material.medium;
            if (!has(material, STOKES_MATERIAL_SUBSURFACE)) {
                CHECK(found[i].v[0] == unwritten);
                continue;
            }
            const double theta = double(exits[i].row), r = double(exits[i].r_mm);
            for (std::size_t k = 0; k < 16; ++k) {
                const double expected = power_twin(component, media[medium], k, r, theta);
                const double at_entry = power_twin(component, media[medium], k, 0.0, theta);
                const double difference = std::abs(double(found[i].v[k]) - expected);
                if (expected == 0.0 && difference == 0.0) continue;
                const double error = expected < 1e-12 * at_entry ? difference / at_entry : difference / expected;
                if (error <= worst) continue;
                worst = error;
                where = "r " + std::to_string(r) + " mm, " + std::to_string(theta) + " degrees, medium " +
                        std::to_string(medium) + ", wavelength " + std::to_string(k);
            }
        }
        CAPTURE(component, where);
        CHECK(worst < bounds[component]);
        CHECK(worst > 0.0);
    }
}

// Exits that photons draw which arrive at one angle at a plane, all of material 0.
struct Drawn {
    std::vector<float> r_mm;
    std::vector<ExitPoint> exits;
    std::vector<Probe> probes;
};

Drawn draw(const MediumMixture& mixture, float eta, std::uint32_t component, double theta_in_deg, std::uint32_t count,
           std::uint32_t seed) {
    const double angle = theta_in_deg * M_PI / 180.0;
    const Ray ray{0, 0, 0, 0, float(std::sin(angle)), float(-std::cos(angle)), 0, 1e30f};
    const SurfacePoint point{1.0f, 2.0f, 3.0f, 0, 0.0f, 1.0f, 0.0f, 5};
    std::vector<std::uint32_t> list;
    for (std::uint32_t i = 0; i < count; ++i) list.push_back(i);
    MaterialRecord material = translucent_materials()[0];
    material.medium = 1;
    material.eta = eta;
    // An unused medium, and unused rows, before those that are to be used.
    std::vector<float> rows(mixture.record.first, 1e9f);
    rows.insert(rows.end(), mixture.rows.begin(), mixture.rows.end());
    EventRound round{};
    round.count = count;
    round.event = 2;
    round.component = component;
    round.sampler = STOKES_SAMPLER_INTEGRATED;
    round.first_exit = before;
    const Buffer<ExitPoint> exits = on_device(std::vector<ExitPoint>(before + count + after, ExitPoint{}));
    const Buffer<Probe> probes = on_device(std::vector<Probe>(before + count + after, Probe{}));
    Program(test_device(), "integrate_power.cl")
        .kernel("draw_exits")
        .launch(count, Arguments()
                           .add("round", round)
                           .add("pass", pass_on_device(seed, 0, 0.01f))
                           .add("event_lists", on_device(list))
                           .add("points", on_device(std::vector<SurfacePoint>(count, point)))
                           .add("rays", on_device(std::vector<Ray>(count, ray)))
                           .add("materials", on_device(std::vector<MaterialRecord>{material}))
                           .add("mixtures", on_device(std::vector<DistanceMixture>{DistanceMixture{}, mixture.record}))
                           .add("mix_rows", on_device(rows))
                           .add("exits", exits)
                           .add("probes", probes));
    Drawn drawn;
    drawn.exits = exits.download(count, before);
    drawn.probes = probes.download(count, before);
    for (const ExitPoint& e : drawn.exits) drawn.r_mm.push_back(e.r_mm);
    return drawn;
}

// Density over r of one component at one angle: the mean over the tables' wavelengths, by the host's
// quadratures, on a grid so fine towards r = 0 that a straight line between its points will do.
struct FineDensity {
    std::vector<double> r_mm, below;  // below: probability of a smaller r

    FineDensity(const MediumSpectra& medium, std::uint32_t component, double theta_deg) {
        const TableGrid grid;
        const TableMedium at = table_medium(medium, grid.lambda_nm);
        const double dipole_a = dipole_boundary(medium.dipole_eta);
        const int cells = 1500;
        double previous = 0.0;
        for (int i = 0; i <= cells; ++i) {
            const double r = 9.9 * std::pow(double(i) / cells, 3.0);
            double mean = 0.0;
            for (std::size_t k = 0; k < at.sigma_s.size(); k += 3)  // constant over three wavelengths
                mean += power_twin(component, at.sigma_s[k], at.sigma_a[k], dipole_a, r, theta_deg) *
                        double(std::min<std::size_t>(3, at.sigma_s.size() - k));
            below.push_back(i == 0 ? 0.0 : below.back() + 0.5 * (previous + mean) * (r - r_mm.back()));
            r_mm.push_back(r);
            previous = mean;
        }
        for (double& b : below) b /= below.back();
    }
    double probability_below(double r) const {
        const auto next = std::upper_bound(r_mm.begin(), r_mm.end(), r);
        if (next == r_mm.end()) return 1.0;
        const std::size_t i = std::size_t(next - r_mm.begin()) - 1;
        return below[i] + (below[i + 1] - below[i]) * (r - r_mm[i]) / (r_mm[i + 1] - r_mm[i]);
    }
};

// A spectrum that is constant over three wavelengths of the tables at a time.
template <class Value>
Spectrum in_steps(const Value& value) {
    const TableGrid grid;
    std::vector<double> lambda, v;
    for (std::size_t k = 0; k < grid.lambda_nm.size(); ++k) {
        lambda.push_back(grid.lambda_nm[k]);
        v.push_back(value(double(k / 3 * 3) / double(grid.lambda_nm.size())));
    }
    return {lambda, v, Outside::hold};
}

struct Case {
    MediumSpectra medium;
    std::uint32_t seed;
};

// Marble; a medium of which little lies within 10 mm; one whose light stays within 0.1 mm; and coefficients
// from 0.03 to 30 per mm, albedos from 0.1 to 1.
std::vector<Case> cases() {
    const auto steps = [](double from, double to) {
        return in_steps([=](double x) { return from * std::pow(to / from, x); });
    };
    return {{{"marble", steps(1.5, 1.1), steps(0.0071, 0.0021), 1.5, 1.0}, 11},
            {{"haze", steps(0.005, 0.01), steps(0.002, 0.0001), 1.0, 1.0}, 12},
            {{"paint", steps(100.0, 60.0), steps(1.0, 0.01), 1.0, 1.5}, 13},
            {{"ink", steps(0.03, 20.0), steps(0.0001, 15.0), 1.0, 1.3}, 14}};
}

constexpr double angles_deg[] = {0.0, 41.0, 80.0, 89.9};  // the last beyond the tables' 89.1
constexpr int comparisons = 4 * (4 + 4 + 1);

}  // namespace

TEST_CASE("integrated powers agree with quadrature in double precision", "[integrate_power][tiny]") {
    check_powers(40);
}

TEST_CASE("integrated powers agree with quadrature at many distances, angles and wavelengths", "[integrate_power]") {
    check_powers(6000);
}

TEST_CASE("powers are finite in the thinnest and densest media", "[integrate_power][tiny]") {
    std::vector<PassMedium> media(2);
    const std::array<double, 4> sigma_t = {1e-9, 1e-4, 1e4, 1e9};
    for (std::size_t k = 0; k < 16; ++k) {
        media[1].sigma_s[k] = float(0.5 * sigma_t[k % 4]);
        media[1].sigma_a[k] = media[1].sigma_s[k];
    }
    media[1].dipole_a = 1e6f;
    std::vector<ExitPoint> exits;
    for (const double r : {0.0, 1e-6, 1.0, 9.9})
        for (const double theta : {0.0, 45.0, 89.1}) exits.push_back(exit_of(0, r, theta));
    for (const std::uint32_t component : components)
        for (const Flux16& power : integrated(exits, media, component))
            for (const float v : power.v) {
                CHECK(std::isfinite(v));
                CHECK(v >= 0.0f);
            }
}

// Chi-square in 64 cells of equal probability, and the mean of the probability of a smaller distance, which is uniform;
// all of them together wrong once in 1000.
TEST_CASE("distances have the mean over wavelengths of the power as density", "[integrate_power]") {
    const double level = sidak_level(1e-3, 2 * comparisons);
    int compared = 0;
    for (const Case& c : cases())
        for (const std::uint32_t component : components)
            for (const double angle_deg : angles_deg) {
                if (component == STOKES_MAP_MULTIPLE && angle_deg != 0.0) continue;
                CAPTURE(c.medium.name, component, angle_deg);
                const FineDensity density(c.medium, component, std::min(angle_deg, 89.1));
                const Drawn drawn =
                    draw(make_medium_mixture(c.medium, 7), 1.0f, component, angle_deg, 1u << 18, c.seed);
                std::vector<double> counts(64, 0.0);
                double sum = 0.0;
                for (const float r : drawn.r_mm) {
                    REQUIRE((r >= 0.0f && r <= 9.9f));
                    const double p = density.probability_below(double(r));
                    counts[std::min(std::size_t(p * 64.0), std::size_t{63})] += 1.0;
                    sum += p;
                }
                CHECK(chi_square_uniform(counts) > level);
                const double n = double(drawn.r_mm.size());
                CHECK(normal_two_sided((sum / n - 0.5) * std::sqrt(12.0 * n)) > level);
                ++compared;
            }
    CHECK(compared == comparisons);
}

// The angle in the medium is that of refraction: eta 1.5, incidence at 80 degrees.
TEST_CASE("exits lie on the tangent plane at their distance, in all directions", "[integrate_power][tiny]") {
    const Drawn drawn = draw(make_medium_mixture(cases().front().medium), 1.5f, STOKES_MAP_FLUORESCENCE, 80.0, 200, 3);
    const double refracted_deg = std::asin(std::sin(80.0 * M_PI / 180.0) / 1.5) * 180.0 / M_PI;
    std::vector<double> quarters(4, 0.0);
    for (std::size_t i = 0; i < drawn.exits.size(); ++i) {
        const ExitPoint& e = drawn.exits[i];
        const Probe& probe = drawn.probes[i];
        CHECK((e.x == 1.0f && e.y == 2.0f && e.z == 3.0f && e.ny == 1.0f));
        CHECK((e.path == i && e.material == 0 && e.scale == 1.0f && e.way_mm == 0.0f));
        CHECK(double(e.row) == Approx(refracted_deg).margin(1e-3));
        CHECK((probe.body == 5 && probe.ny == 1.0f));
        const double x = double(probe.x) - 1.0, z = double(probe.z) - 3.0;
        CHECK(double(probe.y) == Approx(2.0).margin(1e-5));
        CHECK(std::hypot(x, z) == Approx(double(e.r_mm)).margin(2e-6));
        CHECK(double(probe.reach_mm) == Approx(double(e.r_mm) + 0.08).epsilon(1e-5));
        quarters[std::size_t(x > 0.0) * 2 + std::size_t(z > 0.0)] += 1.0;
    }
    CHECK(chi_square_uniform(quarters) > 1e-4);
}

TEST_CASE("without scattering the distances of its component are uniform", "[integrate_power]") {
    const MediumSpectra ink{"ink", Spectrum::constant(0.0), Spectrum::constant(1.0)};
    const Drawn drawn = draw(make_medium_mixture(ink), 1.0f, STOKES_MAP_SINGLE, 30.0, 1u << 14, 4);
    std::vector<double> counts(32, 0.0);
    for (const float r : drawn.r_mm) counts[std::min(std::size_t(double(r) / 9.9 * 32.0), std::size_t{31})] += 1.0;
    CHECK(chi_square_uniform(counts) > 1e-4);
}

TEST_CASE("distances are finite in the thinnest and densest media", "[integrate_power][tiny]") {
    for (const double sigma : {1e-9, 1e9})
        for (const std::uint32_t component : components) {
            const MediumSpectra medium{"extreme", Spectrum::constant(0.5 * sigma), Spectrum::constant(0.5 * sigma)};
            for (const float r : draw(make_medium_mixture(medium), 1.0f, component, 60.0, 64, 5).r_mm)
                CHECK((r >= 0.0f && r <= 9.9f));
        }
}
