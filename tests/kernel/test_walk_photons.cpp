#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "kernels/shared/material.h"
#include "tests/support/catch.hpp"
#include "tests/support/normals.hpp"
#include "tests/support/photon_fixture.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/traced_scene.hpp"
#include "tests/support/triangle_meshes.hpp"

using namespace stokes;

namespace {

constexpr float offset_mm = 1e-4f, radius_mm = 2.0f;
constexpr std::uint32_t empty = STOKES_EMPTY_SLOT;

// Rows of the spectra: excitation, 16 of re-radiation, then sigma_t and albedo of three media: an absorbing one, one
// without loss, and one of weak absorption and mean free path 1 mm.
constexpr std::uint32_t excitation_row = 0, reradiation_row = 1, absorbing_row = 17, lossless_row = 19, pale_row = 21;

enum Kind : std::uint32_t { plain, reflecting, fluorescent, lossless, pale };

std::vector<MaterialRecord> materials() {
    const auto of = [](std::uint32_t flags, float c, float eta, std::uint32_t sigma_row) {
        MaterialRecord record = translucent_record(STOKES_MATERIAL_SUBSURFACE | flags, c, eta);
        record.excitation_row = excitation_row;
        record.reradiation_row = reradiation_row;
        record.sigma_row = sigma_row;
        record.exit_scale = 1.1f;
        return record;
    };
    return {of(0, 0.0f, 1.4f, absorbing_row), of(STOKES_MATERIAL_FRESNEL, 0.0f, 1.4f, absorbing_row),
            of(STOKES_MATERIAL_FRESNEL | STOKES_MATERIAL_FLUORESCENT, 0.7f, 1.4f, absorbing_row),
            of(0, 0.0f, 1.0f, lossless_row), of(STOKES_MATERIAL_FRESNEL, 0.0f, 1.4f, pale_row)};
}

std::vector<Flux16> spectra() {
    std::mt19937 generator(51);
    std::vector<Flux16> rows{random_flux(generator, 0.3, 1.0)};
    for (std::size_t ex = 0; ex < 16; ++ex) {
        rows.push_back(random_flux(generator, 0.0, 0.2));
        for (std::size_t em = 0; em <= ex; ++em) rows.back().v[em] = 0.0f;
    }
    for (const double lowest : {0.5, 1.0}) {
        rows.push_back(random_flux(generator, 0.5, 3.0));
        rows.push_back(random_flux(generator, lowest, 1.0));
    }
    rows.push_back(constant_flux(1.0f));
    rows.push_back(constant_flux(0.0f));
    for (std::size_t k = 0; k < 16; ++k) rows.back().v[k] = 0.99f + 0.0006f * static_cast<float>(k);
    return rows;
}

// A closed sphere about the origin, body 0, and a flat sheet above it that faces up, body 1.
std::vector<Triangle> triangles() {
    std::vector<Triangle> all = sphere_mesh(12, 24, radius_mm, glm::vec3(0.0f), 0);
    all.push_back(make_triangle({-9e4f, 5.0f, -9e4f}, {0.0f, 5.0f, 9e4f}, {9e4f, 5.0f, -9e4f}, 0, 1));
    return all;
}

// Photons at both bodies, alternately, path i at material i % materials; every path but each fifth is in the list.
struct Entering {
    std::vector<SurfacePoint> points;
    std::vector<Ray> rays;
    std::vector<Flux16> flux;
    std::vector<PathLedger> ledgers;
    std::vector<std::uint32_t> list;

