#include <array>
#include <cmath>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/subsurface_fixture.hpp"

using namespace stokes;

namespace {

constexpr float offset_mm = 0.01f;
const glm::dvec3 direct_normal(0.6, 0.0, -0.8), scattered_normal(0.0, 1.0, 0.0);

// One event many times: what arrives, is taken up and sent on, and what leaves directly and scattered.
struct Events {
    std::vector<ExitPoint> exits;  // direct, then scattered
    std::vector<Flux16> flux, first_map, second_map;
    std::vector<PathLedger> ledgers;
};

ExitPoint exit_with(const glm::dvec3& normal, std::uint32_t path, const Flux16& kept, const Flux16& event, bool found,
                    std::uint32_t material) {
    ExitPoint exit = exit_at(normal, path, light_of(kept), found, material);
    exit.event_light = light_of(event);
    exit.scale = 2.0f;  // it is in the light kept already
    return exit;
}

Flux16 times(const Flux16& flux, double factor) {
    Flux16 result = flux;
    for (float& v : result.v) v = static_cast<float>(double(v) * factor);
    return result;
}

Events events(std::uint32_t paths, double direct, double scattered, bool direct_found = true,
              bool scattered_found = true, std::uint32_t material = 0) {
    std::mt19937 generator(16);
    const Flux16 arriving = random_flux(generator, 0.5, 1.5), taken_up = random_flux(generator, 0.2, 2.0),
                 sent_on = random_flux(generator, 0.1, 1.5);
    const double in = sum_of(arriving);
    const Flux16 a = random_flux(generator, 0.0, 1.0), b = random_flux(generator, 0.0, 1.0);
    const Flux16 first = times(a, direct * in / sum_of(a)), second = times(b, scattered * in / sum_of(b));
    Events e;
    e.flux.assign(paths, arriving);
    e.ledgers.assign(paths, open_ledger(arriving));
    e.first_map.assign(paths, first);
    e.second_map.assign(paths, second);
    for (std::uint32_t i = 0; i < paths; ++i)
        e.exits.push_back(exit_with(direct_normal, i, first, sent_on, direct_found, material));
    for (std::uint32_t i = 0; i < paths; ++i)
        e.exits.push_back(exit_with(scattered_normal, i, second, taken_up, scattered_found, material));
    return e;
}

struct Retraced {
    std::vector<Ray> rays;
    std::vector<Flux16> flux;
    std::vector<PathLedger> ledgers;
};

Retraced retrace(const Events& e, std::uint32_t component, std::uint32_t seed, std::uint32_t last = 0,
                 float exit_scale = 0.0f) {
    const auto count = static_cast<std::uint32_t>(e.flux.size());
    EventRound round{};
    round.count = count;
    round.event = 4;
    round.component = component;
    round.last = last;
    round.exits = 1;
    ExitGroups groups{};
    groups.count = 2;
    const std::uint32_t other = component == STOKES_MAP_SINGLE ? STOKES_MAP_MULTIPLE : component;
    for (const std::uint32_t g : {0u, 1u}) {
        groups.component[g] = g == 0 ? component : other;
        groups.first_exit[g] = g * count;
    }
    std::vector<Flux16> exit_flux = e.first_map;
    exit_flux.insert(exit_flux.end(), e.second_map.begin(), e.second_map.end());
    std::vector<MaterialRecord> materials = translucent_materials();
    if (exit_scale > 0.0f)
        for (MaterialRecord& m : materials) {
            m.flags |= STOKES_MATERIAL_FRESNEL;
            m.exit_scale = exit_scale;
        }
    const Buffer<Ray> rays = on_device(std::vector<Ray>(count, Ray{}));
    const Buffer<Flux16> flux = on_device(e.flux);
    const Buffer<PathLedger> ledgers = on_device(e.ledgers);
    Program(test_device(), "retrace_subsurface.cl")
        .kernel("retrace_exits")
        .launch(count, Arguments()
                           .add("round", round)
                           .add("groups", groups)
                           .add("pass", pass_on_device(seed, 0, offset_mm))
                           .add("exits", on_device(e.exits))
                           .add("exit_flux", on_device(exit_flux))
                           .add("materials", on_device(materials))
                           .add("rays", rays)
                           .add("departures", open_departures(count))
                           .add("flux", flux)
                           .add("ledgers", ledgers));
    return {rays.download(), flux.download(), ledgers.download()};
}

bool leaves_at(const Ray& ray, const glm::dvec3& normal) {
    return glm::length(origin_of(ray) - (2.0 + double(offset_mm)) * normal) < 1e-5;
}

// Shares of the paths, and the flux they carry: what was stored, at every wavelength, in the mean. A chi-square test
// and 33 comparisons at 4.5 standard errors a call.
void check(double direct, double scattered, bool direct_found, bool scattered_found) {
    CAPTURE(direct, scattered, direct_found, scattered_found);
    constexpr std::uint32_t paths = 1u << 15;
    const Events e = events(paths, direct, scattered, direct_found, scattered_found);
    const Retraced r = retrace(e, STOKES_MAP_SINGLE, 51);
    CHECK(worst_imbalance(r.ledgers, r.flux) < 1e-5);
    const double scale = std::max(1.0, direct + scattered);
    std::vector<double> counts(4, 0.0);  // direct, scattered, ended by chance, ended at a missed exit
    std::array<std::array<Sample, 16>, 2> carried;
    for (std::uint32_t i = 0; i < paths; ++i) {
        const bool alive = r.ledgers[i].fate == STOKES_FATE_ALIVE;
        const bool first = alive && leaves_at(r.rays[i], direct_normal);
        if (alive) {
            REQUIRE((first || leaves_at(r.rays[i], scattered_normal)));
            REQUIRE(sum_of(r.flux[i]) == Approx(scale * sum_of(e.flux[i])).epsilon(1e-5));
            REQUIRE(r.ledgers[i].conversions == 0);
        }
        counts[alive ? (first ? 0 : 1) : r.ledgers[i].fate == STOKES_FATE_ABSORBED ? 2 : 3] += 1.0;
        for (std::size_t k = 0; k < 16; ++k) {
            carried[0][k].add(first ? double(r.flux[i].v[k]) : 0.0);
            carried[1][k].add(alive && !first ? double(r.flux[i].v[k]) : 0.0);
        }
    }
    const double d = direct / scale, s = scattered / scale;
    const std::vector<double> shares = {direct_found ? d : 0.0, scattered_found ? s : 0.0, 1.0 - d - s,
                                        (direct_found ? 0.0 : d) + (scattered_found ? 0.0 : s)};
    std::vector<double> seen, means;
    for (std::size_t k = 0; k < 4; ++k) {
        if (shares[k] < 1e-6) {
            CHECK(counts[k] <= 2.0);
            continue;
        }
        seen.push_back(counts[k]);
        means.push_back(shares[k] * paths);
    }
    if (seen.size() > 1) CHECK(chi_square_p_value(seen, means) > 1e-4);
    for (std::size_t k = 0; k < 16; ++k) {
        CHECK(std::abs(carried[0][k].mean() - (direct_found ? double(e.first_map[0].v[k]) : 0.0)) <=
              4.5 * carried[0][k].standard_error() + 1e-6);
        CHECK(std::abs(carried[1][k].mean() - (scattered_found ? double(e.second_map[0].v[k]) : 0.0)) <=
              4.5 * carried[1][k].standard_error() + 1e-6);
    }
}

}  // namespace

