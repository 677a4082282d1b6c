#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/normals.hpp"
#include "tests/support/photon_fixture.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/textures.hpp"

using namespace stokes;

namespace {

constexpr float offset_mm = 0.01f;
constexpr std::uint32_t empty = 0xabababab;

// Paths at surfaces, and the list of those that scatter.
struct Arrivals {
    std::vector<std::uint32_t> list;
    std::vector<SurfacePoint> points;
    std::vector<Flux16> flux, spectra;
    std::vector<PathLedger> ledgers;
    // Where materials have textures:
    std::vector<Hit> hits = {};
    std::vector<TextureRecord> textures = {};
    std::vector<float> texels = {};
    std::vector<TriangleUv> uv = {};
};

struct Scattered {
    std::vector<Ray> rays;
    std::vector<Flux16> flux;
    std::vector<PathLedger> ledgers;
    std::vector<PhotonHead> heads;
    std::vector<Flux16> map_flux;
};

Scattered scatter(const Arrivals& a, EventRound round, std::size_t slots, std::uint32_t seed = 1) {
    round.count = std::uint32_t(a.list.size());
    const Buffer<Ray> rays = on_device(std::vector<Ray>(a.flux.size(), Ray{}));
    const Buffer<Flux16> flux = on_device(a.flux),
                         map_flux = on_device(std::vector<Flux16>(slots, constant_flux(-1.0f)));
    const Buffer<PathLedger> ledgers = on_device(a.ledgers);
    const Buffer<PhotonHead> heads = on_device(std::vector<PhotonHead>(slots, PhotonHead{0, 0, 0, empty}));
    const bool textured = !a.textures.empty();
    const DeviceTextures textures = textured
                                        ? DeviceTextures{on_device(a.textures), on_device(a.texels), on_device(a.uv)}
                                        : no_textures(a.spectra.size());
    const Buffer<Hit> hits = on_device(textured ? a.hits : std::vector<Hit>(a.flux.size(), Hit{}));
    Program(test_device(), "scatter_photons.cl")
        .kernel("scatter_diffuse")
        .launch(round.count, Arguments()
                                 .add("round", round)
                                 .add("pass", pass_on_device(seed, 0, offset_mm))
                                 .add("event_lists", on_device(a.list))
                                 .add("points", on_device(a.points))
                                 .add("hits", hits)
                                 .add("spectra", on_device(a.spectra))
                                 .add("texture_records", textures.records)
                                 .add("texels", textures.texels)
                                 .add("texture_uv", textures.uv)
                                 .add("rays", rays)
                                 .add("departures", open_departures(a.flux.size()))
                                 .add("flux", flux)
                                 .add("ledgers", ledgers)
                                 .add("map_heads", heads)
                                 .add("map_flux", map_flux));
    return {rays.download(), flux.download(), ledgers.download(), heads.download(), map_flux.download()};
}

// Every other path scatters, at a surface of one of four reflectances: 0, 1 and two that change with
// wavelength.
Arrivals random_arrivals(std::uint32_t paths) {
    std::mt19937 generator(paths);
    Arrivals a;
    a.spectra = {constant_flux(0.0f), constant_flux(1.0f), random_flux(generator, 0.0, 1.0),
                 random_flux(generator, 0.2, 0.4)};
    for (std::uint32_t i = 0; i < paths; ++i) {
        const glm::vec3 p(random_direction(generator)), n(random_direction(generator));
        a.points.push_back({3.0f * p.x, 3.0f * p.y, 3.0f * p.z, (i / 2) % 4, n.x, n.y, n.z, 0});
        a.flux.push_back(random_flux(generator, 0.1, 2.0));
        a.ledgers.push_back(open_ledger(a.flux.back()));
        if (i % 2 == 0) a.list.push_back(i);
    }
    return a;
}

// Reflection of the same flux by the same surface, many times.
Arrivals repeated_arrivals(std::uint32_t paths) {
    std::mt19937 generator(8);
    const Flux16 reflectance = random_flux(generator, 0.1, 0.9), flux = random_flux(generator, 0.5, 1.5);
    Arrivals a;
    a.spectra = {reflectance};
    a.points.assign(paths, {1.0f, 2.0f, 3.0f, 0, 0.6f, 0.0f, -0.8f, 0});
    a.flux.assign(paths, flux);
    a.ledgers.assign(paths, open_ledger(flux));
    a.list.resize(paths);
    std::iota(a.list.begin(), a.list.end(), 0u);
    return a;
}

EventRound round_from(std::uint32_t first_slot, std::uint32_t slot_limit) {
    EventRound round{};
    round.event = 3;
    round.component = STOKES_MAP_SURFACE;
    round.first_slot = first_slot;
    round.slot_limit = slot_limit;
    return round;
}

void check_path(const Arrivals& a, const Scattered& s, std::uint32_t path) {
    const PathLedger& ledger = s.ledgers[path];
    CAPTURE(path);
    CHECK(std::abs(imbalance_of(ledger, s.flux[path])) < 1e-5);
    if (ledger.fate != STOKES_FATE_ALIVE) {
        CHECK(ledger.fate == STOKES_FATE_ABSORBED);
        CHECK(s.rays[path].t_max < s.rays[path].t_min);
        CHECK(ledger.rays == 1);
        return;
    }
    const SurfacePoint& p = a.points[path];
    const glm::dvec3 at(p.x, p.y, p.z), n(p.nx, p.ny, p.nz);
    CHECK(glm::length(origin_of(s.rays[path]) - (at + double(offset_mm) * n)) < 1e-6);
    CHECK(glm::dot(direction_of(s.rays[path]), n) > 0.0);
    CHECK(s.rays[path].t_min == 0.0f);
    CHECK(s.rays[path].t_max == std::numeric_limits<float>::infinity());
    CHECK(ledger.rays == 2);
}

void check_all(std::uint32_t paths) {
    const Arrivals a = random_arrivals(paths);
    const std::uint32_t first = 5, slots = first + std::uint32_t(a.list.size());
    const Scattered s = scatter(a, round_from(first, slots), slots + 20);
    for (std::size_t i = 0; i < a.list.size(); ++i) {
        const std::uint32_t path = a.list[i];
        check_path(a, s, path);
        const SurfacePoint& p = a.points[path];
        const PhotonHead& head = s.heads[first + i];
        CHECK((head.x == p.x && head.y == p.y && head.z == p.z));
        CHECK(same_normal(head.normal, {p.nx, p.ny, p.nz}));
        CHECK(head.normal >> 24 == (p.body & 255u));
        CHECK(same_bits(s.map_flux[first + i], a.flux[path]));
        CHECK(double(s.ledgers[path].stored.energy) == Approx(sum_of(a.flux[path])).epsilon(1e-6));
        if (p.material == 0) CHECK(s.ledgers[path].fate == STOKES_FATE_ABSORBED);
        if (p.material == 1) {  // white: goes on with the same flux
            CHECK(s.ledgers[path].fate == STOKES_FATE_ALIVE);
            for (int k = 0; k < 16; ++k) CHECK(s.flux[path].v[k] == Approx(a.flux[path].v[k]).epsilon(1e-6));
        }
    }
    for (std::size_t slot = 0; slot < s.heads.size(); ++slot)
        if (slot < first || slot >= slots) CHECK(s.heads[slot].normal == empty);
    for (std::uint32_t path = 1; path < paths; path += 2) {  // not in the list
        CHECK(std::memcmp(&s.ledgers[path], &a.ledgers[path], sizeof(PathLedger)) == 0);
        CHECK(same_bits(s.flux[path], a.flux[path]));
    }
}

}  // namespace