    Entering(std::uint32_t paths, const std::vector<std::uint32_t>& kinds, bool even_flux = false) {
        std::mt19937 generator(paths);
        const std::vector<Triangle> all = triangles();
        for (std::uint32_t i = 0; i < paths; ++i) {
            const Triangle& t = i % 2 == 0 ? all[generator() % (all.size() - 1)] : all.back();
            const double u = i % 2 == 0 ? 0.3 : 0.33, v = i % 2 == 0 ? 0.5 : 0.33;
            const glm::dvec3 n = normal_of(t);
            glm::dvec3 d = random_direction(generator);
            if (glm::dot(d, n) > 0.0) d = -d;
            const glm::vec3 at(point_on(t, u, v)), normal(n), direction(d);
            points.push_back({at.x, at.y, at.z, kinds[i / 2 % kinds.size()], normal.x, normal.y, normal.z, t.body});
            rays.push_back({0, 0, 0, 0, direction.x, direction.y, direction.z, 1e30f});
            flux.push_back(even_flux ? constant_flux(1.5f) : random_flux(generator, 0.1, 2.0));
            ledgers.push_back(open_ledger(flux.back()));
            if (i % 5 != 3) list.push_back(i);
        }
    }
};

struct Options {
    std::uint32_t event = 3, last = 0, slot_limit = 1u << 20;
    std::vector<std::string> compiler;
    std::vector<std::uint32_t> bodies = {0, STOKES_BODY_FLAT};  // flags
    bool first_collision_only = false;
};

struct Walked {
    std::array<std::vector<PhotonHead>, 3> heads;
    std::array<std::vector<Flux16>, 3> stored;
    std::vector<Ray> rays;
    std::vector<Flux16> flux;
    std::vector<PathLedger> ledgers;
};

// Slots 4, 7 and 11 are the first of maps F, S and M.
constexpr std::uint32_t first_slot[3] = {4, 7, 11};

Walked walk(const Entering& e, const Options& options = {}) {
    const Traced scene(triangles());
    EventRound round{};
    round.count = static_cast<std::uint32_t>(e.list.size());
    round.event = options.event;
    round.last = options.last;
    WalkSlots slots{};
    const std::size_t room = e.list.size() + 20;
    std::vector<Buffer<PhotonHead>> heads;
    std::vector<Buffer<Flux16>> stored;
    for (std::size_t m = 0; m < 3; ++m) {
        slots.first[m] = first_slot[m];
        slots.limit[m] = std::min(options.slot_limit, static_cast<std::uint32_t>(room));
        heads.push_back(on_device(std::vector<PhotonHead>(room, PhotonHead{0, 0, 0, 77})));
        stored.push_back(on_device(std::vector<Flux16>(room, constant_flux(-1.0f))));
    }
    const Buffer<Ray> rays = on_device(e.rays);
    const Buffer<Flux16> flux = on_device(e.flux);
    const Buffer<PathLedger> ledgers = on_device(e.ledgers);
    std::vector<BodyRecord> bodies;
    for (const std::uint32_t flags : options.bodies) bodies.push_back({flags, 0, STOKES_NONE, 0, 0, {}});
    PassConstants constants = pass_on_device(8, 0, offset_mm).download().front();
    constants.first_collision_only = options.first_collision_only ? 1 : 0;
    Program(test_device(), "walk_photons.cl", options.compiler)
        .kernel("walk_photons")
        .launch(e.list.size(), Arguments()
                                   .add("round", round)
                                   .add("slots", slots)
                                   .add("pass", on_device(std::vector<PassConstants>{constants}))
                                   .add("event_lists", on_device(e.list))
                                   .add("points", on_device(e.points))
                                   .add("bodies", on_device(bodies))
                                   .add(scene.arguments())
                                   .add("triangles", scene.triangle_buffer)
                                   .add("materials", on_device(materials()))
                                   .add("spectra", on_device(spectra()))
                                   .add("rays", rays)
                                   .add("departures", open_departures(e.rays.size()))
                                   .add("flux", flux)
                                   .add("ledgers", ledgers)
                                   .add("fluorescence_heads", heads[0])
                                   .add("fluorescence_flux", stored[0])
                                   .add("single_heads", heads[1])
                                   .add("single_flux", stored[1])
                                   .add("multiple_heads", heads[2])
                                   .add("multiple_flux", stored[2]));
    Walked result;
    for (std::size_t m = 0; m < 3; ++m) {
        result.heads[m] = heads[m].download();
        result.stored[m] = stored[m].download();
    }
    result.rays = rays.download();
    result.flux = flux.download();
    result.ledgers = ledgers.download();
    return result;
}

// The map that holds what left of list entry i, -1 where none does.
int map_of(const Walked& w, std::size_t i) {
    int found = -1;
    for (int m = 0; m < 3; ++m)
        if (w.heads[std::size_t(m)][first_slot[m] + i].normal != empty) {
            REQUIRE(found == -1);
            found = m;
        }
    return found;
}

glm::dvec3 normal_of(const PhotonHead& head) { return glm::normalize(unpack_normal_twin(head.normal)); }

glm::dvec3 place_of(const PhotonHead& head) { return {head.x, head.y, head.z}; }

// Facets of the sphere come as near to the origin as cos(pi/24) of its radius.
void check_on_surface(const SurfacePoint& entry, const glm::dvec3& at, const glm::dvec3& normal) {
    if (entry.body == 1) {
        CHECK(at.y == Approx(5.0).margin(1e-5));
        CHECK(normal.y == Approx(1.0));
        return;
    }
    CHECK(glm::length(at) < double(radius_mm) * 1.0001);
    CHECK(glm::length(at) > double(radius_mm) * 0.97);
    CHECK(glm::dot(normal, at) > 0.95 * double(radius_mm));
}

void check_stored(const Entering& e, const Walked& w, std::size_t i, std::size_t m) {
    const std::uint32_t path = e.list[i];
    const PathLedger& ledger = w.ledgers[path];
    const PhotonHead& head = w.heads[m][first_slot[m] + i];
    const Flux16& flux = w.stored[m][first_slot[m] + i];
    const std::uint32_t kind = e.points[path].material;
    const glm::dvec3 normal = normal_of(head);
    check_on_surface(e.points[path], place_of(head), normal);
    const LightSum light = light_of(flux);
    CHECK(double(ledger.stored.energy) == Approx(double(light.energy)).epsilon(1e-5));
    CHECK(double(ledger.stored.photons) == Approx(double(light.photons)).epsilon(1e-5));
    for (const float f : flux.v) CHECK((f >= 0.0f && std::isfinite(f)));
    if (m == STOKES_MAP_FLUORESCENCE) CHECK((kind == fluorescent && flux.v[0] == 0.0f));  // nothing above the shortest
    if (ledger.fate != STOKES_FATE_ALIVE) return;
    CHECK(ledger.rays == 2);
    CHECK((m == STOKES_MAP_FLUORESCENCE) == (ledger.conversions > 0));
    const Ray& ray = w.rays[path];
    CHECK(glm::length(origin_of(ray) - place_of(head) - double(offset_mm) * normal) < 2e-4 * double(offset_mm) + 1e-5);
    CHECK(glm::dot(direction_of(ray), normal) > -1e-3);
    // It takes along what was stored, times one factor: of the exit's direction, or of roulette.
    const double factor = sum_of(w.flux[path]) / double(light.energy);
    if (kind == plain || kind == lossless) CHECK(factor >= 1.0 - 1e-5);
    for (std::size_t k = 0; k < 16; ++k)
        CHECK(double(w.flux[path].v[k]) == Approx(factor * double(flux.v[k])).epsilon(1e-5).margin(1e-12));
}

void check_walks(const Entering& e, const Options& options = {}) {
    const Walked w = walk(e, options);
    CHECK(worst_imbalance(w.ledgers, w.flux) < 2e-5);
    const std::set<std::uint32_t> listed(e.list.begin(), e.list.end());
    for (std::uint32_t path = 0; path < e.rays.size(); ++path)
        if (listed.count(path) == 0)
            CHECK((std::memcmp(&w.ledgers[path], &e.ledgers[path], sizeof(PathLedger)) == 0 &&
                   std::memcmp(&w.rays[path], &e.rays[path], sizeof(Ray)) == 0 &&
                   same_bits(w.flux[path], e.flux[path])));
    for (std::size_t i = 0; i < e.list.size(); ++i) {
        CAPTURE(i, e.list[i], e.points[e.list[i]].material, w.ledgers[e.list[i]].fate);
        const PathLedger& ledger = w.ledgers[e.list[i]];
        CHECK((ledger.fate == STOKES_FATE_ALIVE || ledger.fate == STOKES_FATE_ABSORBED));
        CHECK(ledger.dropped.energy == 0.0f);
        CHECK(ledger.created.energy == 0.0f);
        if (e.points[e.list[i]].material == lossless) CHECK(ledger.absorbed.energy == 0.0f);
        if (e.points[e.list[i]].material != fluorescent) CHECK(ledger.stokes_loss.energy == 0.0f);
        const int map = map_of(w, i);
        if (map >= 0)
            check_stored(e, w, i, std::size_t(map));
        else
            CHECK((ledger.stored.energy == 0.0f && ledger.fate == STOKES_FATE_ABSORBED));
    }
    for (std::size_t m = 0; m < 3; ++m)
        for (std::size_t slot = 0; slot < w.heads[m].size(); ++slot)
            if (slot < first_slot[m] || slot >= first_slot[m] + e.list.size())
                CHECK((w.heads[m][slot].normal == 77 && w.stored[m][slot].v[0] == -1.0f));
}

const std::vector<std::uint32_t> all_kinds = {plain, reflecting, fluorescent, lossless};

bool same_results(const Walked& a, const Walked& b) {
    bool all = same_bits(a.rays, b.rays) && same_bits(a.flux, b.flux) && same_bits(a.ledgers, b.ledgers);
    for (std::size_t m = 0; m < 3; ++m)
        all = all && same_bits(a.heads[m], b.heads[m]) && same_bits(a.stored[m], b.stored[m]);
    return all;
}

}  // namespace

