#include <cfloat>
#include <cmath>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/subsurface_fixture.hpp"

using namespace stokes;

namespace {

constexpr float offset_mm = 0.01f;
constexpr std::uint32_t empty = 0xabababab, before = 3, after = 4;  // entries about those that are written

EventRound round_of(std::uint32_t component, std::size_t count) {
    EventRound round{};
    round.count = std::uint32_t(count);
    round.event = 2;
    round.component = component;
    round.first_exit = before;
    return round;
}

struct Exits {
    std::vector<ExitPoint> exits;
    std::vector<Probe> probes;
};

// One component's exits for the paths of a list; whatever surrounds them stays blank.
Exits sample(const SubsurfaceArrivals& a, const std::vector<std::uint32_t>& list, std::uint32_t component) {
    const MadeUpTables tables;
    ExitPoint blank_exit{};
    blank_exit.path = empty;
    Probe blank_probe{};
    blank_probe.body = empty;
    const std::size_t room = before + list.size() + after;
    const Buffer<ExitPoint> exits = on_device(std::vector<ExitPoint>(room, blank_exit));
    const Buffer<Probe> probes = on_device(std::vector<Probe>(room, blank_probe));
    Program(test_device(), "deposit_subsurface.cl")
        .kernel("sample_exits")
        .launch(list.size(), round_of(component, list.size()), pass_on_device(9, 0, offset_mm),
                on_device(list), on_device(a.points), on_device(a.rays), on_device(translucent_materials()),
                on_device(tables.shapes), on_device(tables.mean_rows), on_device(tables.cumulative_rows),
                exits, probes);
    return {exits.download(), probes.download()};
}

// Snell's law in double precision [deg].
double refraction_deg(double cos_in, double eta) {
    return std::asin(std::min(std::sqrt(std::max(0.0, 1.0 - cos_in * cos_in)) / eta, 1.0)) * 180.0 / M_PI;
}

// An exit and its probe against the rules. Single precision: positions to 1e-5 mm at 25 mm, angles to 0.02
// degrees (the arcsine at grazing incidence and the sine near normal incidence both magnify rounding).
void check_exit(const SubsurfaceArrivals& a, const Exits& e, std::size_t i, std::uint32_t path,
                std::uint32_t component) {
    const SurfacePoint& p = a.points[path];
    const MaterialRecord material = translucent_materials()[p.material];
    const ExitPoint& exit_point = e.exits[before + i];
    const Probe& probe = e.probes[before + i];
    CAPTURE(path, component);
    CHECK(exit_point.path == path);
    CHECK(exit_point.material == p.material);
    CHECK((exit_point.x == p.x && exit_point.y == p.y && exit_point.z == p.z));
    CHECK((exit_point.nx == p.nx && exit_point.ny == p.ny && exit_point.nz == p.nz));
    if (material.medium == STOKES_NONE) {
        CHECK(exit_point.r_mm == 0.0f);
        CHECK(probe.body == STOKES_NONE);
        CHECK(probe.reach_mm < 0.0f);
        return;
    }
    const glm::dvec3 n(p.nx, p.ny, p.nz),
        offset = glm::dvec3(probe.x, probe.y, probe.z) - glm::dvec3(p.x, p.y, p.z);
    static const MadeUpTables tables;
    const TableShape shape = tables.shapes[material.medium * 3 + component];
    const double r = exit_point.r_mm, last = shape.r_first + shape.r_step * double(shape.r_count - 1);
    CHECK(r >= double(shape.r_first));
    CHECK(r <= last * (1.0 + 1e-6));
    CHECK(glm::length(offset) == Approx(r).margin(1e-5));
    CHECK(glm::dot(offset, n) == Approx(0.0).margin(1e-5));
    const double cos_in = -glm::dot(direction_of(a.rays[path]), n);
    CHECK(double(exit_point.row) == Approx(refraction_deg(cos_in, double(material.eta))).margin(0.02));
    CHECK(probe.body == p.body);
    CHECK((probe.nx == p.nx && probe.ny == p.ny && probe.nz == p.nz));
    CHECK(double(probe.reach_mm) == Approx(r + 8.0 * double(offset_mm)).epsilon(1e-6));
}

void check_exits(std::uint32_t paths) {
    const SubsurfaceArrivals a(paths);
    for (const std::uint32_t component : {STOKES_MAP_FLUORESCENCE, STOKES_MAP_SINGLE, STOKES_MAP_MULTIPLE}) {
        const auto& list = component == STOKES_MAP_FLUORESCENCE ? a.fluorescence : a.elastic;
        const Exits e = sample(a, list, component);
        for (std::size_t i = 0; i < list.size(); ++i) check_exit(a, e, i, list[i], component);
        for (std::size_t i = 0; i < e.exits.size(); ++i)
            if (i < before || i >= before + list.size())
                CHECK((e.exits[i].path == empty && e.probes[i].body == empty));
    }
}

// Exits on a plane, each at a given r and refraction angle; every fifth was not found. Their normals differ.
std::vector<ExitPoint> given_exits(const SubsurfaceArrivals& a, const std::vector<std::uint32_t>& list,
                                   std::uint32_t component) {
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    std::vector<ExitPoint> exits(before + list.size() + after);
    for (std::size_t i = 0; i < list.size(); ++i) {
        const SurfacePoint& p = a.points[list[i]];
        const bool subsurface = p.material != 2;
        const float r = subsurface ? 10.0f * float(component) + 2.5f * uniform(generator) : 0.0f;
        exits[before + i] = {p.x + 1, p.y,        p.z,  subsurface && i % 5 == 4 ? -std::max(r, FLT_MIN) : r,
                             p.nx,    p.ny,       p.nz, subsurface ? 90.0f * uniform(generator) : 0.0f,
                             list[i], p.material, 0,    0};
    }
    return exits;
}

struct Deposits {
    std::vector<ExitPoint> exits;
    std::vector<PathLedger> ledgers;
    std::vector<PhotonHead> heads;
    std::vector<Flux16> flux;
};

constexpr std::uint32_t first_slot = 6;

Deposits deposit(const SubsurfaceArrivals& a, const std::vector<ExitPoint>& given, std::size_t count,
                 std::uint32_t component, std::uint32_t slot_limit, std::size_t slots) {
    const MadeUpTables tables;
    EventRound round = round_of(component, count);
    round.first_slot = first_slot;
    round.slot_limit = slot_limit;
    const Buffer<ExitPoint> exits = on_device(given);
    const Buffer<PathLedger> ledgers = on_device(a.ledgers);
    const Buffer<PhotonHead> heads = on_device(std::vector<PhotonHead>(slots, PhotonHead{0, 0, 0, empty}));
    const Buffer<Flux16> map_flux = on_device(std::vector<Flux16>(slots, constant_flux(-1.0f)));
    Program(test_device(), "deposit_subsurface.cl")
        .kernel("deposit_exits")
        .launch(count, round, pass_on_device(9), on_device(translucent_materials()),
                on_device(translucent_spectra()), on_device(tables.shapes), on_device(tables.at_wavelengths), exits, on_device(a.flux), ledgers,
                heads, map_flux);
    return {exits.download(), ledgers.download(), heads.download(), map_flux.download()};
}

// What leaves at an exit by eq. 1-5 in double precision.
struct Leaving {
    std::array<double, 16> flux{};
    double kept = 0.0, converted = 0.0;
};

Leaving leaving_twin(const ExitPoint& exit_point, const Flux16& incident, std::uint32_t component,
                     std::uint32_t conversions) {
    static const MadeUpTables tables;
    static const std::vector<Flux16> spectra = translucent_spectra();
    const MaterialRecord material = translucent_materials()[exit_point.material];
    Leaving result;
    if (component == STOKES_MAP_FLUORESCENCE) {
        result.flux = reradiated(material, spectra, incident);
        // The inverse probability of the next of 481 wavelengths, given those the light has been at, in place of that
        // of the second, which stands in the rows.
        const double next = conversions + 1.0;
        const double weight = next < 16.0 ? (481.0 - next) / (16.0 - next) * 15.0 / 480.0 : 0.0;
        for (double& f : result.flux) f *= weight;
    } else {
        for (std::size_t k = 0; k < 16; ++k) result.flux[k] = double(incident.v[k]);
    }
    for (const double f : result.flux) result.converted += f;
    if (material.medium != STOKES_NONE) {
        const auto power = tables.look_up(material.medium, component, std::abs(double(exit_point.r_mm)),
                                          double(exit_point.row));
        for (std::size_t k = 0; k < 16; ++k) result.flux[k] *= power[k];
    }
    for (const double f : result.flux) result.kept += f;
    return result;
}

// The deposits of one component against their twin; tolerance: some tens of roundings of 2^-24.
void check_deposits(const SubsurfaceArrivals& a, std::uint32_t component) {
    const auto& list = component == STOKES_MAP_FLUORESCENCE ? a.fluorescence : a.elastic;
    const std::vector<ExitPoint> given = given_exits(a, list, component);
    const std::size_t end = first_slot + list.size();
    const Deposits d = deposit(a, given, list.size(), component, std::uint32_t(end), end + 10);
    for (std::size_t i = 0; i < list.size(); ++i) {
        const ExitPoint& exit_point = d.exits[before + i];
        const PathLedger& ledger = d.ledgers[list[i]];
        const PhotonHead& head = d.heads[first_slot + i];
        const Leaving expected = leaving_twin(exit_point, a.flux[list[i]], component, a.ledgers[list[i]].conversions);
        CAPTURE(component, i, exit_point.r_mm, exit_point.row);
        for (std::size_t k = 0; k < 16; ++k)
            CHECK(double(d.flux[first_slot + i].v[k]) == Approx(expected.flux[k]).epsilon(5e-6));
        CHECK(double(exit_point.kept) == Approx(expected.kept).epsilon(5e-6));
        if (component == STOKES_MAP_FLUORESCENCE)
            CHECK(double(exit_point.converted) == Approx(expected.converted).epsilon(5e-6));
        CHECK((head.x == exit_point.x && head.y == exit_point.y && head.z == exit_point.z));
        if (given[before + i].r_mm < 0.0f) {
            CHECK(head.normal == STOKES_EMPTY_SLOT);
            CHECK(ledger.missed_exits == 1);
            CHECK(ledger.stored == 0.0f);
        } else if (expected.kept == 0.0) {
            CHECK(head.normal == STOKES_EMPTY_SLOT);
            CHECK(ledger.stored == 0.0f);
        } else {
            const std::uint32_t packed = pack_normal_twin({exit_point.nx, exit_point.ny, exit_point.nz});
            CHECK(std::abs(int(head.normal & 0xffff) - int(packed & 0xffff)) <= 1);
            CHECK(std::abs(int(head.normal >> 16) - int(packed >> 16)) <= 1);
            CHECK(ledger.missed_exits == 0);
            CHECK(double(ledger.stored) == Approx(expected.kept).epsilon(5e-6));
        }
    }
    for (std::size_t slot = 0; slot < d.heads.size(); ++slot)
        if (slot < first_slot || slot >= end)
            CHECK((d.heads[slot].normal == empty && d.flux[slot].v[0] == -1.0f));
}

constexpr std::uint32_t components[] = {STOKES_MAP_FLUORESCENCE, STOKES_MAP_SINGLE, STOKES_MAP_MULTIPLE};

}  // namespace