TEST_CASE("photons are stored with what they bring, and their ledgers close", "[scatter_photons][tiny]") {
    check_all(200);
}

TEST_CASE("many photons are stored with what they bring, and their ledgers close", "[scatter_photons]") {
    check_all(20001);
}

TEST_CASE("nothing is stored beyond the last slot, and the paths go on all the same", "[scatter_photons][tiny]") {
    const Arrivals a = random_arrivals(200);
    const Scattered all = scatter(a, round_from(3, 200), 200), some = scatter(a, round_from(3, 50), 200);
    for (std::uint32_t slot = 0; slot < 200; ++slot) {
        const bool used = slot >= 3 && slot < 50;
        CHECK((some.heads[slot].normal != empty) == used);
        CHECK((some.map_flux[slot].v[0] >= 0.0f) == used);
    }
    for (std::size_t i = 0; i < a.list.size(); ++i) {
        const std::uint32_t path = a.list[i];
        CHECK(std::memcmp(&some.rays[path], &all.rays[path], sizeof(Ray)) == 0);
        CHECK(same_bits(some.flux[path], all.flux[path]));
        CHECK(some.ledgers[path].stored.energy == (i < 47 ? all.ledgers[path].stored.energy : 0.0f));
        CHECK(std::abs(imbalance_of(some.ledgers[path], some.flux[path])) < 1e-5);
    }
}

TEST_CASE("in the last round paths are cut, and counted", "[scatter_photons][tiny]") {
    const Arrivals a = random_arrivals(200);
    EventRound round = round_from(0, 200);
    const Scattered going = scatter(a, round, 200);
    round.last = 1;
    const Scattered cut = scatter(a, round, 200);
    for (const std::uint32_t path : a.list) {
        CHECK(std::abs(imbalance_of(cut.ledgers[path], cut.flux[path])) < 1e-5);
        if (going.ledgers[path].fate == STOKES_FATE_ALIVE) {
            CHECK(cut.ledgers[path].fate == STOKES_FATE_EVENT_LIMIT);
            CHECK(double(cut.ledgers[path].dropped.energy) == Approx(sum_of(going.flux[path])).epsilon(1e-6));
            CHECK(cut.rays[path].t_max < cut.rays[path].t_min);
        } else {
            CHECK(cut.ledgers[path].fate == STOKES_FATE_ABSORBED);
        }
    }
}

