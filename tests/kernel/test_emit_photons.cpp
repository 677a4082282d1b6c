#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "host/render/emission_cells.hpp"
#include "kernels/shared/light.h"
#include "tests/support/catch.hpp"
#include "tests/support/photon_fixture.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

constexpr std::uint32_t sentinel = 0xabababab;
constexpr float offset_mm = 0.001f;

// Five lights: a dark one that is chosen nonetheless, a surface of three triangles, one that is never chosen,
// a disk beam and a rectangle beam.
const std::vector<double> probability = {0.05, 0.5, 0.0, 0.25, 0.2};
enum { dark_light, surface_light, unused_light, disk_light, rectangle_light };

// Areas 1, 4 and 2.83 mm^2, each facing another way; the first triangle belongs to no light.
std::vector<Triangle> triangles() {
    return {make_triangle({9, 9, 9}, {10, 9, 9}, {9, 10, 9}), make_triangle({0, 0, 0}, {2, 0, 0}, {0, 1, 0}),
            make_triangle({5, 0, 0}, {5, 4, 0}, {5, 0, 2}), make_triangle({0, 5, 0}, {0, 5, 2}, {-2, 7, 0})};
}

std::vector<LightRecord> lights() {
    std::vector<LightRecord> records(5);
    double cumulative = 0.0;
    for (std::size_t i = 0; i < records.size(); ++i) {
        cumulative += probability[i];
        records[i] = LightRecord{};
        records[i].cumulative_probability = i == 4 ? 1.0f : static_cast<float>(cumulative);
        records[i].kind = STOKES_LIGHT_BEAM_DISK;
        records[i].dimensions = 2;
        records[i].px = 1.0f, records[i].py = 2.0f, records[i].pz = 3.0f;
        records[i].dx = 0.6f, records[i].dz = -0.8f;
        records[i].ux = 1.6f, records[i].uz = 1.2f;  // length 2, at right angles to the direction
        records[i].vy = 0.5f;
    }
    LightRecord& surface = records[surface_light];
    surface.kind = STOKES_LIGHT_SURFACE;
    surface.dimensions = 4;
    surface.first_triangle = 1;
    surface.triangle_count = 3;
    surface.first_area = 2;
    records[rectangle_light].kind = STOKES_LIGHT_BEAM_RECTANGLE;
    return records;
}

// Flux of a photon of each light [W/nm], each light by its own pattern.
std::vector<Flux16> photon_flux() {
    std::vector<Flux16> rows(5, constant_flux(0.0f));
    for (std::size_t i = 1; i < rows.size(); ++i)
        for (std::size_t k = 0; k < 16; ++k) rows[i].v[k] = static_cast<float>(i) + 0.01f * static_cast<float>(k);
    return rows;
}

struct alignas(16) Place {
    float at[4];
};

struct Emitted {
    std::vector<Ray> rays;
    std::vector<Flux16> flux;
    std::vector<PathLedger> ledgers;
    std::vector<std::uint32_t> list;
    std::vector<std::size_t> light;        // by the flux they carry
    std::vector<double> weight;            // on that flux
    std::vector<std::uint32_t> cell = {};  // of emit_stratified
    std::vector<Place> place = {};
    std::vector<EventSample> words = {};
};

// The light whose photons carry this flux, times a weight.
std::size_t light_of_flux(const Flux16& flux, float weight) {
    const std::vector<Flux16> rows = photon_flux();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const float expected = rows[i].v[1] * weight;  // patterns differ by more than a hundredth
        if (std::abs(flux.v[1] - expected) <= 1e-5f * expected) return i;
    }
    FAIL("flux of no light");
    return 0;
}