TEST_CASE("what walks below a surface leaves it once, and its ledger closes", "[walk_photons][tiny]") {
    const Entering e(40, all_kinds);
    check_walks(e);
    Options first;
    first.first_collision_only = true;
    check_walks(e, first);
}

TEST_CASE("many photons walk below surfaces", "[walk_photons]") {
    const Entering e(6000, all_kinds);
    check_walks(e);
    Options first;
    first.first_collision_only = true;
    check_walks(e, first);
}

TEST_CASE("walks do not depend on the work-group size, but on the round", "[walk_photons]") {
    const Entering e(500, all_kinds);
    const std::size_t usual = test_device().local_size();
    test_device().set_local_size(1);
    const Walked one = walk(e);
    test_device().set_local_size(128);
    const Walked many = walk(e);
    test_device().set_local_size(usual);
    CHECK(same_results(one, many));
    Options later;
    later.event = 4;
    const Walked other = walk(e, later);
    int alike = 0;
    for (std::size_t path = 0; path < 500; ++path)
        alike += path % 5 != 3 && std::memcmp(&one.rays[path], &other.rays[path], sizeof(Ray)) == 0;
    CHECK(alike < 200);  // of 400; those that ended in both
}

// Sixteen equal wavelengths: without loss their weights have the mean one in each photon, and each wavelength's mean
// over the photons is one. 16 comparisons at 4 standard errors.
TEST_CASE("a wavelength's weight has mean one and never exceeds sixteen", "[walk_photons]") {
    const Entering e(20000, {lossless}, true);
    const Walked w = walk(e);
    std::array<Sample, 16> weights;
    for (std::size_t i = 0; i < e.list.size(); ++i) {
        const int map = map_of(w, i);
        CAPTURE(i, w.ledgers[e.list[i]].fate);
        REQUIRE((map == STOKES_MAP_SINGLE || map == STOKES_MAP_MULTIPLE));
        const Flux16& flux = w.stored[std::size_t(map)][first_slot[map] + i];
        REQUIRE(sum_of(flux) == Approx(16.0 * 1.5).epsilon(1e-4));
        for (std::size_t k = 0; k < 16; ++k) {
            REQUIRE(flux.v[k] <= 16.0f * 1.5f * 1.0001f);
            weights[k].add(double(flux.v[k]) / 1.5);
        }
    }
    for (const Sample& weight : weights) {
        CAPTURE(weight.mean(), weight.standard_error());
        CHECK(std::abs(weight.z(1.0)) < 4.0);
        CHECK(weight.standard_error() < 0.03);
    }
}