TEST_CASE("a photon without flux ends", "[scatter_photons][tiny]") {
    Arrivals a = random_arrivals(8);
    for (Flux16& flux : a.flux) flux = constant_flux(0.0f);
    const Scattered s = scatter(a, round_from(0, 8), 8);
    for (const std::uint32_t path : a.list) {
        CHECK(s.ledgers[path].fate == STOKES_FATE_ABSORBED);
        CHECK(s.ledgers[path].absorbed.energy == 0.0f);
    }
}

// Materials 2 and 3 with one texture, white where material 1 is, at the luminances 0.25 and 0.75 of the
// middles of its two texels; the others without.
TEST_CASE("a texture's reflectance is what the photon that meets it loses and keeps", "[scatter_photons][tiny]") {
    Arrivals a = random_arrivals(400);
    const TextureRecord none{0, 0, 0, STOKES_NONE}, texture{2, 1, 0, 1};
    a.textures = {none, none, texture, texture};
    a.texels = {0.25f, 0.75f};
    a.uv = {{0.25f, 0.5f, 0.75f, 0.5f, 0.25f, 0.5f, 0, 0}};
    for (std::size_t path = 0; path < a.flux.size(); ++path)
        a.hits.push_back({1.0f, path % 4 == 0 ? 0.0f : 1.0f, 0.0f, 0});
    const Scattered s = scatter(a, round_from(0, 400), 400);
    for (const std::uint32_t path : a.list) {
        check_path(a, s, path);
        const std::uint32_t material = a.points[path].material;
        const float luminance = material < 2 ? 0.0f : path % 4 == 0 ? 0.25f : 0.75f;
        Flux16 reflected;
        for (std::size_t k = 0; k < 16; ++k) {
            const float black = a.spectra[material].v[k];
            reflected.v[k] = a.flux[path].v[k] * (black + luminance * (a.spectra[1].v[k] - black));
        }
        const double arriving = sum_of(a.flux[path]), leaving = sum_of(reflected);
        CHECK(double(s.ledgers[path].absorbed.energy) == Approx(arriving - leaving).margin(1e-4));
        if (s.ledgers[path].fate != STOKES_FATE_ALIVE) continue;
        for (std::size_t k = 0; k < 16; ++k)
            CHECK(double(s.flux[path].v[k]) == Approx(double(reflected.v[k]) * arriving / leaving).epsilon(1e-5));
    }
}

// The survivors: a binomial count with p = sum(rho flux) / sum(flux). The carried flux, zero for the others,
// has the mean rho flux at every wavelength; roulette's balance has mean zero. 18 comparisons at 4 standard
// errors: together wrong once in 800. The directions: one chi-square test, wrong once in 1000.
TEST_CASE("reflected flux has the right expectation at every wavelength", "[scatter_photons]") {
    constexpr std::uint32_t paths = 1u << 17;
    const Arrivals a = repeated_arrivals(paths);
    const Scattered s = scatter(a, round_from(0, paths), paths, 42);
    Flux16 reflected;
    for (int k = 0; k < 16; ++k) reflected.v[k] = a.flux[0].v[k] * a.spectra[0].v[k];
    const double survival = sum_of(reflected) / sum_of(a.flux[0]);

    std::array<Sample, 16> carried;
    Sample alive, roulette;
    CosineHistogram directions(24);
    for (std::uint32_t path = 0; path < paths; ++path) {
        const bool goes_on = s.ledgers[path].fate == STOKES_FATE_ALIVE;
        alive.add(goes_on ? 1.0 : 0.0);
        roulette.add(double(s.ledgers[path].roulette.energy));
        for (std::size_t k = 0; k < 16; ++k) carried[k].add(goes_on ? double(s.flux[path].v[k]) : 0.0);
        if (goes_on) directions.add({0.6, 0.0, -0.8}, direction_of(s.rays[path]));
    }
    CHECK(std::abs(alive.z(survival)) < 4.0);
    CHECK(std::abs(roulette.z(0.0)) < 4.0);
    for (std::size_t k = 0; k < 16; ++k) {
        CHECK(carried[k].standard_error() < 0.005 * double(reflected.v[k]));
        CHECK(std::abs(carried[k].z(double(reflected.v[k]))) < 4.0);
    }
    CHECK(chi_square_uniform(directions.counts()) > 1e-3);
}
