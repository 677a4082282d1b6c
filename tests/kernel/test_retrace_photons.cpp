#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/subsurface_fixture.hpp"

using namespace stokes;

namespace {

constexpr float offset_mm = 0.01f;
constexpr double roulette_share = 0.1;  // ROULETTE_SHARE of lib/retrace.clh

// Paths whose exits have been deposited. Exits: single or fluorescence first, multiple behind them.
struct Deposited {
    std::vector<ExitPoint> exits;
    std::vector<Flux16> flux, exit_flux;
    std::vector<PathLedger> ledgers;
};

struct Retraced {
    std::vector<Ray> rays;
    std::vector<Flux16> flux;
    std::vector<PathLedger> ledgers;
};

EventRound round_for(std::size_t count, std::uint32_t last = 0) {
    EventRound round{};
    round.count = std::uint32_t(count);
    round.event = 4;
    round.second_exit = std::uint32_t(count);
    round.last = last;
    round.exits = 1;
    return round;
}

Retraced retrace_elastic(const Deposited& d, std::uint32_t seed, std::uint32_t last = 0) {
    const std::size_t count = d.exits.size() / 2;
    const Buffer<Ray> rays = on_device(std::vector<Ray>(d.flux.size(), Ray{}));
    const Buffer<Flux16> flux = on_device(d.flux);
    const Buffer<PathLedger> ledgers = on_device(d.ledgers);
    EventRound round = round_for(count, last);
    round.component = STOKES_MAP_SINGLE;
    Program(test_device(), "retrace_subsurface.cl")
        .kernel("retrace_elastic")
        .launch(count, Arguments()
                           .add("round", round)
                           .add("pass", pass_on_device(seed, 0, offset_mm))
                           .add("exits", on_device(d.exits))
                           .add("materials", on_device(translucent_materials()))
                           .add("rays", rays)
                           .add("departures", open_departures(d.flux.size()))
                           .add("flux", flux)
                           .add("ledgers", ledgers));
    return {rays.download(), flux.download(), ledgers.download()};
}

Retraced retrace_fluorescence(const Deposited& d, EventRound round, std::uint32_t seed) {
    const Buffer<Ray> rays = on_device(std::vector<Ray>(d.flux.size(), Ray{}));
    const Buffer<Flux16> flux = on_device(d.flux);
    const Buffer<PathLedger> ledgers = on_device(d.ledgers);
    Program(test_device(), "retrace_subsurface.cl")
        .kernel("retrace_fluorescence")
        .launch(round.count, Arguments()
                                 .add("round", round)
                                 .add("pass", pass_on_device(seed, 0, offset_mm))
                                 .add("exits", on_device(d.exits))
                                 .add("materials", on_device(translucent_materials()))
                                 .add("spectra", on_device(translucent_spectra()))
                                 .add("exit_flux", on_device(d.exit_flux))
                                 .add("rays", rays)
                                 .add("departures", open_departures(d.flux.size()))
                                 .add("flux", flux)
                                 .add("ledgers", ledgers));
    return {rays.download(), flux.download(), ledgers.download()};
}

const glm::dvec3 single_normal(0.6, 0.0, -0.8), multiple_normal(0.0, 1.0, 0.0);

// The photons are asked for by no case here.
LightSum energy_alone(double energy) { return {static_cast<float>(energy), 0.0f}; }

// The same elastic event many times: shares of the incident flux that single and multiple scattering keep.
Deposited elastic_events(std::uint32_t paths, double single, double multiple, bool single_found = true,
                         bool multiple_found = true) {
    std::mt19937 generator(6);
    const Flux16 incident = random_flux(generator, 0.5, 1.5);
    const double in = sum_of(incident);
    Deposited d;
    d.flux.assign(paths, incident);
    d.ledgers.assign(paths, open_ledger(incident));
    for (std::uint32_t i = 0; i < paths; ++i)
        d.exits.push_back(exit_at(single_normal, i, energy_alone(single * in), single_found));
    for (std::uint32_t i = 0; i < paths; ++i)
        d.exits.push_back(exit_at(multiple_normal, i, energy_alone(multiple * in), multiple_found));
    return d;
}

bool leaves_at(const Ray& ray, const glm::dvec3& normal) {
    return glm::length(origin_of(ray) - (2.0 + double(offset_mm)) * normal) < 1e-5;
}

void check_going_on(const Ray& ray, const PathLedger& ledger, const glm::dvec3& normal) {
    CHECK(ledger.fate == STOKES_FATE_ALIVE);
    CHECK(ledger.rays == 2);
    CHECK(leaves_at(ray, normal));
    CHECK(glm::dot(direction_of(ray), normal) > 0.0);
    CHECK(ray.t_max == std::numeric_limits<float>::infinity());
}

// Shares single : multiple : ended of the paths, against the incident flux times max(s + m, 1) that each
// carries. The comparisons of one case: a chi-square test at 1e-4, the carried flux of either exit and the
// roulette balance at 4 standard errors.
void check_elastic(double single, double multiple, bool single_found, bool multiple_found) {
    CAPTURE(single, multiple, single_found, multiple_found);
    constexpr std::uint32_t paths = 1u << 16;
    const Deposited d = elastic_events(paths, single, multiple, single_found, multiple_found);
    const Retraced r = retrace_elastic(d, 31);
    CHECK(worst_imbalance(r.ledgers, r.flux) < 1e-5);

    const double scale = std::max(1.0, single + multiple);
    std::vector<double> counts(4, 0.0);  // single, multiple, ended by chance, ended at a missed exit
    Sample at_single, at_multiple, roulette;
    for (std::uint32_t i = 0; i < paths; ++i) {
        const PathLedger& ledger = r.ledgers[i];
        const bool alive = ledger.fate == STOKES_FATE_ALIVE;
        const bool first = alive && leaves_at(r.rays[i], single_normal);
        roulette.add(double(ledger.roulette.energy));
        at_single.add(first ? double(r.flux[i].v[3]) : 0.0);
        at_multiple.add(alive && !first ? double(r.flux[i].v[3]) : 0.0);
        if (!alive) {
            REQUIRE(r.rays[i].t_max < r.rays[i].t_min);
            REQUIRE((ledger.fate == STOKES_FATE_ABSORBED || ledger.fate == STOKES_FATE_MISSED_EXIT));
            counts[ledger.fate == STOKES_FATE_ABSORBED ? 2 : 3] += 1.0;
            continue;
        }
        counts[first ? 0 : 1] += 1.0;
        check_going_on(r.rays[i], ledger, first ? single_normal : multiple_normal);
        for (std::size_t k = 0; k < 16; ++k)
            REQUIRE(double(r.flux[i].v[k]) == Approx(double(d.flux[i].v[k]) * scale).epsilon(1e-6));
    }
    const double s = single / scale, m = multiple / scale;
    const std::vector<double> expected = {single_found ? s : 0.0, multiple_found ? m : 0.0, 1.0 - s - m,
                                          (single_found ? 0.0 : s) + (multiple_found ? 0.0 : m)};
    std::vector<double> seen, means;
    for (std::size_t k = 0; k < 4; ++k) {
        if (expected[k] < 1e-6) {
            CHECK(counts[k] <= 2.0);  // the rounding of s + m = 1
            continue;
        }
        seen.push_back(counts[k]);
        means.push_back(expected[k] * paths);
    }
    if (seen.size() > 1) CHECK(chi_square_p_value(seen, means) > 1e-4);
    const double incident = double(d.flux[0].v[3]);
    CHECK(std::abs(at_single.mean() - (single_found ? single * incident : 0.0)) <=
          4.0 * at_single.standard_error() + 1e-6);
    CHECK(std::abs(at_multiple.mean() - (multiple_found ? multiple * incident : 0.0)) <=
          4.0 * at_multiple.standard_error() + 1e-6);
    CHECK(std::abs(roulette.mean()) <= 4.0 * roulette.standard_error() + 1e-5);
}

// Fluorescent events at the three materials, their deposits by a made-up share of what was converted.
Deposited fluorescent_events(std::uint32_t paths, double lowest_share, double highest_share) {
    const SubsurfaceArrivals arrivals(paths);
    const std::vector<MaterialRecord> materials = translucent_materials();
    const std::vector<Flux16> spectra = translucent_spectra();
    std::mt19937 generator(7);
    Deposited d{{}, arrivals.flux, {}, arrivals.ledgers};
    for (std::uint32_t i = 0; i < paths; ++i) {
        const std::array<double, 16> converted = reradiated(materials[i % 3], spectra, d.flux[i]);
        const Flux16 share = random_flux(generator, lowest_share, highest_share);
        d.exit_flux.push_back(constant_flux(0.0f));
        for (std::size_t k = 0; k < 16; ++k)
            d.exit_flux[i].v[k] = static_cast<float>(converted[k] * double(share.v[k]));
        d.exits.push_back(exit_at(single_normal, i, energy_alone(sum_of(d.exit_flux[i])), i % 11 != 10, i % 3));
        d.exits[i].event_light.energy = static_cast<float>(std::accumulate(converted.begin(), converted.end(), 0.0));
    }
    return d;
}

}  // namespace

