#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "kernels/shared/material.h"
#include "tests/support/catch.hpp"
#include "tests/support/normals.hpp"
#include "tests/support/photon_fixture.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

constexpr std::uint32_t seed = 77;

MaterialRecord translucent(float c, bool subsurface, bool fluorescent) {
    MaterialRecord record =
        translucent_record((subsurface ? STOKES_MATERIAL_SUBSURFACE | STOKES_MATERIAL_BRANCHES : 0u) |
                               (fluorescent ? STOKES_MATERIAL_FLUORESCENT : 0u),
                           c, 1.5f);
    record.excitation_row = 8;
    record.reradiation_row = 9;
    return record;
}

MaterialRecord of_kind(std::uint32_t kind) {
    MaterialRecord record = translucent(1.0f, true, true);
    record.kind = kind;
    return record;
}

// The pass's spectra as far as they are read: row 8 is the fluorophore's excitation.
std::vector<Flux16> spectra() {
    std::vector<Flux16> rows(9, constant_flux(0.0f));
    rows[8] = constant_flux(0.5f);
    return rows;
}

// Black, diffuse, translucent of every sort, and of a kind that nobody knows.
std::vector<MaterialRecord> materials() {
    return {of_kind(STOKES_BLACK),          of_kind(STOKES_DIFFUSE),        translucent(0.0f, true, true),
            translucent(0.3f, true, true),  translucent(1.0f, true, true),  translucent(0.3f, false, true),
            translucent(1.0f, false, true), translucent(0.3f, true, false), of_kind(77)};
}

// What arrives, and what it may arrive at.
struct Arrivals {
    std::vector<Triangle> triangles;
    std::vector<ShapeRecord> shapes;
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    std::vector<Flux16> flux;
    std::vector<PathLedger> ledgers;
    std::vector<std::uint32_t> list;
};

// Shapes stand in another order than their materials. An eighth of the paths miss, some have ended before,
// some carry no number; the list is a shuffled two thirds of the paths.
Arrivals random_arrivals(std::uint32_t paths, unsigned generator_seed) {
    std::mt19937 generator(generator_seed);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    Arrivals a;
    const auto material_count = std::uint32_t(materials().size());
    for (std::uint32_t s = 0; s < 2 * material_count; ++s)
        a.shapes.push_back({(s * 5 + 3) % material_count, STOKES_NONE});
    for (std::uint32_t t = 0; t < 50; ++t) {
        const auto corner = [&] { return glm::vec3(random_direction(generator)) * 5.0f; };
        const std::uint32_t shape = t % std::uint32_t(a.shapes.size());
        a.triangles.push_back(make_triangle(corner(), corner(), corner(), shape, shape));
    }
    for (std::uint32_t i = 0; i < paths; ++i) {
        const glm::vec3 d(random_direction(generator));
        const float u = uniform(generator), v = (1.0f - u) * uniform(generator);
        const auto triangle = std::uint32_t(generator() % a.triangles.size());
        const glm::vec3 o = glm::vec3(point_on(a.triangles[triangle], u, v)) - d;  // at distance 1
        a.rays.push_back({o.x, o.y, o.z, 0, d.x, d.y, d.z, 1e30f});
        a.hits.push_back({1.0f, u, v, i % 8 == 5 ? STOKES_NONE : triangle});
        a.flux.push_back(random_flux(generator, 0.1, 2.0));
        a.ledgers.push_back(open_ledger(a.flux.back()));
        if (i % 31 == 7) a.ledgers.back().fate = STOKES_FATE_ESCAPED;
        if (i % 41 == 9) a.flux.back().v[i % 16] = std::numeric_limits<float>::quiet_NaN();
        if (i % 43 == 9) a.flux.back().v[i % 16] = std::numeric_limits<float>::infinity();
        if (i % 3 != 1) a.list.push_back(i);
    }
    std::shuffle(a.list.begin(), a.list.end(), generator);
    return a;
}