// With cells: by emit_stratified, else at random.
// Buffers are ten paths longer than asked for; what stands there must stay.
Emitted emit(std::uint32_t photons, std::uint32_t seed, const EmissionCells* cells = nullptr,
             std::uint32_t pass_index = 2) {
    const std::size_t room = photons + 10;
    const std::vector<Triangle> all = triangles();
    std::vector<float> areas = {7.0f, 9.0f};  // of another light
    double area = 0.0;
    for (std::size_t t = 1; t < all.size(); ++t) areas.push_back(static_cast<float>(area += area_of(all[t])));
    const Buffer<Ray> rays(test_device(), "rays", room);
    const Buffer<Flux16> flux(test_device(), "flux", room);
    const Buffer<PathLedger> ledgers(test_device(), "ledgers", room);
    const Buffer<std::uint32_t> list = on_device(std::vector<std::uint32_t>(room, sentinel));
    const Program program(test_device(), "emit_photons.cl");
    const Buffer<PassConstants> pass = pass_on_device(seed, photons, offset_mm);
    PassConstants constants = pass.download().front();
    constants.pass = pass_index;
    pass.upload(&constants, 1);
    std::vector<std::uint32_t> first, cell_of_path;
    std::vector<Place> places;
    std::vector<EventSample> words;
    const Arguments scene = Arguments()
                                .add("pass", pass)
                                .add("lights", on_device(lights()))
                                .add("light_areas", on_device(areas))
                                .add("triangles", on_device(all))
                                .add("photon_flux", on_device(photon_flux()));
    const Arguments paths = Arguments()
                                .add("rays", rays)
                                .add("departures", open_departures(room))
                                .add("flux", flux)
                                .add("ledgers", ledgers)
                                .add("list", list);
    if (cells) {
        first = cells->first_photons(seed, pass_index);
        const Buffer<std::uint32_t> owners(test_device(), "cells", photons);
        const Buffer<Place> at(test_device(), "places", photons);
        const Buffer<EventSample> event_samples =
            on_device(std::vector<EventSample>(room, EventSample{sentinel, sentinel}));
        const Arguments strata = Arguments()
                                     .add("cell_count", static_cast<std::uint32_t>(cells->records().size()))
                                     .add("cells", on_device(cells->records()))
                                     .add("first_photons", on_device(first));
        program.kernel("emit_stratified")
            .launch(photons, scene, paths, strata, Arguments("event_samples", event_samples));
        words = event_samples.download();
        program.kernel("find_places")
            .launch(photons, scene, strata, Arguments("cell_of_path", owners).add("places", at, "float4"));
        cell_of_path = owners.download();
        places = at.download();
    } else {
        program.kernel("emit_photons").launch(photons, scene, paths, Arguments("light_count", 5u));
    }
    Emitted result{rays.download(photons),
                   flux.download(photons),
                   ledgers.download(photons),
                   list.download(),
                   {},
                   {},
                   cell_of_path,
                   places,
                   words};
    for (std::uint32_t i = 0; i < photons; ++i) {
        float weight = 1.0f;
        if (cells) {
            const std::uint32_t c = cell_of_path[i];
            weight = cells->records()[c].probability * static_cast<float>(photons) /
                     static_cast<float>(first[c + 1] - first[c]);
        }
        result.weight.push_back(static_cast<double>(weight));
        result.light.push_back(light_of_flux(result.flux[i], weight));
    }
    return result;
}

// The triangle whose plane a surface photon starts above, and its barycentric coordinates there.
std::size_t triangle_below(const Ray& ray, double& u, double& v) {
    const std::vector<Triangle> all = triangles();
    for (std::size_t i = 1; i < all.size(); ++i) {
        const Triangle& t = all[i];
        const glm::dvec3 n = normal_of(t), e1 = e1_of(t), e2 = e2_of(t);
        const glm::dvec3 p = origin_of(ray) - double(offset_mm) * n - v0_of(t);
        if (std::abs(glm::dot(p, n)) > 2e-6) continue;
        const double size = glm::dot(glm::cross(e1, e2), n);
        u = glm::dot(glm::cross(p, e2), n) / size;
        v = glm::dot(glm::cross(e1, p), n) / size;
        if (u > -1e-5 && v > -1e-5 && u + v < 1.0 + 1e-5) return i;
    }
    return 0;
}

}  // namespace

