// Photons that start only where they can meet something: where they start, how much of the light they carry, and the
// inverse of where they start.
#include <cmath>
#include <random>

#include "kernels/shared/light.h"
#include "tests/support/catch.hpp"
#include "tests/support/photon_fixture.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

constexpr float offset_mm = 0.001f;
const glm::dvec3 target(30.0, -400.0, 50.0);
constexpr double target_mm = 20.0;

std::vector<Triangle> triangles() { return {make_triangle({0, 0, 0}, {2, 0, 0}, {0, 0, 1})}; }  // facing -y, 1 mm^2

// A disk of radius 1000 mm that shines along -y, through a window of 40 x 20 mm about the place (90, 0, 0), or about
// one at its rim.
LightRecord beam(std::uint32_t kind, bool restricted, float at = 90.0f) {
    LightRecord light{};
    light.kind = kind;
    light.cumulative_probability = 1.0f;
    light.dimensions = 2;
    light.dy = -1.0f;
    light.ux = light.vz = 1000.0f;
    light.restricted = restricted ? 1 : 0;
    light.tx = at, light.ty = -5.0f;
    light.wux = 20.0f, light.wvz = 10.0f;
    light.part = static_cast<float>(800.0 / (kind == STOKES_LIGHT_BEAM_DISK ? M_PI * 1e6 : 4e6));
    return light;
}

LightRecord surface(bool restricted) {
    LightRecord light{};
    light.kind = STOKES_LIGHT_SURFACE;
    light.cumulative_probability = 1.0f;
    light.dimensions = 4;
    light.triangle_count = 1;
    light.restricted = restricted ? 1 : 0;
    light.tx = static_cast<float>(target.x), light.ty = static_cast<float>(target.y),
    light.tz = static_cast<float>(target.z);
    light.target_mm = static_cast<float>(target_mm);
    return light;
}

struct Emitted {
    std::vector<Ray> rays;
    std::vector<Flux16> flux;
    std::vector<PathLedger> ledgers;
};

Arguments scene_of(const LightRecord& light) {
    return Arguments()
        .add("light_count", 1u)
        .add("lights", on_device(std::vector<LightRecord>{light}))
        .add("light_areas", on_device(std::vector<float>{1.0f}))
        .add("triangles", on_device(triangles()));
}

Emitted emit(const LightRecord& light, std::uint32_t photons) {
    const Buffer<Ray> rays(test_device(), "rays", photons);
    const Buffer<Flux16> flux(test_device(), "flux", photons);
    const Buffer<PathLedger> ledgers(test_device(), "ledgers", photons);
    Program(test_device(), "emit_photons.cl")
        .kernel("emit_photons")
        .launch(photons, scene_of(light),
                Arguments("pass", pass_on_device(3, photons, offset_mm))
                    .add("photon_flux", on_device(std::vector<Flux16>{constant_flux(2.0f)}))
                    .add("rays", rays)
                    .add("departures", open_departures(photons))
                    .add("flux", flux)
                    .add("ledgers", ledgers)
                    .add("list", Buffer<std::uint32_t>(test_device(), "list", photons)));
    return {rays.download(), flux.download(), ledgers.download()};
}

// Each path's account is that of a whole photon, whatever part of it the ray carries.
void check_accounts(const Emitted& emitted) {
    for (std::size_t i = 0; i < emitted.rays.size(); ++i) {
        const PathLedger& ledger = emitted.ledgers[i];
        const double carried = sum_of(emitted.flux[i]);
        CAPTURE(i, carried);
        CHECK(static_cast<double>(ledger.emitted.energy) == Approx(32.0).epsilon(1e-5));
        CHECK(static_cast<double>(ledger.escaped.energy) == Approx(32.0 - carried).epsilon(1e-5));
        CHECK(std::abs(imbalance_of(ledger, emitted.flux[i])) < 1e-5);
        CHECK(ledger.fate == (carried > 0.0 ? STOKES_FATE_ALIVE : STOKES_FATE_ESCAPED));
        CHECK(ledger.rays == (carried > 0.0 ? 1 : 0));
    }
}

}  // namespace