// The deep begins at 20 mean free paths, and in the other run nowhere. What leaves at each wavelength by distance from
// the entry, in octaves: 64 comparisons at 4.5 standard errors, wrong once in 2000.
TEST_CASE("light leaves where it does without short cuts through the deep", "[walk_photons]") {
    Entering e(160000, {pale}, true);
    e.list.erase(
        std::remove_if(e.list.begin(), e.list.end(), [&](std::uint32_t path) { return e.points[path].body == 0; }),
        e.list.end());
    const auto leaving = [&](const std::vector<std::string>& compiler) {
        Options options;
        options.compiler = compiler;
        const Walked w = walk(e, options);
        std::array<std::array<Sample, 4>, 16> by_distance;
        for (std::size_t i = 0; i < e.list.size(); ++i) {
            const SurfacePoint& p = e.points[e.list[i]];
            const int map = map_of(w, i);
            double place = -1.0;
            Flux16 flux = constant_flux(0.0f);
            if (map >= 0) {
                const glm::dvec3 at = place_of(w.heads[std::size_t(map)][first_slot[map] + i]);
                place = std::log2(std::max(glm::length(at - glm::dvec3(p.x, p.y, p.z)) / 10.0, 1.0));
                flux = w.stored[std::size_t(map)][first_slot[map] + i];
            }
            for (std::size_t k = 0; k < 16; ++k)
                for (std::size_t bin = 0; bin < 4; ++bin)
                    by_distance[k][bin].add(std::min(int(place), 3) == int(bin) && place >= 0.0 ? double(flux.v[k])
                                                                                                : 0.0);
        }
        return by_distance;
    };
    const auto short_cut = leaving({}), on_foot = leaving({"-DDEEP=1e30f"});
    bool same = true;
    for (std::size_t k = 0; k < 16; ++k)
        for (std::size_t bin = 0; bin < 4; ++bin) {
            const Sample &a = short_cut[k][bin], &b = on_foot[k][bin];
            CAPTURE(k, bin, a.mean(), b.mean(), a.standard_error());
            CHECK(std::abs(a.mean() - b.mean()) <= 4.5 * std::hypot(a.standard_error(), b.standard_error()));
            if (k == 15 && bin < 3) CHECK(a.standard_error() < 0.06 * a.mean());
            same = same && a.mean() == b.mean();
        }
    CHECK_FALSE(same);
}