TEST_CASE("every photon starts as its light says", "[emit_photons][tiny]") {
    constexpr std::uint32_t photons = 150;  // not a multiple of the work-group
    const Emitted emitted = emit(photons, 1);
    const std::vector<Flux16> rows = photon_flux();
    std::vector<int> seen(5, 0);
    for (std::uint32_t i = 0; i < photons; ++i) {
        const std::size_t light = emitted.light[i];
        const Ray& ray = emitted.rays[i];
        const PathLedger& ledger = emitted.ledgers[i];
        CAPTURE(i, light);
        ++seen[light];
        CHECK(emitted.list[i] == i);
        CHECK(static_cast<double>(ledger.emitted.energy) == Approx(sum_of(rows[light])).epsilon(1e-6));
        CHECK(static_cast<double>(ledger.reference_flux) == Approx(sum_of(rows[light]) / 16.0).epsilon(1e-6));
        CHECK(glm::length(direction_of(ray)) == Approx(1.0).epsilon(1e-6));
        CHECK(ray.t_min == 0.0f);
        CHECK(std::abs(imbalance_of(ledger, emitted.flux[i])) < 1e-6);
        if (light == dark_light) {
            CHECK(ledger.fate == STOKES_FATE_ABSORBED);
            CHECK(ledger.rays == 0);
            CHECK(ray.t_max < ray.t_min);
        } else {
            CHECK(ledger.fate == STOKES_FATE_ALIVE);
            CHECK(ledger.rays == 1);
            CHECK(ray.t_max == std::numeric_limits<float>::infinity());
        }
    }
    for (std::size_t i = photons; i < emitted.list.size(); ++i) CHECK(emitted.list[i] == sentinel);
    for (const std::size_t light : {dark_light, surface_light, disk_light, rectangle_light}) CHECK(seen[light] > 0);
}

TEST_CASE("a light of a kind that nobody knows emits nothing", "[emit_photons][tiny]") {
    LightRecord light{};
    light.kind = 77;
    light.cumulative_probability = 1.0f;
    const Buffer<PathLedger> ledgers(test_device(), "ledgers", 1);
    Program(test_device(), "emit_photons.cl")
        .kernel("emit_photons")
        .launch(1, Arguments("pass", pass_on_device(1, 1, offset_mm))
                       .add("light_count", 1u)
                       .add("lights", on_device(std::vector<LightRecord>{light}))
                       .add("light_areas", on_device(std::vector<float>{1.0f}))
                       .add("triangles", on_device(triangles()))
                       .add("photon_flux", on_device(std::vector<Flux16>{constant_flux(1.0f)}))
                       .add("rays", on_device(std::vector<Ray>(1)))
                       .add("departures", open_departures(1))
                       .add("flux", on_device(std::vector<Flux16>(1)))
                       .add("ledgers", ledgers)
                       .add("list", on_device(std::vector<std::uint32_t>(1))));
    const PathLedger ledger = ledgers.download().front();
    CHECK((ledger.emitted.energy == 0.0f && ledger.rays == 0 && ledger.fate == STOKES_FATE_ABSORBED));
}

// In all the cases below together seven chi-square tests, wrong once in 1000; the sums at 4 standard errors.
const double level = sidak_level(1e-3, 7);

TEST_CASE("lights are chosen by their probability, and their photons add up to their flux", "[emit_photons]") {
    constexpr std::uint32_t photons = 1u << 18;
    const Emitted emitted = emit(photons, 2);
    std::vector<double> counts(5, 0.0), expected;
    for (const std::size_t light : emitted.light) counts[light] += 1.0;
    CHECK(counts[unused_light] == 0.0);
    for (const double p : probability) expected.push_back(p * photons);
    CHECK(chi_square_p_value(counts, expected) > level);

    // Flux of the light in a row is photons * probability of what one photon carries.
    const std::vector<Flux16> rows = photon_flux();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        double sum = 0.0;
        for (std::size_t k = 0; k < photons; ++k)
            if (emitted.light[k] == i) sum += static_cast<double>(emitted.ledgers[k].emitted.energy);
        const double p = probability[i], flux = p * photons * sum_of(rows[i]);
        const double error = std::sqrt(p * (1.0 - p) * photons) * sum_of(rows[i]);
        CHECK(std::abs(sum - flux) <= 4.0 * error + 1e-6 * flux);
    }
}

