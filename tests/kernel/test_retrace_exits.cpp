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

ExitPoint exit_at(const glm::dvec3& normal, std::uint32_t path, const Flux16& kept, const Flux16& event, bool found,
                  std::uint32_t material) {
    const glm::vec3 n(normal), p = 2.0f * n;
    return {p.x,  p.y,  p.z,      found ? 1.5f : -1.5f, n.x,  n.y,           n.z,
            0.5f, path, material, 0.7f,                 2.0f, light_of(kept), light_of(event)};
}

Flux16 times(const Flux16& flux, double factor) {
    Flux16 result = flux;
    for (float& v : result.v) v = static_cast<float>(double(v) * factor);
    return result;
}

Events events(std::uint32_t paths, double direct, double scattered, bool direct_found = true, bool scattered_found = true,
              std::uint32_t material = 0) {
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
        e.exits.push_back(exit_at(direct_normal, i, first, sent_on, direct_found, material));
    for (std::uint32_t i = 0; i < paths; ++i)
        e.exits.push_back(exit_at(scattered_normal, i, second, taken_up, scattered_found, material));
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
    round.second_exit = count;
    round.slot_limit = round.second_limit = count;
    round.last = last;
    std::vector<MaterialRecord> materials = translucent_materials();
    for (MaterialRecord& m : materials) m.exit_scale = exit_scale;
    const Buffer<Ray> rays = on_device(std::vector<Ray>(count, Ray{}));
    const Buffer<Flux16> flux = on_device(e.flux);
    const Buffer<PathLedger> ledgers = on_device(e.ledgers);
    Program(test_device(), "deposit_subsurface.cl")
        .kernel("retrace_exits")
        .launch(count, round, pass_on_device(seed, 0, offset_mm), on_device(e.exits), on_device(materials),
                on_device(e.first_map), on_device(e.second_map), rays, flux, ledgers);
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