TEST_CASE("what was stored is traced on, by either exit, in the mean", "[retrace_exits]") {
    check(0.3, 0.45, true, true);
    check(0.0, 0.9, true, true);
    check(0.9, 2.6, true, true);
    check(0.3, 0.45, false, true);
    check(0.3, 0.45, true, false);
}

TEST_CASE("ledgers of conserving events close, whatever was missed or cut", "[retrace_exits][tiny]") {
    for (const auto& [direct, scattered] : {std::pair{0.2, 0.3}, std::pair{0.8, 0.9}, std::pair{0.0, 0.0}})
        for (const int missed : {0, 1, 2, 3})
            for (const std::uint32_t component : {STOKES_MAP_FLUORESCENCE, STOKES_MAP_SINGLE})
                for (const std::uint32_t last : {0u, 1u}) {
                    CAPTURE(direct, scattered, missed, component, last);
                    const Events e = events(30, direct, scattered, (missed & 1) == 0, (missed & 2) == 0);
                    const Retraced r = retrace(e, component, 52, last);
                    CHECK(worst_imbalance(r.ledgers, r.flux) < 1e-5);
                    const double in = sum_of(e.flux[0]);
                    const double taken_up = double(e.exits[30].event_light.energy),
                                 sent_on = double(e.exits[0].event_light.energy), kept = (direct + scattered) * in;
                    const bool fluorescent = component == STOKES_MAP_FLUORESCENCE;
                    for (const PathLedger& ledger : r.ledgers) {
                        CHECK(double(ledger.stokes_loss.energy) ==
                              Approx(fluorescent ? taken_up - sent_on : 0.0).margin(1e-5 * in));
                        CHECK(double(ledger.absorbed.energy) ==
                              Approx((fluorescent ? sent_on : taken_up) - kept).margin(1e-5 * in));
                        if (last == 1) CHECK(ledger.fate != STOKES_FATE_ALIVE);
                        if (fluorescent && ledger.fate == STOKES_FATE_ALIVE) CHECK(ledger.conversions == 1);
                    }
                }
}