// The event that a path is listed for; the transport of the pass is `paper`.
std::uint8_t event_of(std::uint8_t list) {
    if (list == STOKES_LIST_DIFFUSE) return STOKES_EVENT_DIFFUSE;
    if (list == STOKES_LIST_NONE) return STOKES_EVENT_SPECULAR;
    if (list == STOKES_LIST_ENDED) return STOKES_EVENT_NONE;
    for (const std::uint8_t event : {STOKES_EVENT_FLUORESCENCE, STOKES_EVENT_ELASTIC, STOKES_EVENT_BRANCHES})
        if (list == STOKES_LIST_BELOW(STOKES_TRANSPORT_PAPER, event)) return event;
    FAIL("a list of another transport: " << int(list));
    return STOKES_EVENT_NONE;
}

struct Classified {
    std::vector<std::uint8_t> kinds;
    std::vector<SurfacePoint> points;
    std::vector<PathLedger> ledgers;
};

Classified classify(const Arrivals& a, std::uint32_t event = 0, std::uint32_t branches = 0) {
    const Buffer<SurfacePoint> points(test_device(), "points", a.rays.size());
    const Buffer<PathLedger> ledgers = on_device(a.ledgers);
    const Buffer<std::uint8_t> kinds(test_device(), "kinds", a.list.size());
    EventRound round{};
    round.count = std::uint32_t(a.list.size());
    round.event = event;
    round.branches = branches;
    Program(test_device(), "classify_photons.cl")
        .kernel("classify_photons")
        .launch(a.list.size(), Arguments()
                                   .add("round", round)
                                   .add("pass", pass_on_device(seed))
                                   .add("list", on_device(a.list))
                                   .add("rays", on_device(a.rays))
                                   .add("departures", open_departures(a.rays.size()))
                                   .add("bodies", on_device(std::vector<BodyRecord>(1)))
                                   .add("hits", on_device(a.hits))
                                   .add("flux", on_device(a.flux))
                                   .add("triangles", on_device(a.triangles))
                                   .add("materials", on_device(materials()))
                                   .add("shapes", on_device(a.shapes))
                                   .add("spectra", on_device(spectra()))
                                   .add("points", points)
                                   .add("ledgers", ledgers)
                                   .add("entry_lists", kinds)
                                   .add("met_bodies", on_device(std::vector<std::uint32_t>(16, 0u))));
    std::vector<std::uint8_t> events = kinds.download();
    std::transform(events.begin(), events.end(), events.begin(), event_of);
    return {events, points.download(), ledgers.download()};
}

// The number in [0, 1) that decides about each path at event 0.
std::vector<float> branch_draws(std::uint32_t paths) {
    const Buffer<float> out(test_device(), "uniforms", std::size_t{4} * paths);
    test_program("rng.cl")
        .kernel("uniforms")
        .launch(paths, Arguments()
                           .add("seed", seed)
                           .add("pass", 2u)
                           .add("dimension", 2u)
                           .add("out", out)
                           .add("n", paths));  // pass 2, RNG_BRANCH
    std::vector<float> draws;
    const std::vector<float> all = out.download();
    for (std::uint32_t i = 0; i < paths; ++i) draws.push_back(all[std::size_t{4} * i]);
    return draws;
}

// By material: the event where the draw is below c, where it is not, and where both branches are asked for. Black
// absorbs, and so does what nobody knows; a fluorophore that has no re-radiation absorbs, as does a translucent surface
// without a medium what its fluorophore leaves; both branches are there where light may go either way below the
// surface.
struct Events {
    std::uint32_t below, above;
    bool both = false;
};
constexpr Events events_of_material[] = {{STOKES_EVENT_NONE, STOKES_EVENT_NONE},
                                         {STOKES_EVENT_DIFFUSE, STOKES_EVENT_DIFFUSE},
                                         {STOKES_EVENT_FLUORESCENCE, STOKES_EVENT_ELASTIC},
                                         {STOKES_EVENT_FLUORESCENCE, STOKES_EVENT_ELASTIC, true},
                                         {STOKES_EVENT_FLUORESCENCE, STOKES_EVENT_ELASTIC, true},
                                         {STOKES_EVENT_FLUORESCENCE, STOKES_EVENT_NONE},
                                         {STOKES_EVENT_FLUORESCENCE, STOKES_EVENT_NONE},
                                         {STOKES_EVENT_NONE, STOKES_EVENT_ELASTIC},
                                         {STOKES_EVENT_NONE, STOKES_EVENT_NONE}};

