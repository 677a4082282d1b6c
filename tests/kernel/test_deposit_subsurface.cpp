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

// The rows of translucent_spectra(), then sigma_t [1/mm] and albedo of one medium.
std::vector<Flux16> conserving_spectra() {
    std::vector<Flux16> rows = translucent_spectra();
    Flux16 sigma_t, albedo;
    for (std::size_t k = 0; k < 16; ++k) {
        sigma_t.v[k] = 0.3f + 0.2f * static_cast<float>(k);
        albedo.v[k] = 0.99f - 0.05f * static_cast<float>(k);
    }
    rows.push_back(sigma_t);
    rows.push_back(albedo);
    return rows;
}

std::vector<MaterialRecord> conserving_materials(bool fresnel) {
    std::vector<MaterialRecord> materials = translucent_materials();
    const auto sigma_row = static_cast<std::uint32_t>(translucent_spectra().size());
    for (MaterialRecord& m : materials) {
        m.sigma_row = sigma_row;
        if (!fresnel || !has(m, STOKES_MATERIAL_SUBSURFACE) || m.eta == 1.0f) continue;
        m.flags |= STOKES_MATERIAL_FRESNEL;
        m.exit_scale = 1.1f;
    }
    return materials;
}

EventRound round_of(std::uint32_t component, std::size_t count) {
    EventRound round{};
    round.count = std::uint32_t(count);
    round.event = 2;
    round.component = component;
    round.first_exit = before;
    round.exits = 1;
    return round;
}

struct Exits {
    std::vector<ExitPoint> exits;
    std::vector<Probe> probes;
};

// One component's exits for the paths of a list; whatever surrounds them stays blank.
Exits sample(const SubsurfaceArrivals& a, const std::vector<std::uint32_t>& list, EventRound round,
             const std::vector<MaterialRecord>& materials = translucent_materials()) {
    const MadeUpTables tables;
    ExitPoint blank_exit{};
    blank_exit.path = empty;
    Probe blank_probe{};
    blank_probe.body = empty;
    const std::size_t room = before + list.size() * round.exits + after;
    const Buffer<ExitPoint> exits = on_device(std::vector<ExitPoint>(room, blank_exit));
    const Buffer<Probe> probes = on_device(std::vector<Probe>(room, blank_probe));
    Program(test_device(), "deposit_subsurface.cl")
        .kernel("sample_exits")
        .launch(list.size(), Arguments()
                                 .add("round", round)
                                 .add("pass", pass_on_device(9, 0, offset_mm))
                                 .add("event_lists", on_device(list))
                                 .add("points", on_device(a.points))
                                 .add("rays", on_device(a.rays))
                                 .add("materials", on_device(materials))
                                 .add("spectra", on_device(conserving_spectra()))
                                 .add("table_shapes", on_device(tables.shapes))
                                 .add("mean_rows", on_device(tables.mean_rows))
                                 .add("cumulative_rows", on_device(tables.cumulative_rows))
                                 .add("event_samples", on_device(std::vector<EventSample>(1)))
                                 .add("exits", exits)
                                 .add("probes", probes));
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
    if (!has(material, STOKES_MATERIAL_SUBSURFACE)) {
        CHECK((exit_point.r_mm == 0.0f && exit_point.found == 1u));
        CHECK(probe.body == STOKES_NONE);
        CHECK(probe.reach_mm < 0.0f);
        return;
    }
    const glm::dvec3 n(p.nx, p.ny, p.nz), offset = glm::dvec3(probe.x, probe.y, probe.z) - glm::dvec3(p.x, p.y, p.z);
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
    CHECK(double(probe.reach_mm) == Approx(r + 8.0 * double(offset_mm)).epsilon(1e-6).margin(1e-6));
}