// Below a surface what another branch would have taken is a matter of chance; on it, it is absorbed.
TEST_CASE("what a surface fluorophore does not take up is absorbed", "[retrace_exits][tiny]") {
    const Events e = events(20, 0.3, 0.0, true, true, 2);
    const Retraced r = retrace(e, STOKES_MAP_FLUORESCENCE, 53);
    CHECK(worst_imbalance(r.ledgers, r.flux) < 1e-5);
    const double in = sum_of(e.flux[0]), taken_up = double(e.exits[20].event_light.energy),
                 sent_on = double(e.exits[0].event_light.energy);
    for (const PathLedger& ledger : r.ledgers)
        CHECK(double(ledger.absorbed.energy) == Approx(in - taken_up + sent_on - 0.3 * in).margin(1e-5 * in));
}

// Through a surface that reflects, a direction weighs T(mu) / (1 - R): its mean over a cosine distribution is one, the
// flux carried is T times that of a surface without reflection, and the ledger closes.
TEST_CASE("light that leaves through a reflecting surface is weighted by its transmittance", "[retrace_exits]") {
    constexpr std::uint32_t paths = 1u << 15;
    constexpr double eta = 1.5, scale = 1.0 / (1.0 - 0.0917784);  // of material 0; R for 1.5
    const Events e = events(paths, 1.0, 0.0);
    const Retraced r = retrace(e, STOKES_MAP_SINGLE, 54, 0, static_cast<float>(scale));
    CHECK(worst_imbalance(r.ledgers, r.flux) < 1e-5);
    Sample weight;
    for (std::uint32_t i = 0; i < paths; ++i) {
        if (r.ledgers[i].fate != STOKES_FATE_ALIVE) continue;
        const double mu = glm::dot(direction_of(r.rays[i]), direct_normal);
        const double within = std::sqrt(1.0 - (1.0 - mu * mu) / (eta * eta));
        const double s = (mu - eta * within) / (mu + eta * within), p = (eta * mu - within) / (eta * mu + within);
        const double expected = (1.0 - 0.5 * (s * s + p * p)) * scale, seen = sum_of(r.flux[i]) / sum_of(e.flux[i]);
        weight.add(seen);
        if (mu > 0.02) REQUIRE(seen == Approx(expected).epsilon(2e-4));
    }
    CHECK(double(weight.count()) > 0.999 * paths);
    CHECK(std::abs(weight.z(1.0)) < 4.0);
}