std::uint32_t expected_event(std::uint32_t material, float draw, bool branches) {
    const Events& events = events_of_material[material];
    if (branches && events.both) return STOKES_EVENT_BRANCHES;
    return draw < materials()[material].fluorescent_fraction ? events.below : events.above;
}

void check_arrival(const Arrivals& a, const Classified& result, std::size_t entry, const std::vector<float>& draws,
                   bool branches = false) {
    const std::uint32_t path = a.list[entry];
    const PathLedger &before = a.ledgers[path], &after = result.ledgers[path];
    CAPTURE(entry, path);
    if (before.fate != STOKES_FATE_ALIVE) {
        CHECK(result.kinds[entry] == STOKES_EVENT_NONE);
        CHECK(std::memcmp(&before, &after, sizeof before) == 0);
        return;
    }
    const double total = sum_of(a.flux[path]);
    if (!std::isfinite(total)) {
        CHECK(result.kinds[entry] == STOKES_EVENT_NONE);
        CHECK(after.fate == STOKES_FATE_OVERFLOW);
        return;
    }
    CHECK(std::abs(imbalance_of(after, a.flux[path])) < 1e-5);
    const Hit& hit = a.hits[path];
    if (hit.triangle == STOKES_NONE) {
        CHECK(result.kinds[entry] == STOKES_EVENT_NONE);
        CHECK(after.fate == STOKES_FATE_ESCAPED);
        CHECK(static_cast<double>(after.escaped.energy) == Approx(total).epsilon(1e-6));
        return;
    }
    const Triangle& t = a.triangles[hit.triangle];
    const std::uint32_t material = a.shapes[t.shape].material;
    const SurfacePoint& p = result.points[path];
    CHECK(p.material == material);
    CHECK(p.body == t.body);
    CHECK(glm::length(glm::dvec3(p.x, p.y, p.z) - point_on(t, hit.u, hit.v)) < 1e-5);
    CHECK(glm::length(glm::dvec3(p.nx, p.ny, p.nz) - normal_of(t)) < 1e-5);
    const double facing = glm::dot(direction_of(a.rays[path]), normal_of(t));
    if (std::abs(facing) < 1e-5) return;
    const std::uint32_t event = facing < 0.0 ? expected_event(material, draws[path], branches) : STOKES_EVENT_NONE;
    CHECK(result.kinds[entry] == event);
    const bool behind = facing > 0.0 && materials()[material].kind == STOKES_TRANSLUCENT;
    const std::uint32_t end = behind ? STOKES_FATE_BEHIND : STOKES_FATE_ABSORBED;
    CHECK(after.fate == (event == STOKES_EVENT_NONE ? end : STOKES_FATE_ALIVE));
    CHECK(static_cast<double>(after.absorbed.energy) == Approx(event == STOKES_EVENT_NONE ? total : 0.0).epsilon(1e-6));
}

// Of 2^18 paths that meet this material from the front.
std::vector<std::uint8_t> events_at(std::uint32_t material, std::uint32_t event) {
    constexpr std::uint32_t paths = 1u << 18;
    Arrivals a;
    a.triangles = {make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})};
    a.shapes = {{material, STOKES_NONE}};
    a.rays.assign(paths, {0.2f, 0.2f, 1, 0, 0, 0, -1, 1e30f});
    a.hits.assign(paths, {1.0f, 0.2f, 0.2f, 0});
    a.flux.assign(paths, constant_flux(1.0f));
    a.ledgers.assign(paths, open_ledger(a.flux[0]));
    a.list.resize(paths);
    std::iota(a.list.begin(), a.list.end(), 0u);
    return classify(a, event).kinds;
}

struct Lists {
    ListCounts totals;
    std::vector<std::uint32_t> alive, lists;
};

constexpr std::uint32_t untouched = 0xabababab;