// Cells: 8 x 8 steps of the barycentric coordinates, of which those on the diagonal belong to the triangle by
// half.
TEST_CASE("surface photons start uniformly over the area, cosine-distributed to the front", "[emit_photons]") {
    const Emitted emitted = emit(1u << 18, 3);
    const std::vector<Triangle> all = triangles();
    constexpr int steps = 8;
    std::vector<double> counts(3 * steps * steps, 0.0), expected;
    std::vector<CosineHistogram> directions(3, CosineHistogram(24));
    double area = 0.0, total = 0.0;
    for (std::size_t t = 1; t < all.size(); ++t) area += area_of(all[t]);
    for (std::size_t i = 0; i < emitted.rays.size(); ++i) {
        if (emitted.light[i] != surface_light) continue;
        double u = 0.0, v = 0.0;
        const std::size_t t = triangle_below(emitted.rays[i], u, v);
        REQUIRE(t > 0);
        const int a = std::clamp(int(u * steps), 0, steps - 1), b = std::clamp(int(v * steps), 0, steps - 1);
        counts[std::size_t((int(t - 1) * steps + a) * steps + b)] += 1.0;
        total += 1.0;
        REQUIRE(glm::dot(direction_of(emitted.rays[i]), normal_of(all[t])) > 0.0);
        directions[t - 1].add(normal_of(all[t]), direction_of(emitted.rays[i]));
    }
    for (std::size_t t = 1; t < all.size(); ++t)
        for (int a = 0; a < steps; ++a)
            for (int b = 0; b < steps; ++b) {
                const double cells = a + b < steps - 1 ? 1.0 : a + b == steps - 1 ? 0.5 : 0.0;
                expected.push_back(total * area_of(all[t]) / area * cells * 2.0 / (steps * steps));
            }
    CHECK(chi_square_p_value(counts, expected) > level);
    for (const CosineHistogram& histogram : directions) CHECK(chi_square_uniform(histogram.counts()) > level);
}

TEST_CASE("beams are parallel and fill their cross-section evenly", "[emit_photons]") {
    const Emitted emitted = emit(1u << 18, 4);
    const LightRecord beam = lights()[disk_light];
    const glm::dvec3 centre(beam.px, beam.py, beam.pz), u(beam.ux, beam.uy, beam.uz), v(beam.vx, beam.vy, beam.vz);
    constexpr int steps = 16;
    std::vector<double> disk(steps * steps, 0.0), rectangle(steps * steps, 0.0);
    const auto cell = [](double x, double y) {  // of the unit square
        return std::size_t(std::clamp(int(x * steps), 0, steps - 1) * steps + std::clamp(int(y * steps), 0, steps - 1));
    };
    for (std::size_t i = 0; i < emitted.rays.size(); ++i) {
        const std::size_t light = emitted.light[i];
        if (light != disk_light && light != rectangle_light) continue;
        const Ray& ray = emitted.rays[i];
        REQUIRE((ray.dx == beam.dx && ray.dy == beam.dy && ray.dz == beam.dz));
        const glm::dvec3 p = origin_of(ray) - centre;
        REQUIRE(std::abs(glm::dot(p, direction_of(ray))) < 1e-6);
        const double a = glm::dot(p, u) / glm::dot(u, u), b = glm::dot(p, v) / glm::dot(v, v);
        if (light == disk_light) {
            REQUIRE(a * a + b * b < 1.0 + 1e-6);
            disk[cell(a * a + b * b, 0.5 + std::atan2(b, a) / (2.0 * M_PI))] += 1.0;
        } else {
            REQUIRE(std::max(std::abs(a), std::abs(b)) < 1.0 + 1e-6);
            rectangle[cell(0.5 * (a + 1.0), 0.5 * (b + 1.0))] += 1.0;
        }
    }
    CHECK(chi_square_uniform(disk) > level);
    CHECK(chi_square_uniform(rectangle) > level);
}