TEST_CASE("exits lie on the tangent plane at a distance of their table", "[deposit_subsurface][tiny]") {
    check_exits(150);
}

TEST_CASE("many exits lie on the tangent plane at a distance of their table", "[deposit_subsurface]") {
    check_exits(20001);
}

// Azimuth in 64 steps for each component, and single against multiple scattering in 8 x 8: one path's
// azimuths must not depend on one another. Four chi-square tests, together wrong once in 1000.
TEST_CASE("azimuths are uniform, and different for each component", "[deposit_subsurface]") {
    const SubsurfaceArrivals a(1u << 17);
    const double level = sidak_level(1e-3, 4);
    std::array<std::vector<double>, 3> azimuths;
    for (const std::uint32_t component : components) {
        const auto& list = component == STOKES_MAP_FLUORESCENCE ? a.fluorescence : a.elastic;
        const Exits e = sample(a, list, component);
        std::vector<double> counts(64, 0.0);
        for (std::size_t i = 0; i < list.size(); ++i) {
            const SurfacePoint& p = a.points[list[i]];
            const Probe& probe = e.probes[before + i];
            if (probe.body == STOKES_NONE) continue;
            const double turn = azimuth_about({p.nx, p.ny, p.nz},
                                              {double(probe.x) - double(p.x), double(probe.y) - double(p.y),
                                               double(probe.z) - double(p.z)});
            azimuths[component].push_back(turn);
            counts[std::min(std::size_t(turn * 64.0), std::size_t{63})] += 1.0;
        }
        CHECK(chi_square_uniform(counts) > level);
    }
    std::vector<double> pairs(64, 0.0);
    for (std::size_t i = 0; i < azimuths[1].size(); ++i) {
        const auto step = [](double turn) { return std::min(std::size_t(turn * 8.0), std::size_t{7}); };
        pairs[step(azimuths[1][i]) * 8 + step(azimuths[2][i])] += 1.0;
    }
    CHECK(chi_square_uniform(pairs) > level);
}