Lists make_lists(const std::vector<std::uint32_t>& list, const std::vector<std::uint8_t>& entry_lists,
                 std::uint32_t chunk_size) {
    const auto count = std::uint32_t(list.size());
    const std::uint32_t chunks = (count + chunk_size - 1) / chunk_size;
    const Buffer<ListCounts> counts(test_device(), "counts", chunks), totals(test_device(), "totals", 1);
    const std::vector<std::uint32_t> blank(count + 3, untouched);
    const Buffer<std::uint32_t> paths = on_device(list), alive = on_device(blank), lists = on_device(blank);
    const Buffer<std::uint8_t> of = on_device(entry_lists);
    const Arguments all = Arguments("count", count)
                              .add("chunk_size", chunk_size)
                              .add("chunks", chunks)
                              .add("list", paths)
                              .add("entry_lists", of)
                              .add("chunk_counts", counts)
                              .add("totals", totals)
                              .add("next_alive", alive)
                              .add("event_lists", lists);
    const Program program(test_device(), "classify_photons.cl");
    program.kernel("count_lists").launch(chunks, all);
    program.kernel("scan_lists").launch(1, all);
    program.kernel("write_lists").launch(chunks, all);
    return {totals.download().front(), alive.download(), lists.download()};
}

// The paths of each list, in the order of list, one list behind the other, then nothing but what stood there.
void check_lists(const std::vector<std::uint32_t>& list, const std::vector<std::uint8_t>& entry_lists,
                 std::uint32_t chunk_size) {
    CAPTURE(list.size(), chunk_size);
    const Lists made = make_lists(list, entry_lists, chunk_size);
    std::vector<std::uint32_t> alive, lists;
    for (std::size_t i = 0; i < list.size(); ++i)
        if (entry_lists[i] != STOKES_LIST_ENDED) alive.push_back(list[i]);
    CHECK(made.totals.alive == alive.size());
    for (std::uint32_t l = 0; l < STOKES_LIST_COUNT; ++l) {
        CHECK(made.totals.first[l] == lists.size());
        for (std::size_t i = 0; i < list.size(); ++i)
            if (entry_lists[i] == l) lists.push_back(list[i]);
        CHECK(made.totals.first[l] + made.totals.count[l] == lists.size());
    }
    alive.resize(made.alive.size(), untouched);
    lists.resize(made.lists.size(), untouched);
    CHECK(made.alive == alive);
    CHECK(made.lists == lists);
}

// Any list, none, or that of paths that have ended.
std::uint8_t any_list(std::mt19937& generator) {
    const auto n = static_cast<std::uint8_t>(generator() % (STOKES_LIST_COUNT + 2));
    return n < STOKES_LIST_COUNT ? n : std::uint8_t(n == STOKES_LIST_COUNT ? STOKES_LIST_NONE : STOKES_LIST_ENDED);
}

}  // namespace

TEST_CASE("photons are classified as the rules say, path by path", "[classify_photons][tiny]") {
    const Arrivals a = random_arrivals(300, 1);
    const Classified result = classify(a);
    const std::vector<float> draws = branch_draws(300);
    for (std::size_t entry = 0; entry < a.list.size(); ++entry) check_arrival(a, result, entry, draws);
    for (std::size_t path = 0; path < a.ledgers.size(); ++path)  // paths that are not in the list
        if (std::count(a.list.begin(), a.list.end(), path) == 0)
            CHECK(std::memcmp(&a.ledgers[path], &result.ledgers[path], sizeof(PathLedger)) == 0);
}

// Both branches are there where some light can be taken up below a surface; elsewhere the rules are the same.
TEST_CASE("light below a fluorescent surface goes both ways where that is asked for", "[classify_photons][tiny]") {
    const Arrivals a = random_arrivals(300, 5);
    const Classified result = classify(a, 0, 1);
    const std::vector<float> draws = branch_draws(300);
    for (std::size_t entry = 0; entry < a.list.size(); ++entry) check_arrival(a, result, entry, draws, true);
    CHECK(std::count(result.kinds.begin(), result.kinds.end(), STOKES_EVENT_BRANCHES) > 10);

    Arrivals dark = random_arrivals(300, 6);  // at wavelengths that excite nothing
    for (Flux16& flux : dark.flux)
        if (std::isfinite(sum_of(flux))) flux = constant_flux(0.0f);
    for (const std::uint8_t kind : classify(dark, 0, 1).kinds) CHECK(kind != STOKES_EVENT_BRANCHES);
}