void check_exits(std::uint32_t paths) {
    const SubsurfaceArrivals a(paths);
    for (const std::uint32_t component : {STOKES_MAP_FLUORESCENCE, STOKES_MAP_SINGLE, STOKES_MAP_MULTIPLE}) {
        const auto& list = component == STOKES_MAP_FLUORESCENCE ? a.fluorescence : a.elastic;
        const Exits e = sample(a, list, round_of(component, list.size()));
        for (std::size_t i = 0; i < list.size(); ++i) check_exit(a, e, i, list[i], component);
        for (std::size_t i = 0; i < e.exits.size(); ++i)
            if (i < before || i >= before + list.size()) CHECK((e.exits[i].path == empty && e.probes[i].body == empty));
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
        exits[before + i] = {p.x + 1,
                             p.y,
                             p.z,
                             r,
                             p.nx,
                             p.ny,
                             p.nz,
                             subsurface ? 90.0f * uniform(generator) : 0.0f,
                             list[i],
                             p.material,
                             0,
                             1,
                             {0, 0},
                             {0, 0},
                             subsurface && i % 5 == 4 ? 0u : 1u};
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
                 std::uint32_t component, std::uint32_t slot_limit, std::size_t slots,
                 std::uint32_t sampler = STOKES_SAMPLER_PAPER,
                 const std::vector<MaterialRecord>& materials = translucent_materials(), std::uint32_t branches = 0) {
    const MadeUpTables tables;
    EventRound round = round_of(component, count);
    round.branches = branches;
    round.sampler = sampler;
    round.first_slot = first_slot;
    round.slot_limit = slot_limit;
    const Buffer<ExitPoint> exits = on_device(given);
    const Buffer<PathLedger> ledgers = on_device(a.ledgers);
    const Buffer<PhotonHead> heads = on_device(std::vector<PhotonHead>(slots, PhotonHead{0, 0, 0, empty}));
    const Buffer<Flux16> map_flux = on_device(std::vector<Flux16>(slots, constant_flux(-1.0f)));
    const Buffer<Flux16> exit_flux(test_device(), "exit flux", given.size());
    Program(test_device(), "deposit_subsurface.cl")
        .kernel("deposit_exits")
        .launch(count, Arguments()
                           .add("round", round)
                           .add("pass", pass_on_device(9))
                           .add("points", on_device(a.points))
                           .add("materials", on_device(materials))
                           .add("spectra", on_device(conserving_spectra()))
                           .add("table_shapes", on_device(tables.shapes))
                           .add("table16", on_device(tables.at_wavelengths))
                           .add("exits", exits)
                           .add("flux", on_device(a.flux))
                           .add("ledgers", ledgers)
                           .add("exit_flux", exit_flux)
                           .add("map_heads", heads)
                           .add("map_flux", map_flux));
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
    if (has(material, STOKES_MATERIAL_SUBSURFACE)) {
        const auto power = tables.look_up(material.medium, component, double(exit_point.r_mm), double(exit_point.row));
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
        CHECK(double(exit_point.kept.energy) == Approx(expected.kept).epsilon(5e-6));
        if (component == STOKES_MAP_FLUORESCENCE)
            CHECK(double(exit_point.event_light.energy) == Approx(expected.converted).epsilon(5e-6));
        CHECK((head.x == exit_point.x && head.y == exit_point.y && head.z == exit_point.z));
        if (given[before + i].found == 0) {
            CHECK(head.normal == STOKES_EMPTY_SLOT);
            CHECK(ledger.missed_exits == (expected.kept > 0.0 ? 1u : 0u));
            CHECK(ledger.stored.energy == 0.0f);
        } else if (expected.kept == 0.0) {
            CHECK(head.normal == STOKES_EMPTY_SLOT);
            CHECK(ledger.stored.energy == 0.0f);
        } else {
            CHECK(same_normal(head.normal, {exit_point.nx, exit_point.ny, exit_point.nz}));
            CHECK(head.normal >> 24 == (a.points[exit_point.path].body & 255u));
            CHECK(ledger.missed_exits == 0);
            CHECK(double(ledger.stored.energy) == Approx(expected.kept).epsilon(5e-6));
        }
    }
    for (std::size_t slot = 0; slot < d.heads.size(); ++slot)
        if (slot < first_slot || slot >= end) CHECK((d.heads[slot].normal == empty && d.flux[slot].v[0] == -1.0f));
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
        const Exits e = sample(a, list, round_of(component, list.size()));
        std::vector<double> counts(64, 0.0);
        for (std::size_t i = 0; i < list.size(); ++i) {
            const SurfacePoint& p = a.points[list[i]];
            const Probe& probe = e.probes[before + i];
            if (probe.body == STOKES_NONE) continue;
            const double turn = azimuth_about(
                {p.nx, p.ny, p.nz},
                {double(probe.x) - double(p.x), double(probe.y) - double(p.y), double(probe.z) - double(p.z)});
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

// The foot of the first collision lies way sin(theta) along the refracted ray, the exit at r from it; a direct exit is
// as far from the collision as its row says, and its scale is half the range of cosines times the transmittance.
TEST_CASE("conserving exits lie about the foot of the first collision", "[deposit_subsurface][tiny]") {
    const SubsurfaceArrivals a(120);
    for (const bool reflecting : {false, true})
        for (const std::uint32_t sampler : {STOKES_SAMPLER_DIRECT, STOKES_SAMPLER_SCATTERED}) {
            const std::vector<MaterialRecord> materials = conserving_materials(reflecting);
            EventRound round = round_of(STOKES_MAP_MULTIPLE, a.elastic.size());
            round.sampler = sampler;
            const Exits e = sample(a, a.elastic, round, materials);
            std::size_t open = 0;
            for (std::size_t i = 0; i < a.elastic.size(); ++i) {
                const std::uint32_t path = a.elastic[i];
                const SurfacePoint& p = a.points[path];
                const MaterialRecord& material = materials[p.material];
                const ExitPoint& exit_point = e.exits[before + i];
                const Probe& probe = e.probes[before + i];
                const glm::dvec3 n(p.nx, p.ny, p.nz), entry(p.x, p.y, p.z), d = direction_of(a.rays[path]);
                const double eta = double(material.eta), cos_in = -glm::dot(d, n), way = double(exit_point.way_mm);
                const double cos_within = std::sqrt(1.0 - (1.0 - cos_in * cos_in) / (eta * eta)),
                             depth = way * cos_within;
                const glm::dvec3 foot = entry + (d + cos_in * n) / eta * way;
                const glm::dvec3 at(probe.x, probe.y, probe.z);
                const double r = double(exit_point.r_mm), row = double(exit_point.row);
                CAPTURE(sampler, reflecting, path, r, way, depth);
                const double tolerance = 1e-4 * (1.0 + way + r);
                CHECK(way > 0.0);
                CHECK(std::abs(glm::dot(at - entry, n)) < tolerance);
                CHECK(std::abs(glm::length(at - foot) - r) < tolerance);
                CHECK(double(probe.reach_mm) ==
                      Approx(glm::length(at - entry) + 8.0 * double(offset_mm)).epsilon(1e-4));
                if (sampler == STOKES_SAMPLER_SCATTERED) {
                    CHECK(row == Approx(depth).margin(tolerance));
                    CHECK(exit_point.scale > 0.0f);
                    continue;
                }
                if (exit_point.scale == 0.0f) {
                    CHECK(row * 0.3 > 39.0);  // too far for every wavelength
                    continue;
                }
                ++open;
                CHECK(row * row == Approx(r * r + depth * depth).epsilon(1e-3).margin(tolerance));
                const bool fresnel = has(material, STOKES_MATERIAL_FRESNEL);
                const double critical = fresnel ? std::sqrt(1.0 - 1.0 / (eta * eta)) : 0.0, mu = depth / row;
                CHECK(mu >= critical - 1e-4);
                double transmitted = 1.0;
                if (fresnel) {
                    const double out = std::sqrt(std::max(1.0 - eta * eta * (1.0 - mu * mu), 0.0));
                    const double s = (eta * mu - out) / (eta * mu + out), q = (mu - eta * out) / (mu + eta * out);
                    transmitted = 1.0 - 0.5 * (s * s + q * q);
                }
                if (mu > critical + 1e-2)
                    CHECK(double(exit_point.scale) == Approx(0.5 * (1.0 - critical) * transmitted).epsilon(0.02));
            }
            if (sampler == STOKES_SAMPLER_DIRECT) CHECK(open > 20);
        }
}

// Several exits of an event: the cosine of a direct exit, which is uniform, runs through all strata, azimuths are a
// golden ratio of a turn apart, and the first exit is the one of an event with one exit.
TEST_CASE("several exits of an event are stratified", "[deposit_subsurface][tiny]") {
    const SubsurfaceArrivals a(120);
    const std::vector<MaterialRecord> materials = conserving_materials(false);
    EventRound round = round_of(STOKES_MAP_SINGLE, a.elastic.size());
    round.sampler = STOKES_SAMPLER_DIRECT;
    const Exits one = sample(a, a.elastic, round, materials);
    for (const std::uint32_t count : {2u, 3u, 8u}) {
        round.exits = count;
        const Exits several = sample(a, a.elastic, round, materials);
        std::size_t open = 0;
        for (std::size_t i = 0; i < a.elastic.size(); ++i) {
            const ExitPoint* exits = &several.exits[before + i * count];
            const Probe* probes = &several.probes[before + i * count];
            const SurfacePoint& p = a.points[a.elastic[i]];
            const glm::dvec3 n(p.nx, p.ny, p.nz), entry(p.x, p.y, p.z), d = direction_of(a.rays[a.elastic[i]]);
            const double eta = double(materials[p.material].eta), cos_in = -glm::dot(d, n),
                         way = double(exits[0].way_mm);
            const double depth = way * std::sqrt(1.0 - (1.0 - cos_in * cos_in) / (eta * eta));
            const glm::dvec3 foot = entry + (d + cos_in * n) / eta * way;
            CAPTURE(count, i);
            CHECK(exits[0].r_mm == one.exits[before + i].r_mm);
            CHECK(probes[0].x == one.probes[before + i].x);
            const auto turn = [&](const Probe& probe) {
                return azimuth_about(n, glm::dvec3(probe.x, probe.y, probe.z) - foot);
            };
            for (std::uint32_t k = 0; k < count; ++k) {
                CHECK(exits[k].path == a.elastic[i]);
                CHECK(exits[k].way_mm == exits[0].way_mm);
                if (exits[k].scale == 0.0f || exits[0].scale == 0.0f || depth < 0.05) continue;
                ++open;
                CHECK(double(exits[k].scale) == Approx(0.5 / count));
                const double apart = depth / double(exits[k].row) - depth / double(exits[0].row) - double(k) / count;
                CHECK(std::abs(apart - std::round(apart)) < 1e-3);
                if (exits[k].r_mm < 0.05f || exits[0].r_mm < 0.05f) continue;
                double turned = turn(probes[k]) - turn(probes[0]) - 0.61803398875 * k;
                CHECK(std::abs(turned - std::round(turned)) < 2e-3);
            }
        }
        CHECK(open > 30);
    }
}

TEST_CASE("exits are put where their probe hit, others are marked and keep their distance",
          "[deposit_subsurface][tiny]") {
    const std::vector<Triangle> triangles = {make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                                             make_triangle({3, 1, 2}, {3, 4, 2}, {3, 1, 4})};
    std::vector<Probe> probes(80);
    std::vector<Hit> hits(80);
    std::vector<ExitPoint> given(80);
    for (std::uint32_t i = 0; i < 80; ++i) {
        // The point of the plane above the hit, at a signed distance along a normal of the probe's own.
        const glm::vec3 normal(0.6f, 0.0f, -0.8f);
        const glm::vec3 on_plane = glm::vec3(point_on(triangles[i % 2], 0.25, 0.5)) + 0.1f * normal;
        probes[i] = {on_plane.x, on_plane.y, on_plane.z, 1.0f,
                     normal.x,   normal.y,   normal.z,   i % 4 == 3 ? STOKES_NONE : 1u};
        hits[i] = {0.1f, 0.25f, 0.5f, i % 4 == 2 ? STOKES_NONE : i % 2};
        given[i] = {9, 9, 9, 0.5f * float(i), 0, 0, 1, 30, i, 1, 0, 1, {0, 0}, {0, 0}, 1};
    }
    const Buffer<ExitPoint> buffer = on_device(given);
    Program(test_device(), "deposit_subsurface.cl")
        .kernel("place_exits")
        .launch(78, Arguments()
                        .add("count", 78u)
                        .add("probes", on_device(probes))
                        .add("probe_hits", on_device(hits))
                        .add("triangles", on_device(triangles))
                        .add("exits", buffer));
    const std::vector<ExitPoint> placed = buffer.download();
    for (std::uint32_t i = 0; i < 80; ++i) {
        CAPTURE(i);
        const glm::dvec3 at(placed[i].x, placed[i].y, placed[i].z), n(placed[i].nx, placed[i].ny, placed[i].nz);
        CHECK((placed[i].path == i && placed[i].row == 30.0f && placed[i].r_mm == given[i].r_mm));
        if (i >= 78 || i % 4 == 3) {  // beyond the count, or without a probe
            CHECK((at == glm::dvec3(9) && placed[i].found == 1));
        } else if (i % 4 == 2) {
            CHECK(placed[i].found == 0);
        } else {
            CHECK(glm::length(at - point_on(triangles[i % 2], 0.25, 0.5)) < 1e-6);
            CHECK(glm::length(n - normal_of(triangles[i % 2])) < 1e-6);
            CHECK(placed[i].found == 1);
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

// STEP 1 of model `paper` without a draw: c and 1 - c of each branch's deposits; what the paths go on with is the same.
TEST_CASE("both branches of the paper's model are stored with their weights", "[deposit_subsurface][tiny]") {
    const SubsurfaceArrivals a(90);
    for (const std::uint32_t component : components) {
        const auto& list = component == STOKES_MAP_FLUORESCENCE ? a.fluorescence : a.elastic;
        const std::vector<ExitPoint> given = given_exits(a, list, component);
        const std::size_t end = first_slot + list.size();
        const auto stored = [&](std::uint32_t branches) {
            return deposit(a, given, list.size(), component, std::uint32_t(end), end, STOKES_SAMPLER_PAPER,
                           translucent_materials(), branches);
        };
        const Deposits drawn = stored(0), both = stored(1);
        for (std::size_t i = 0; i < list.size(); ++i) {
            const double c = double(translucent_materials()[given[before + i].material].fluorescent_fraction);
            const double share = component == STOKES_MAP_FLUORESCENCE ? c : 1.0 - c;
            for (std::size_t k = 0; k < 16; ++k)
                CHECK(double(both.flux[first_slot + i].v[k]) ==
                      Approx(share * double(drawn.flux[first_slot + i].v[k])).epsilon(1e-6));
            CHECK(double(both.ledgers[list[i]].stored.energy) ==
                  Approx(share * double(drawn.ledgers[list[i]].stored.energy)).epsilon(1e-6));
            CHECK(both.exits[before + i].kept.energy == drawn.exits[before + i].kept.energy);
            CHECK(both.heads[first_slot + i].normal == drawn.heads[first_slot + i].normal);
        }
    }
}

// PHYSICS section 4 in double precision; some tens of roundings, and those of exp. Where a branch was drawn, each
// wavelength has its own probability of that branch over that of the draw; where both are stored, its own alone.
TEST_CASE("conserving deposits are those of the first collision and its way out", "[deposit_subsurface][tiny]") {
    const std::uint32_t branches = GENERATE(0u, 1u);
    const SubsurfaceArrivals a(90);
    const std::vector<MaterialRecord> materials = conserving_materials(false);
    const std::vector<Flux16> spectra = conserving_spectra();
    const Flux16 &sigma_t = spectra[spectra.size() - 2], &albedo = spectra.back();
    const MadeUpTables tables;
    for (const bool fluorescent : {true, false})
        for (const std::uint32_t sampler : {STOKES_SAMPLER_DIRECT, STOKES_SAMPLER_SCATTERED}) {
            const std::uint32_t component = fluorescent ? STOKES_MAP_FLUORESCENCE : STOKES_MAP_MULTIPLE;
            const std::vector<std::uint32_t>& list = fluorescent ? a.fluorescence : a.elastic;
            std::vector<ExitPoint> given = given_exits(a, list, component);
            for (std::size_t i = 0; i < list.size(); ++i) {
                given[before + i].way_mm = 0.05f * static_cast<float>(i % 40);
                given[before + i].scale = 0.4f;
                given[before + i].row *= sampler == STOKES_SAMPLER_DIRECT ? 0.02f : 1.0f;
            }
            const std::size_t end = first_slot + list.size();
            const Deposits d =
                deposit(a, given, list.size(), component, std::uint32_t(end), end, sampler, materials, branches);
            for (std::size_t i = 0; i < list.size(); ++i) {
                const ExitPoint& exit_point = d.exits[before + i];
                const MaterialRecord& material = materials[exit_point.material];
                const Flux16& incident = a.flux[list[i]];
                std::array<double, 16> weight, uptake, taken_up{}, sent_on{};
                double sum = 0.0, p = 0.0;
                const bool below = has(material, STOKES_MATERIAL_SUBSURFACE);
                for (std::size_t k = 0; k < 16; ++k) {
                    const double sigma = double(sigma_t.v[k]);
                    sum += weight[k] = below ? sigma * std::exp(-sigma * double(exit_point.way_mm)) : 1.0;
                    uptake[k] = (below ? double(material.fluorescent_fraction) : 1.0) *
                                double(spectra[material.excitation_row].v[k]);
                }
                for (std::size_t k = 0; k < 16; ++k) p += uptake[k] * (weight[k] *= 16.0 / sum) / 16.0;
                const double drawn = branches != 0 || !below ? 1.0 : fluorescent ? p : 1.0 - p;
                for (std::size_t k = 0; k < 16; ++k)
                    taken_up[k] = double(incident.v[k]) * weight[k] *
                                  (fluorescent || !below ? uptake[k] : 1.0 - uptake[k]) / drawn;
                const double conversions = a.ledgers[list[i]].conversions + 1.0;
                const double chain =
                    conversions < 16.0 ? (481.0 - conversions) / (16.0 - conversions) * 15.0 / 480.0 : 0.0;
                for (std::size_t ex = 0; ex < 16; ++ex)
                    for (std::size_t em = 0; em < 16; ++em)
                        if (fluorescent)
                            sent_on[em] += taken_up[ex] / double(spectra[material.excitation_row].v[ex]) * chain *
                                           double(spectra[material.reradiation_row + ex].v[em]);
                        else if (ex == em)
                            sent_on[em] = taken_up[em] * double(albedo.v[em]);
                const auto power =
                    below && sampler == STOKES_SAMPLER_SCATTERED
                        ? tables.look_up(material.medium, component, double(exit_point.r_mm), double(exit_point.row))
                        : std::array<double, 16>{};
                double event = 0.0;
                CAPTURE(fluorescent, sampler, i, p, exit_point.material);
                for (std::size_t k = 0; k < 16; ++k) {
                    double through = 1.0;
                    if (below && sampler == STOKES_SAMPLER_DIRECT)
                        through = std::exp(-double(sigma_t.v[k]) * double(exit_point.row));
                    else if (below)
                        through = power[k];
                    CHECK(double(d.flux[first_slot + i].v[k]) ==
                          Approx(sent_on[k] * through * 0.4).epsilon(5e-5).margin(1e-9));
                    event += sampler == STOKES_SAMPLER_DIRECT ? sent_on[k] : taken_up[k];
                }
                CHECK(double(exit_point.event_light.energy) == Approx(event).epsilon(2e-5).margin(1e-9));
                CHECK(double(exit_point.kept.energy) == Approx(sum_of(d.flux[first_slot + i])).epsilon(1e-5));
            }
        }
}

TEST_CASE("nothing is deposited beyond the last slot", "[deposit_subsurface][tiny]") {
    const SubsurfaceArrivals a(90);
    const std::vector<ExitPoint> given = given_exits(a, a.fluorescence, STOKES_MAP_FLUORESCENCE);
    const Deposits d = deposit(a, given, a.fluorescence.size(), STOKES_MAP_FLUORESCENCE, first_slot + 11, 100);
    for (std::size_t slot = 0; slot < 100; ++slot) {
        const bool used = slot >= first_slot && slot < first_slot + 11;
        CHECK((d.heads[slot].normal != empty) == used);
        CHECK((d.flux[slot].v[0] != -1.0f) == used);
    }
    for (std::size_t i = 11; i < a.fluorescence.size(); ++i) CHECK(d.ledgers[a.fluorescence[i]].stored.energy == 0.0f);
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
        CHECK(d.exits[before + i].event_light.energy == 0.0f);
    }
}