TEST_CASE("an S or M photon goes on with probability flux kept / flux in", "[retrace]") {
    check_elastic(0.3, 0.45, true, true);
    check_elastic(0.05, 0.0, true, true);
    check_elastic(0.0, 0.9, true, true);
    check_elastic(0.25, 0.75, true, true);
}

TEST_CASE("where S and M together keep more than arrived, one always goes on, with more flux", "[retrace]") {
    check_elastic(0.9, 0.6, true, true);
    check_elastic(0.1, 2.9, true, true);
}

TEST_CASE("a photon that would go on from a missed exit ends there", "[retrace]") {
    check_elastic(0.3, 0.45, false, true);
    check_elastic(0.3, 0.45, true, false);
    check_elastic(0.9, 0.6, false, false);
}

TEST_CASE("elastic ledgers close, whatever was missed or cut", "[retrace][tiny]") {
    for (const auto& [single, multiple] : {std::pair{0.2, 0.3}, std::pair{0.8, 0.9}, std::pair{0.0, 0.0}})
        for (const int missed : {0, 1, 2, 3})
            for (const std::uint32_t last : {0u, 1u}) {
                CAPTURE(single, multiple, missed, last);
                const Deposited d = elastic_events(40, single, multiple, (missed & 1) == 0, (missed & 2) == 0);
                const Retraced r = retrace_elastic(d, 32, last);
                CHECK(worst_imbalance(r.ledgers, r.flux) < 1e-5);
                for (const PathLedger& ledger : r.ledgers) {
                    const double in = double(ledger.emitted.energy);
                    const double lost = (missed & 1 ? single : 0.0) * in + (missed & 2 ? multiple : 0.0) * in;
                    CHECK(double(ledger.created.energy) ==
                          Approx(std::max(single + multiple - 1.0, 0.0) * in).epsilon(1e-5));
                    CHECK(double(ledger.absorbed.energy) ==
                          Approx(std::max(1.0 - single - multiple, 0.0) * in).epsilon(1e-5));
                    if (ledger.fate != STOKES_FATE_EVENT_LIMIT)
                        CHECK(double(ledger.dropped.energy) == Approx(lost).margin(1e-6));
                    if (last == 1) CHECK(ledger.fate != STOKES_FATE_ALIVE);
                }
            }
}