TEST_CASE("many photons are classified as the rules say", "[classify_photons]") {
    const Arrivals a = random_arrivals(20001, 2);
    const Classified result = classify(a);
    const std::vector<float> draws = branch_draws(20001);
    std::vector<int> kinds(STOKES_EVENT_BRANCHES + 1, 0), fates(STOKES_FATE_COUNT, 0);
    for (std::size_t entry = 0; entry < a.list.size(); ++entry) {
        check_arrival(a, result, entry, draws);
        ++kinds[result.kinds[entry]];
        ++fates[result.ledgers[a.list[entry]].fate];
    }
    for (const std::uint32_t kind :
         {STOKES_EVENT_NONE, STOKES_EVENT_DIFFUSE, STOKES_EVENT_FLUORESCENCE, STOKES_EVENT_ELASTIC})
        CHECK(kinds[kind] > 100);
    for (const int fate : {STOKES_FATE_ALIVE, STOKES_FATE_ABSORBED, STOKES_FATE_ESCAPED, STOKES_FATE_OVERFLOW})
        CHECK(fates[std::size_t(fate)] > 100);
}

// Three binomial counts that are not certain, each at 3.9 standard deviations: together wrong once in 3000.
// Paths must not draw the same at different events: both of two events are fluorescent with probability c^2.
TEST_CASE("a path meets a fluorophore with probability c, anew at every event", "[classify_photons]") {
    const double n = 1u << 18;
    const auto check = [&](double count, double p) {
        CHECK(std::abs(count - p * n) <= 3.9 * std::sqrt(p * (1.0 - p) * n));
    };
    for (const auto& [material, c, other] :
         {std::tuple{2u, 0.0, STOKES_EVENT_ELASTIC}, std::tuple{3u, 0.3, STOKES_EVENT_ELASTIC},
          std::tuple{4u, 1.0, STOKES_EVENT_ELASTIC}, std::tuple{5u, 0.3, STOKES_EVENT_NONE}}) {
        const std::vector<std::uint8_t> kinds = events_at(material, 5);
        const auto count = std::count(kinds.begin(), kinds.end(), STOKES_EVENT_FLUORESCENCE);
        check(double(count), c);
        CHECK(count + std::count(kinds.begin(), kinds.end(), other) == std::ptrdiff_t(n));
    }
    const std::vector<std::uint8_t> first = events_at(3, 0), second = events_at(3, 1);
    double both = 0.0;
    for (std::size_t i = 0; i < first.size(); ++i)
        both += first[i] == STOKES_EVENT_FLUORESCENCE && second[i] == STOKES_EVENT_FLUORESCENCE;
    check(both, 0.09);
}

TEST_CASE("the lists hold the paths of their kind in list order", "[classify_photons][tiny]") {
    std::mt19937 generator(3);
    for (const std::uint32_t count : {1u, 15u, 16u, 17u, 32u, 200u}) {
        std::vector<std::uint32_t> list(count);
        std::vector<std::uint8_t> kinds(count);
        std::iota(list.begin(), list.end(), 1000u);
        std::shuffle(list.begin(), list.end(), generator);
        for (std::uint8_t& kind : kinds) kind = any_list(generator);
        check_lists(list, kinds, 16);
        for (const int only : {0, 1, 4, 9, int(STOKES_LIST_NONE), int(STOKES_LIST_ENDED)})
            check_lists(list, std::vector<std::uint8_t>(count, std::uint8_t(only)), 16);
    }
}

TEST_CASE("long lists are the same for every chunk size", "[classify_photons]") {
    std::mt19937 generator(4);
    std::vector<std::uint32_t> list(50001);
    std::vector<std::uint8_t> kinds(list.size());
    std::iota(list.begin(), list.end(), 0u);
    for (std::uint8_t& kind : kinds) kind = any_list(generator);
    for (const std::uint32_t chunk_size : {1u, 512u, 50000u, 60000u}) check_lists(list, kinds, chunk_size);
}