TEST_CASE("exits are put where their probe hit, others are marked and keep their distance",
          "[deposit_subsurface][tiny]") {
    const std::vector<Triangle> triangles = {make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                                             make_triangle({3, 1, 2}, {3, 4, 2}, {3, 1, 4})};
    std::vector<Probe> probes(80);
    std::vector<Hit> hits(80);
    std::vector<ExitPoint> given(80);
    for (std::uint32_t i = 0; i < 80; ++i) {
        probes[i].body = i % 4 == 3 ? STOKES_NONE : 1u;
        hits[i] = {0.1f, 0.25f, 0.5f, i % 4 == 2 ? STOKES_NONE : i % 2};
        given[i] = {9, 9, 9, i == 2 ? 0.0f : 0.5f * float(i), 0, 0, 1, 30, i, 1, 0, 0};
    }
    const Buffer<ExitPoint> buffer = on_device(given);
    Program(test_device(), "deposit_subsurface.cl")
        .kernel("place_exits")
        .launch(78, 78u, on_device(probes), on_device(hits), on_device(triangles), buffer);
    const std::vector<ExitPoint> placed = buffer.download();
    for (std::uint32_t i = 0; i < 80; ++i) {
        CAPTURE(i);
        const glm::dvec3 at(placed[i].x, placed[i].y, placed[i].z),
            n(placed[i].nx, placed[i].ny, placed[i].nz);
        CHECK((placed[i].path == i && placed[i].row == 30.0f));
        if (i >= 78 || i % 4 == 3) {  // beyond the count, or without a probe
            CHECK((at == glm::dvec3(9) && placed[i].r_mm == given[i].r_mm));
        } else if (i % 4 == 2) {
            CHECK(placed[i].r_mm < 0.0f);
            CHECK(placed[i].r_mm == Approx(-given[i].r_mm).margin(1e-30));
        } else {
            CHECK(glm::length(at - point_on(triangles[i % 2], 0.25, 0.5)) < 1e-6);
            CHECK(glm::length(n - normal_of(triangles[i % 2])) < 1e-6);
            CHECK(placed[i].r_mm == given[i].r_mm);
        }
    }
}