TEST_CASE("walks beyond the limit of flights are cut and counted", "[walk_photons][tiny]") {
    const Entering e(40, all_kinds);
    Options options;
    options.compiler = {"-DWALK_STEPS=2u"};
    const Walked w = walk(e, options);
    CHECK(worst_imbalance(w.ledgers, w.flux) < 2e-5);
    int cut = 0;
    for (std::size_t i = 0; i < e.list.size(); ++i) {
        const PathLedger& ledger = w.ledgers[e.list[i]];
        if (ledger.fate != STOKES_FATE_EVENT_LIMIT) continue;
        ++cut;
        CHECK(ledger.dropped.energy > 0.0f);
        CHECK(map_of(w, i) == -1);
        CHECK(w.rays[e.list[i]].t_max < w.rays[e.list[i]].t_min);
    }
    CHECK(cut > 3);
}

TEST_CASE("in the last round what leaves is stored and the path is cut", "[walk_photons][tiny]") {
    const Entering e(40, all_kinds);
    Options options;
    options.last = 1;
    const Walked w = walk(e, options), going_on = walk(e);
    CHECK(worst_imbalance(w.ledgers, w.flux) < 2e-5);
    for (std::size_t m = 0; m < 3; ++m)
        CHECK(std::memcmp(w.heads[m].data(), going_on.heads[m].data(), w.heads[m].size() * sizeof(PhotonHead)) == 0);
    for (const std::uint32_t path : e.list) {
        CHECK(w.ledgers[path].fate != STOKES_FATE_ALIVE);
        if (going_on.ledgers[path].fate == STOKES_FATE_ALIVE) CHECK(w.ledgers[path].fate == STOKES_FATE_EVENT_LIMIT);
    }
}

TEST_CASE("a walk that finds no slot stores nothing and goes on", "[walk_photons][tiny]") {
    const Entering e(40, all_kinds);
    Options options;
    options.slot_limit = 20;
    const Walked w = walk(e, options), enough = walk(e);
    CHECK(worst_imbalance(w.ledgers, w.flux) < 2e-5);
    int full = 0;
    for (std::size_t i = 0; i < e.list.size(); ++i) {
        const int map = map_of(enough, i);
        const std::uint32_t path = e.list[i];
        CHECK(w.ledgers[path].fate == enough.ledgers[path].fate);
        CHECK(same_bits(w.flux[path], enough.flux[path]));
        if (map < 0 || first_slot[map] + i < 20) continue;
        ++full;
        CHECK(enough.ledgers[path].stored.energy > 0.0f);
        CHECK(w.ledgers[path].stored.energy == 0.0f);
    }
    CHECK(full > 3);
    for (std::size_t m = 0; m < 3; ++m)
        for (std::size_t slot = 20; slot < w.heads[m].size(); ++slot) CHECK(w.heads[m][slot].normal == 77);
}

// The sheet taken for a closed mesh: whatever goes down finds no surface.
TEST_CASE("light that loses its mesh is a missed exit", "[walk_photons][tiny]") {
    const Entering e(40, {plain, lossless});
    Options options;
    options.bodies = {0, 0};
    const Walked w = walk(e, options);
    CHECK(worst_imbalance(w.ledgers, w.flux) < 2e-5);
    for (std::size_t i = 0; i < e.list.size(); ++i) {
        const PathLedger& ledger = w.ledgers[e.list[i]];
        if (e.points[e.list[i]].body == 0) {
            CHECK(ledger.missed_exits == 0);
            continue;
        }
        CHECK(ledger.fate == STOKES_FATE_MISSED_EXIT);
        CHECK(ledger.missed_exits == 1);
        CHECK(ledger.dropped.energy > 0.0f);
        CHECK(map_of(w, i) == -1);
    }
}

TEST_CASE("a photon without light ends", "[walk_photons][tiny]") {
    Entering e(10, all_kinds);
    for (Flux16& flux : e.flux) flux = constant_flux(0.0f);
    for (PathLedger& ledger : e.ledgers) ledger.emitted = {0.0f, 0.0f};
    const Walked w = walk(e);
    for (std::size_t i = 0; i < e.list.size(); ++i) {
        CHECK(w.ledgers[e.list[i]].fate == STOKES_FATE_ABSORBED);
        CHECK(map_of(w, i) == -1);
    }
}