namespace {

const std::vector<EmittingLight> emitting = {{0.05, 2}, {0.5, 4}, {0.0, 2}, {0.25, 2}, {0.2, 2}};

// Photons that bring most where the first coordinate is small, and of surfaces where the third is.
EmissionCells aimed_cells(std::uint32_t photons) {
    std::vector<EmissionSample> samples;
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> uniform(0.0f, 0.999999f);
    for (int i = 0; i < 40000; ++i) {
        EmissionSample sample;
        const double u = static_cast<double>(uniform(generator));
        sample.light = u < 0.05 ? dark_light : u < 0.55 ? surface_light : u < 0.8 ? disk_light : rectangle_light;
        for (float& x : sample.place) x = uniform(generator);
        sample.square = std::exp(
            -5.0 * static_cast<double>(sample.place[0] + (sample.light == surface_light ? sample.place[2] : 0.0f)));
        samples.push_back(sample);
    }
    return EmissionCells::aimed(emitting, samples, 0.2, 64, photons);
}

}  // namespace

TEST_CASE("stratified photons start as their cells say", "[emit_photons][tiny]") {
    constexpr std::uint32_t photons = 150;
    const EmissionCells cells = aimed_cells(photons);
    REQUIRE(cells.records().size() > 20);
    const Emitted emitted = emit(photons, 1, &cells);
    for (std::uint32_t i = 0; i < photons; ++i) {
        const EmissionCell& cell = cells.records()[emitted.cell[i]];
        CAPTURE(i, emitted.cell[i]);
        if (cell.light == dark_light)
            CHECK(emitted.ledgers[i].fate == STOKES_FATE_ABSORBED);
        else
            CHECK(emitted.light[i] == cell.light);
        CHECK(emitted.list[i] == i);
        CHECK(std::abs(imbalance_of(emitted.ledgers[i], emitted.flux[i])) < 1e-6);
        for (std::size_t d = 0; d < 4; ++d) {
            if (d >= 2 && cell.light != surface_light) {
                CHECK(emitted.place[i].at[d] == 0.0f);
                continue;
            }
            CHECK(emitted.place[i].at[d] >= cell.low[d]);
            CHECK(emitted.place[i].at[d] <= cell.low[d] + cell.size[d]);
        }
    }
    for (std::size_t i = photons; i < emitted.list.size(); ++i) CHECK(emitted.list[i] == sentinel);
}

// Of n points of a sequence that follow one another all but those at both ends come in groups of 8, one in each eighth;
// of either end there is one in an eighth or none. Of random ones 4096 in 8 steps are off by 21.
TEST_CASE("coordinates of a photon's first event are even over its cell, and not those of its place",
          "[emit_photons]") {
    constexpr std::uint32_t photons = 1u << 15;
    const EmissionCells cells = EmissionCells::stratified(emitting, photons);
    for (const std::uint32_t pass : {0u, 3u}) {
        const Emitted emitted = emit(photons, 4, &cells, pass);
        for (std::size_t i = photons; i < emitted.words.size(); ++i)
            CHECK((emitted.words[i].first == sentinel && emitted.words[i].second == sentinel));
        for (std::uint32_t c = 0; c < cells.records().size(); ++c) {
            const bool surface = cells.records()[c].light == surface_light;
            std::array<std::array<int, 8>, 2> counts{};
            std::array<std::array<double, 64>, 2> pairs{};
            int n = 0, same = 0;
            for (std::uint32_t i = 0; i < photons; ++i) {
                if (emitted.cell[i] != c) continue;
                ++n;
                const auto eighth = [](std::uint32_t word) {  // the first digit is the lowest
                    return (word & 1u) << 2 | (word & 2u) | (word & 4u) >> 2;
                };
                const std::uint32_t d = eighth(emitted.words[i].first), a = eighth(emitted.words[i].second);
                ++counts[0][d], ++counts[1][a];
                const auto& place = emitted.place[i].at;
                for (const std::size_t k : {0u, 1u})
                    pairs[k][static_cast<std::size_t>(std::min(place[k] * 8.0f, 7.0f)) * 8 + (k == 0 ? d : a)] += 1.0;
                if (surface) same += d == static_cast<std::uint32_t>(std::min(place[2] * 8.0f, 7.0f));
            }
            CAPTURE(pass, c, n);
            REQUIRE(n > 1000);
            for (const auto& eighths : counts)
                for (const int count : eighths) CHECK(std::abs(count - n / 8.0) <= 2.0);
            for (const auto& boxes : pairs)  // as even as, or more so than, by chance
                for (const double box : boxes) CHECK(std::abs(box - n / 64.0) < 5.0 * std::sqrt(n / 64.0));
            CHECK(std::abs(same - (surface ? n / 8.0 : 0.0)) <= 5.0 * std::sqrt(n / 8.0));
        }
    }
}