TEST_CASE("directions after elastic scattering are cosine-distributed about the exit's normal", "[retrace]") {
    const Retraced r = retrace_elastic(elastic_events(1u << 17, 1.0, 0.0), 33);
    CosineHistogram histogram(24);
    for (const Ray& ray : r.rays) histogram.add(single_normal, direction_of(ray));
    CHECK(chi_square_uniform(histogram.counts()) > 1e-3);
}

// Bright enough for every path to go on: with what was stored, bit for bit.
TEST_CASE("an F photon goes on with the flux that left", "[retrace][tiny]") {
    const Deposited d = fluorescent_events(110, 0.5, 1.5);
    const Retraced r = retrace_fluorescence(d, round_for(110), 34);
    CHECK(worst_imbalance(r.ledgers, r.flux) < 1e-5);
    int bright = 0;
    for (std::uint32_t i = 0; i < 110; ++i) {
        CAPTURE(i);
        const ExitPoint& exit_point = d.exits[i];
        const PathLedger& ledger = r.ledgers[i];
        if (exit_point.found == 0) {
            CHECK(ledger.fate == STOKES_FATE_MISSED_EXIT);
            CHECK(ledger.dropped.energy == exit_point.kept.energy);
            CHECK(r.rays[i].t_max < r.rays[i].t_min);
            continue;
        }
        if (double(exit_point.kept.energy) < 1.001 * roulette_share * double(ledger.emitted.energy)) continue;
        ++bright;
        check_going_on(r.rays[i], ledger, single_normal);
        CHECK(same_bits(r.flux[i], d.exit_flux[i]));
        CHECK(std::abs(double(ledger.roulette.energy)) < 1e-6 * double(ledger.emitted.energy));
    }
    CHECK(bright > 50);
}

