#include <cmath>
#include <limits>
#include <vector>

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

// Areas 1, 4 and 2 mm^2, each facing another way; the first triangle belongs to no light.
std::vector<Triangle> triangles() {
    return {make_triangle({9, 9, 9}, {10, 9, 9}, {9, 10, 9}), make_triangle({0, 0, 0}, {2, 0, 0}, {0, 1, 0}),
            make_triangle({5, 0, 0}, {5, 4, 0}, {5, 0, 2}), make_triangle({0, 5, 0}, {0, 5, 2}, {-2, 7, 0})};
}

double area_of(const Triangle& t) {
    return 0.5 * glm::length(glm::cross(glm::dvec3(t.e1x, t.e1y, t.e1z), glm::dvec3(t.e2x, t.e2y, t.e2z)));
}

std::vector<LightRecord> lights() {
    std::vector<LightRecord> records(5);
    double cumulative = 0.0;
    for (std::size_t i = 0; i < records.size(); ++i) {
        cumulative += probability[i];
        records[i] = LightRecord{};
        records[i].cumulative_probability = i == 4 ? 1.0f : static_cast<float>(cumulative);
        records[i].kind = STOKES_LIGHT_BEAM_DISK;
        records[i].px = 1.0f, records[i].py = 2.0f, records[i].pz = 3.0f;
        records[i].dx = 0.6f, records[i].dz = -0.8f;
        records[i].ux = 1.6f, records[i].uz = 1.2f;  // length 2, at right angles to the direction
        records[i].vy = 0.5f;
    }
    LightRecord& surface = records[surface_light];
    surface.kind = STOKES_LIGHT_SURFACE;
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
        for (std::size_t k = 0; k < 16; ++k)
            rows[i].v[k] = static_cast<float>(i) + 0.01f * static_cast<float>(k);
    return rows;
}

struct Emitted {
    std::vector<Ray> rays;
    std::vector<Flux16> flux;
    std::vector<PathLedger> ledgers;
    std::vector<std::uint32_t> list;
    std::vector<std::size_t> light;  // by the flux they carry
};

// Buffers are ten paths longer than asked for; what stands there must stay.
Emitted emit(std::uint32_t photons, std::uint32_t seed) {
    const std::size_t room = photons + 10;
    const std::vector<Triangle> all = triangles();
    std::vector<float> areas = {7.0f, 9.0f};  // of another light
    double area = 0.0;
    for (std::size_t t = 1; t < all.size(); ++t) areas.push_back(static_cast<float>(area += area_of(all[t])));
    const Buffer<Ray> rays(test_device(), "rays", room);
    const Buffer<Flux16> flux(test_device(), "flux", room);
    const Buffer<PathLedger> ledgers(test_device(), "ledgers", room);
    const Buffer<std::uint32_t> list = on_device(std::vector<std::uint32_t>(room, sentinel));
    Program(test_device(), "emit_photons.cl")
        .kernel("emit_photons")
        .launch(photons, pass_on_device(seed, photons, offset_mm), 5u, on_device(lights()), on_device(areas),
                on_device(all), on_device(photon_flux()), rays, flux, ledgers, list);
    Emitted result{
        rays.download(photons), flux.download(photons), ledgers.download(photons), list.download(), {}};
    const std::vector<Flux16> rows = photon_flux();
    for (const Flux16& f : result.flux) {
        std::size_t i = 0;
        while (i < rows.size() && !same_bits(f, rows[i])) ++i;
        REQUIRE(i < rows.size());
        result.light.push_back(i);
    }
    return result;
}

// The triangle whose plane a surface photon starts above, and its barycentric coordinates there.
std::size_t triangle_below(const Ray& ray, double& u, double& v) {
    const std::vector<Triangle> all = triangles();
    for (std::size_t i = 1; i < all.size(); ++i) {
        const Triangle& t = all[i];
        const glm::dvec3 n = normal_of(t), e1(t.e1x, t.e1y, t.e1z), e2(t.e2x, t.e2y, t.e2z);
        const glm::dvec3 p = origin_of(ray) - double(offset_mm) * n - glm::dvec3(t.v0x, t.v0y, t.v0z);
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
    for (const std::size_t light : {dark_light, surface_light, disk_light, rectangle_light})
        CHECK(seen[light] > 0);
}

// In all the cases below together seven chi-square tests, wrong once in 1000; the sums at 4 standard errors.
const double level = sidak_level(1e-3, 7);

TEST_CASE("lights are chosen by their probability, and their photons add up to their flux",
          "[emit_photons]") {
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
TEST_CASE("surface photons start uniformly over the area, cosine-distributed to the front",
          "[emit_photons]") {
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
    const glm::dvec3 centre(beam.px, beam.py, beam.pz), u(beam.ux, beam.uy, beam.uz),
        v(beam.vx, beam.vy, beam.vz);
    constexpr int steps = 16;
    std::vector<double> disk(steps * steps, 0.0), rectangle(steps * steps, 0.0);
    const auto cell = [](double x, double y) {  // of the unit square
        return std::size_t(std::clamp(int(x * steps), 0, steps - 1) * steps +
                           std::clamp(int(y * steps), 0, steps - 1));
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