// Weighted, the photons are those of random emission: where they start and whereto they go, in boxes of the light, and
// their moments. 12 passes of their own seeds give the errors of some 150 sums; 4.5 standard errors of 11 degrees of
// freedom are exceeded by one of them in 8 choices of the seeds.
TEST_CASE("weighted by their cells, stratified photons are spread as random ones", "[emit_photons]") {
    constexpr std::uint32_t photons = 1u << 15, seeds = 12;
    for (const EmissionCells& cells : {EmissionCells::stratified(emitting, photons), aimed_cells(photons)}) {
        constexpr std::size_t wedges = 8, rings = 4, bins = 24;
        std::vector<Sample> disk(wedges * rings), cosine(bins), turn(bins), places(3 * 16), rectangle(16), joint(3 * 4);
        for (std::uint32_t seed = 0; seed < seeds; ++seed) {
            const Emitted emitted = emit(photons, 100 + seed, &cells);
            std::vector<double> on_disk(disk.size(), 0.0), by_cosine(bins, 0.0), by_turn(bins, 0.0);
            std::vector<double> by_place(places.size(), 0.0), on_rectangle(rectangle.size(), 0.0),
                by_both(joint.size(), 0.0);
            const std::vector<Triangle> all = triangles();
            const LightRecord beam = lights()[disk_light];
            const glm::dvec3 centre(beam.px, beam.py, beam.pz), u(beam.ux, beam.uy, beam.uz),
                v(beam.vx, beam.vy, beam.vz);
            for (std::size_t i = 0; i < photons; ++i) {
                const double w = emitted.weight[i] / photons;
                if (emitted.light[i] == disk_light) {
                    const glm::dvec3 p = origin_of(emitted.rays[i]) - centre;
                    const double a = glm::dot(p, u) / glm::dot(u, u), b = glm::dot(p, v) / glm::dot(v, v);
                    REQUIRE(a * a + b * b < 1.0 + 1e-5);
                    const auto ring = std::min(std::size_t((a * a + b * b) * rings), rings - 1);
                    const auto wedge =
                        std::min(std::size_t((0.5 + std::atan2(b, a) / (2.0 * M_PI)) * wedges), wedges - 1);
                    on_disk[ring * wedges + wedge] += w;
                } else if (emitted.light[i] == surface_light) {
                    double s = 0.0, t = 0.0;
                    const std::size_t k = triangle_below(emitted.rays[i], s, t);
                    REQUIRE(k > 0);
                    const glm::dvec3 n = normal_of(all[k]), d = direction_of(emitted.rays[i]);
                    const double mu = glm::dot(n, d);
                    REQUIRE(mu > 0.0);
                    by_cosine[std::min(std::size_t(mu * mu * bins), bins - 1)] += w;
                    by_turn[std::min(std::size_t(azimuth_about(n, d) * bins), bins - 1)] += w;
                    // Uniform: v over what s leaves of the triangle, and the square of that.
                    const double left = std::max(1.0 - s, 1e-9);
                    const auto a = std::min(std::size_t(left * left * 4.0), std::size_t{3});
                    const auto b = std::min(std::size_t(std::max(t / left, 0.0) * 4.0), std::size_t{3});
                    by_place[(k - 1) * 16 + a * 4 + b] += w;
                    by_both[(k - 1) * 4 + (left * left > 0.5 ? 2u : 0u) + (mu * mu > 0.5 ? 1u : 0u)] += w;
                } else if (emitted.light[i] == rectangle_light) {
                    const glm::dvec3 p = origin_of(emitted.rays[i]) - centre;
                    const double a = 0.5 + 0.5 * glm::dot(p, u) / glm::dot(u, u),
                                 b = 0.5 + 0.5 * glm::dot(p, v) / glm::dot(v, v);
                    on_rectangle[std::min(std::size_t(a * 4.0), std::size_t{3}) * 4 +
                                 std::min(std::size_t(b * 4.0), std::size_t{3})] += w;
                }
            }
            for (std::size_t k = 0; k < disk.size(); ++k) disk[k].add(on_disk[k]);
            for (std::size_t k = 0; k < bins; ++k) cosine[k].add(by_cosine[k]), turn[k].add(by_turn[k]);
            for (std::size_t k = 0; k < places.size(); ++k) places[k].add(by_place[k]);
            for (std::size_t k = 0; k < rectangle.size(); ++k) rectangle[k].add(on_rectangle[k]);
            for (std::size_t k = 0; k < joint.size(); ++k) joint[k].add(by_both[k]);
        }
        std::array<double, 3> area{};  // of the surface light's
        for (std::size_t k = 0; k < 3; ++k) area[k] = area_of(triangles()[k + 1]);
        const double all_areas = area[0] + area[1] + area[2];
        for (double& a : area) a /= all_areas;
        const auto check = [](const Sample& sample, double expected) {
            CAPTURE(expected, sample.mean(), sample.standard_error());
            CHECK(std::abs(sample.mean() - expected) < 4.5 * sample.standard_error() + 1e-5);
            CHECK(sample.standard_error() < 0.03 * expected);
        };
        for (std::size_t k = 0; k < places.size(); ++k) check(places[k], 0.5 * area[k / 16] / 16.0);
        for (std::size_t k = 0; k < joint.size(); ++k) check(joint[k], 0.5 * area[k / 4] / 4.0);
        for (const Sample& sample : rectangle) check(sample, 0.2 / 16.0);
        for (const Sample& sample : disk)
            CHECK(std::abs(sample.mean() - 0.25 / 32.0) < 4.5 * sample.standard_error() + 1e-5);
        for (const Sample& sample : cosine)
            CHECK(std::abs(sample.mean() - 0.5 / bins) < 4.5 * sample.standard_error() + 1e-5);
        for (const Sample& sample : turn)
            CHECK(std::abs(sample.mean() - 0.5 / bins) < 4.5 * sample.standard_error() + 1e-5);
    }
}