// absorbed: what the fluorophore did not take up, and what the medium kept; created: what a table above one
// added; stokes_loss: taken up and not re-emitted.
TEST_CASE("a fluorescent event's losses stand in the ledger where they belong", "[retrace][tiny]") {
    const std::vector<MaterialRecord> materials = translucent_materials();
    const std::vector<Flux16> spectra = translucent_spectra();
    for (const auto& [low, high] : {std::pair{0.1, 0.6}, std::pair{1.2, 1.9}}) {
        const Deposited d = fluorescent_events(90, low, high);
        const Retraced r = retrace_fluorescence(d, round_for(90), 35);
        CHECK(worst_imbalance(r.ledgers, r.flux) < 1e-5);
        for (std::uint32_t i = 0; i < 90; ++i) {
            CAPTURE(i, low);
            double taken = 0.0;
            for (std::size_t k = 0; k < 16; ++k)
                taken += double(d.flux[i].v[k]) * double(spectra[materials[i % 3].excitation_row].v[k]);
            const double in = sum_of(d.flux[i]), converted = double(d.exits[i].event_light.energy),
                         kept = double(d.exits[i].kept.energy);
            const PathLedger& ledger = r.ledgers[i];
            CHECK(double(ledger.stokes_loss.energy) == Approx(taken - converted).margin(1e-5 * in));
            CHECK(double(ledger.absorbed.energy) ==
                  Approx(in - taken + std::max(converted - kept, 0.0)).margin(1e-5 * in));
            CHECK(double(ledger.created.energy) == Approx(std::max(kept - converted, 0.0)).margin(1e-5 * in));
        }
    }
}

TEST_CASE("an F photon in the last round is cut", "[retrace][tiny]") {
    const Deposited d = fluorescent_events(110, 0.5, 1.5);
    const Retraced cut = retrace_fluorescence(d, round_for(110, 1), 36);
    CHECK(worst_imbalance(cut.ledgers, cut.flux) < 1e-5);
    for (const PathLedger& ledger : cut.ledgers) CHECK(ledger.fate != STOKES_FATE_ALIVE);
}

// Flux kept 2 % of what the photon was emitted with: with roulette below 10 %, one in five goes on, five
// times as bright. One binomial count, 15 wavelengths that are not dark, the roulette balance: 17 comparisons
// at 4 standard errors, together wrong once in 900.
TEST_CASE("roulette keeps the expectation of faint F photons", "[retrace]") {
    constexpr std::uint32_t paths = 1u << 16;
    Deposited d = fluorescent_events(1, 0.5, 0.6);
    const double factor = 0.02 * sum_of(d.flux[0]) / sum_of(d.exit_flux[0]);
    for (float& f : d.exit_flux[0].v) f *= static_cast<float>(factor);
    d.exits[0].kept.energy = static_cast<float>(sum_of(d.exit_flux[0]));
    d = {std::vector<ExitPoint>(paths, d.exits[0]), std::vector<Flux16>(paths, d.flux[0]),
         std::vector<Flux16>(paths, d.exit_flux[0]), std::vector<PathLedger>(paths, d.ledgers[0])};
    for (std::uint32_t i = 0; i < paths; ++i) d.exits[i].path = i;
    const Retraced r = retrace_fluorescence(d, round_for(paths), 37);
    CHECK(worst_imbalance(r.ledgers, r.flux) < 1e-5);
    std::array<Sample, 16> carried;
    Sample alive, roulette;
    for (std::uint32_t i = 0; i < paths; ++i) {
        const bool goes_on = r.ledgers[i].fate == STOKES_FATE_ALIVE;
        alive.add(goes_on ? 1.0 : 0.0);
        roulette.add(double(r.ledgers[i].roulette.energy));
        for (std::size_t k = 0; k < 16; ++k) carried[k].add(goes_on ? double(r.flux[i].v[k]) : 0.0);
    }
    CHECK(std::abs(alive.z(0.02 / roulette_share)) < 4.0);
    CHECK(std::abs(roulette.z(0.0)) < 4.0);
    CHECK(carried[0].mean() == 0.0);  // nothing is emitted at the shortest wavelength
    for (std::size_t k = 1; k < 16; ++k) CHECK(std::abs(carried[k].z(double(d.exit_flux[0].v[k]))) < 4.0);
}