TEST_CASE("photons of a beam with a window start there and carry the part that goes through it",
          "[restricted_emission][tiny]") {
    for (const std::uint32_t kind : {STOKES_LIGHT_BEAM_DISK, STOKES_LIGHT_BEAM_RECTANGLE}) {
        const LightRecord light = beam(kind, true);
        const Emitted emitted = emit(light, 100);
        check_accounts(emitted);
        for (std::size_t i = 0; i < emitted.rays.size(); ++i) {
            const glm::dvec3 from = origin_of(emitted.rays[i]) - glm::dvec3(90.0, -5.0, 0.0);
            CHECK(direction_of(emitted.rays[i]) == glm::dvec3(0.0, -1.0, 0.0));
            CHECK((std::abs(from.x) < 20.001 && from.y == 0.0 && std::abs(from.z) < 10.001));
            CHECK(sum_of(emitted.flux[i]) == Approx(32.0 * static_cast<double>(light.part)).epsilon(1e-5));
        }
    }
}

// The rim cuts the window nearly straight, at a third of its width: the sagitta of its height is 0.05 mm.
TEST_CASE("the window of a disk carries light only within the rim", "[restricted_emission]") {
    constexpr std::uint32_t photons = 1u << 14;
    const LightRecord light = beam(STOKES_LIGHT_BEAM_DISK, true, static_cast<float>(1000.0 + 20.0 / 3.0));
    const Emitted emitted = emit(light, photons);
    double within = 0.0;
    for (std::size_t i = 0; i < emitted.rays.size(); ++i) {
        const bool carries = sum_of(emitted.flux[i]) > 0.0;
        const glm::dvec3 at = origin_of(emitted.rays[i]);
        if (std::abs(std::hypot(at.x, at.z) - 1000.0) > 1e-3) CHECK(carries == (std::hypot(at.x, at.z) < 1000.0));
        within += carries ? 1.0 : 0.0;
    }
    CHECK(std::abs(within / photons - 1.0 / 3.0) < 4.0 * std::sqrt(2.0 / 9.0 / photons) + 0.002);
}

// A patch of area A sends the share A cos(patch) cos(light)/(pi d^2) of a diffuse light's flux to itself: here to a
// small disk across the line to the middle of the ball.
TEST_CASE("photons of a surface with a ball go to it and carry the light that a diffuse surface sends there",
          "[restricted_emission]") {
    constexpr std::uint32_t photons = 1u << 16;
    const Emitted emitted = emit(surface(true), photons);
    check_accounts({{emitted.rays.begin(), emitted.rays.begin() + 100},
                    {emitted.flux.begin(), emitted.flux.begin() + 100},
                    {emitted.ledgers.begin(), emitted.ledgers.begin() + 100}});
    const glm::dvec3 middle(2.0 / 3.0, 0.0, 1.0 / 3.0), way = target - middle, axis = glm::normalize(way);
    Sample to_ball, to_patch;
    constexpr double patch_mm = 10.0;
    for (std::size_t i = 0; i < emitted.rays.size(); ++i) {
        const glm::dvec3 from = origin_of(emitted.rays[i]), d = direction_of(emitted.rays[i]);
        const glm::dvec3 beside = target - from - d * glm::dot(target - from, d);
        CHECK(glm::length(beside) < target_mm + 0.002);
        const glm::dvec3 met = from + d * (glm::dot(target - from, axis) / glm::dot(d, axis));
        const double carried = sum_of(emitted.flux[i]) / 32.0;
        to_ball.add(carried);
        to_patch.add(glm::distance(met, target) < patch_mm ? carried : 0.0);
    }
    const double squared = glm::dot(way, way), cosine = -axis.y;
    const double expected = M_PI * patch_mm * patch_mm * cosine / (M_PI * squared);
    CHECK(std::abs(to_patch.mean() - expected) < 4.0 * to_patch.standard_error() + 3e-3 * expected);
    CHECK(to_patch.standard_error() < 0.01 * expected);
    CHECK(to_ball.mean() == Approx(target_mm * target_mm * cosine / squared).epsilon(0.01));
}