// A sequence whose aligned runs of 2^m points have one in each of 2^m boxes: in each of 8 x 8 squares of the rectangle
// a pass has 51 photons and 16 passes have 819, give or take a few; of random ones the roots, 7 and 29.
TEST_CASE("stratified photons lie evenly in a pass and over passes", "[emit_photons]") {
    constexpr std::uint32_t photons = 1u << 14, passes = 16;
    const EmissionCells cells = EmissionCells::stratified(emitting, photons);
    const auto counts_of = [&](std::uint32_t pass) {
        const Emitted emitted = emit(photons, 9, &cells, pass);
        std::vector<double> counts(64, 0.0);
        for (std::size_t i = 0; i < photons; ++i)
            if (emitted.light[i] == rectangle_light)
                counts[std::size_t(emitted.place[i].at[0] * 8.0f) * 8 + std::size_t(emitted.place[i].at[1] * 8.0f)] +=
                    1.0;
        return counts;
    };
    const double mean = 0.2 * photons / 64.0;
    std::vector<double> sums(64, 0.0);
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const std::vector<double> counts = counts_of(pass);
        for (std::size_t k = 0; k < 64; ++k) {
            CHECK(std::abs(counts[k] - mean) < 5.0);
            sums[k] += counts[k];
        }
    }
    for (const double sum : sums) CHECK(std::abs(sum - passes * mean) < 6.0);
    CHECK(counts_of(3) == counts_of(3));
    CHECK(counts_of(3) != counts_of(4));
}