TEST_CASE("deposits are those of eq. 1-5", "[deposit_subsurface][tiny]") {
    const SubsurfaceArrivals a(90);
    for (const std::uint32_t component : components) check_deposits(a, component);
}

TEST_CASE("many deposits are those of eq. 1-5", "[deposit_subsurface]") {
    const SubsurfaceArrivals a(6001);
    for (const std::uint32_t component : components) check_deposits(a, component);
}

TEST_CASE("nothing is deposited beyond the last slot", "[deposit_subsurface][tiny]") {
    const SubsurfaceArrivals a(90);
    const std::vector<ExitPoint> given = given_exits(a, a.fluorescence, STOKES_MAP_FLUORESCENCE);
    const Deposits d =
        deposit(a, given, a.fluorescence.size(), STOKES_MAP_FLUORESCENCE, first_slot + 11, 100);
    for (std::size_t slot = 0; slot < 100; ++slot) {
        const bool used = slot >= first_slot && slot < first_slot + 11;
        CHECK((d.heads[slot].normal != empty) == used);
        CHECK((d.flux[slot].v[0] != -1.0f) == used);
    }
    for (std::size_t i = 11; i < a.fluorescence.size(); ++i)
        CHECK(d.ledgers[a.fluorescence[i]].stored == 0.0f);
}

// A fluorophore without any excitation in the pass: no photon, but a slot.
TEST_CASE("a deposit without flux leaves its slot empty", "[deposit_subsurface][tiny]") {
    SubsurfaceArrivals a(30);
    for (Flux16& flux : a.flux) flux = constant_flux(0.0f);
    for (std::size_t i = 0; i < a.flux.size(); ++i) a.flux[i].v[15] = 1.0f;  // nothing lies above the longest
    const std::vector<ExitPoint> given = given_exits(a, a.fluorescence, STOKES_MAP_FLUORESCENCE);
    const Deposits d = deposit(a, given, a.fluorescence.size(), STOKES_MAP_FLUORESCENCE, 100, 100);
    for (std::size_t i = 0; i < a.fluorescence.size(); ++i) {
        CHECK(d.heads[first_slot + i].normal == STOKES_EMPTY_SLOT);
        CHECK(d.exits[before + i].converted == 0.0f);
    }
}