namespace {

// Events of both branches with three exits a component, and the probability that each exit is the one that goes on:
// kept/in, over their sum where it exceeds one. A chi-square test of thirteen outcomes, and the mean of what is carried
// at each wavelength, the sum of what is stored where a surface was found.
void check_branches(double kept_share) {
    CAPTURE(kept_share);
    constexpr std::uint32_t paths = 1u << 15, each = 3;
    std::mt19937 generator(61);
    const Flux16 arriving = random_flux(generator, 0.5, 1.5);
    const std::vector<std::uint32_t> components = {STOKES_MAP_FLUORESCENCE, STOKES_MAP_FLUORESCENCE, STOKES_MAP_SINGLE,
                                                   STOKES_MAP_MULTIPLE};
    std::array<Flux16, 4> taken_up{}, sent_on{};
    std::array<std::array<Flux16, each>, 4> stored;
    std::array<double, 13> shares{};
    double sum = 0.0;
    for (std::size_t g = 0; g < 4; ++g)
        for (std::size_t k = 0; k < each; ++k) {
            stored[g][k] = times(random_flux(generator, 0.0, 1.0), kept_share / 6.0);
            sum += shares[g * each + k] = sum_of(stored[g][k]) / sum_of(arriving);
        }
    for (std::size_t b : {std::size_t{0}, std::size_t{2}}) {
        taken_up[b] = random_flux(generator, 0.2, 0.8);
        sent_on[b] = random_flux(generator, 0.1, 0.6);
    }
    for (double& share : shares) share /= std::max(sum, 1.0);
    shares[12] = std::max(1.0 - sum, 0.0);

    const std::size_t missed = 4;  // the second scattered exit of fluorescence
    Events e;
    ExitGroups groups{};
    groups.count = 4;
    std::vector<Flux16> exit_flux;
    for (std::size_t g = 0; g < 4; ++g) {
        groups.component[g] = components[g];
        groups.first_exit[g] = static_cast<std::uint32_t>(e.exits.size());
        const Flux16& event = g % 2 == 0 ? sent_on[g] : taken_up[g - 1];
        for (std::uint32_t i = 0; i < paths; ++i)
            for (std::size_t k = 0; k < each; ++k) {
                const double tilt = 0.3 * double(g * each + k);
                const glm::dvec3 normal(0.0, std::cos(tilt), std::sin(tilt));
                e.exits.push_back(exit_with(normal, i, stored[g][k], event, g * each + k != missed, 0));
                exit_flux.push_back(stored[g][k]);
            }
    }
    EventRound round{};
    round.count = paths;
    round.event = 4;
    round.exits = each;
    round.branches = 1;
    const Buffer<Ray> rays = on_device(std::vector<Ray>(paths, Ray{}));
    const Buffer<Flux16> flux = on_device(std::vector<Flux16>(paths, arriving));
    const Buffer<PathLedger> ledgers = on_device(std::vector<PathLedger>(paths, open_ledger(arriving)));
    Program(test_device(), "retrace_subsurface.cl")
        .kernel("retrace_exits")
        .launch(paths, Arguments()
                           .add("round", round)
                           .add("groups", groups)
                           .add("pass", pass_on_device(55, 0, offset_mm))
                           .add("exits", on_device(e.exits))
                           .add("exit_flux", on_device(exit_flux))
                           .add("materials", on_device(translucent_materials()))
                           .add("rays", rays)
                           .add("departures", open_departures(paths))
                           .add("flux", flux)
                           .add("ledgers", ledgers));
    const Retraced r{rays.download(), flux.download(), ledgers.download()};
    CHECK(worst_imbalance(r.ledgers, r.flux) < 1e-5);

    std::vector<double> counts(13, 0.0);
    std::array<Sample, 16> carried;
    for (std::uint32_t i = 0; i < paths; ++i) {
        const PathLedger& ledger = r.ledgers[i];
        const double lost = sum_of(taken_up[0]) - sum_of(sent_on[0]);
        REQUIRE(double(ledger.stokes_loss.energy) == Approx(lost).margin(1e-4));
        std::size_t outcome = ledger.fate == STOKES_FATE_ABSORBED ? 12 : missed;
        if (ledger.fate == STOKES_FATE_ALIVE) {
            for (std::size_t x = 0; x < 12; ++x)
                if (leaves_at(r.rays[i], {0.0, std::cos(0.3 * double(x)), std::sin(0.3 * double(x))})) outcome = x;
            REQUIRE(sum_of(r.flux[i]) == Approx(std::max(sum, 1.0) * sum_of(arriving)).epsilon(1e-5));
            REQUIRE(ledger.conversions == (outcome < 6 ? 1u : 0u));
        }
        counts[outcome] += 1.0;
        for (std::size_t k = 0; k < 16; ++k)
            carried[k].add(ledger.fate == STOKES_FATE_ALIVE ? double(r.flux[i].v[k]) : 0.0);
    }
    std::vector<double> means;
    for (const double share : shares) means.push_back(share * paths);
    if (means.back() < 1.0) {
        CHECK(counts.back() <= 2.0);
        counts.pop_back();
        means.pop_back();
    }
    CHECK(chi_square_p_value(counts, means) > 1e-4);
    for (std::size_t k = 0; k < 16; ++k) {
        double expected = 0.0;
        for (std::size_t x = 0; x < 12; ++x)
            if (x != missed) expected += double(stored[x / each][x % each].v[k]);
        CHECK(std::abs(carried[k].mean() - expected) <= 4.5 * carried[k].standard_error() + 1e-6);
    }
}

}  // namespace

TEST_CASE("of all that both branches store, one exit is traced on, and all in the mean", "[retrace_exits]") {
    check_branches(0.8);
    check_branches(2.4);
}