TEST_CASE("a photon that starts at the place of a target goes through the target", "[restricted_emission][tiny]") {
    std::mt19937 generator(4);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f), unit(0.0f, 1.0f);
    struct alignas(8) OnLight {
        float at[2];
    };
    struct alignas(16) Place {
        float at[4];
    };
    constexpr std::uint32_t count = 24;
    for (const LightRecord& light : {beam(STOKES_LIGHT_BEAM_DISK, false), beam(STOKES_LIGHT_BEAM_DISK, true),
                                     beam(STOKES_LIGHT_BEAM_RECTANGLE, false), beam(STOKES_LIGHT_BEAM_RECTANGLE, true),
                                     surface(false), surface(true)}) {
        const bool is_beam = light.kind != STOKES_LIGHT_SURFACE;
        CAPTURE(light.kind, light.restricted);
        std::vector<EmissionTarget> targets;
        std::vector<OnLight> on_light;
        for (std::uint32_t i = 0; i < count; ++i) {
            const glm::vec3 at = glm::vec3(is_beam ? glm::dvec3(90.0, -400.0, 0.0) : target) +
                                 9.0f * glm::vec3(uniform(generator), uniform(generator), uniform(generator));
            targets.push_back({at.x, at.y, at.z, 0.0f, i % 4 == 3 ? -1.0f : 1.0f, 0.0f});
            on_light.push_back({{unit(generator), unit(generator)}});
        }
        const Buffer<Place> places(test_device(), "places", count);
        const Buffer<float> densities(test_device(), "densities", count);
        const Program program(test_device(), "emit_photons.cl");
        program.kernel("find_emission_places")
            .launch(count, scene_of(light),
                    Arguments("count", count)
                        .add("light", 0u)
                        .add("targets", on_device(targets))
                        .add("places_on_light", on_device(on_light), "float2")
                        .add("places", places, "float4")
                        .add("densities", densities));
        const std::vector<Place> found = places.download();
        const std::vector<float> density = densities.download();
        // Each place as a cell of its own with one photon.
        std::vector<EmissionCell> cells;
        std::vector<std::uint32_t> first{0};
        for (const Place& place : found) {
            EmissionCell cell{};
            std::copy(std::begin(place.at), std::end(place.at), cell.low);
            cell.probability = 1.0f;
            cell.stride = 1;
            cells.push_back(cell);
            first.push_back(static_cast<std::uint32_t>(first.size()));
        }
        const Buffer<Ray> rays(test_device(), "rays", count);
        program.kernel("emit_stratified")
            .launch(count, scene_of(light),
                    Arguments("pass", pass_on_device(1, count, offset_mm))
                        .add("cell_count", count)
                        .add("cells", on_device(cells))
                        .add("first_photons", on_device(first))
                        .add("photon_flux", on_device(std::vector<Flux16>{constant_flux(1.0f)}))
                        .add("rays", rays)
                        .add("departures", open_departures(count))
                        .add("flux", Buffer<Flux16>(test_device(), "flux", count))
                        .add("ledgers", Buffer<PathLedger>(test_device(), "ledgers", count))
                        .add("list", Buffer<std::uint32_t>(test_device(), "list", count))
                        .add("event_samples", Buffer<EventSample>(test_device(), "samples", count)));
        const std::vector<Ray> ray = rays.download();
        for (std::uint32_t i = 0; i < count; ++i) {
            CAPTURE(i);
            const glm::dvec3 at(targets[i].x, targets[i].y, targets[i].z), d = direction_of(ray[i]);
            const glm::dvec3 way = at - origin_of(ray[i]);
            if (i % 4 == 3) {
                CHECK(density[i] == 0.0f);  // its front looks away
                continue;
            }
            // Off by the rounding of the place, 6e-8 of the light's size or of its directions, and by offset_mm.
            CHECK(glm::length(way - d * glm::dot(way, d)) < 0.01);
            const double area = is_beam ? light.restricted                       ? 800.0
                                          : light.kind == STOKES_LIGHT_BEAM_DISK ? M_PI * 1e6
                                                                                 : 4e6
                                        : 0.0;
            const double sine =
                target_mm * target_mm / glm::dot(target - origin_of(ray[i]), target - origin_of(ray[i]));
            const double cone = 2.0 * M_PI * (1.0 - std::sqrt(1.0 - sine)), squared = glm::dot(way, way);
            const double expected =
                is_beam ? 1.0 / area : -d.y / squared * (light.restricted ? 1.0 / cone : -d.y / M_PI);
            CHECK(static_cast<double>(density[i]) == Approx(expected).epsilon(2e-4));
        }
    }
}
