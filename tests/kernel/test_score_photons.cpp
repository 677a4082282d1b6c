#include <cmath>
#include <random>

#include "host/render/camera_view.hpp"
#include "kernels/shared/gather.h"
#include "tests/support/catch.hpp"
#include "tests/support/normals.hpp"
#include "tests/support/photon_fixture.hpp"
#include "tests/support/textures.hpp"

using namespace stokes;

namespace {

constexpr std::uint32_t width = 61, height = 43;
constexpr std::uint32_t unwritten = 0xabababab;

// Looks down at the plane y = 0, aslant.
Camera camera() {
    Camera result;
    result.position_mm = {0.0, 80.0, 50.0};
    result.target_mm = {0.0, 0.0, 0.0};
    result.vertical_fov_deg = 30.0;
    return result;
}

std::vector<std::uint32_t> rays_of_pixels(std::uint32_t w, std::uint32_t h) {
    const Buffer<std::uint32_t> rays(test_device(), "rays", std::size_t{w} * h);
    test_program("tiles.cl")
        .kernel("rays_of_pixels")
        .launch(rays.size(), Arguments().add("width", w).add("height", h).add("rays", rays));
    return rays.download();
}

struct alignas(8) Uint2 {
    std::uint32_t x, y;
};

// What the middle of each pixel sees of the plane y = 0, in the order of the rays.
std::vector<GatherPoint> points_on_floor(const CameraRecord& c, std::uint32_t maps, float weight) {
    const Buffer<Uint2> pixels(test_device(), "pixels", std::size_t{width} * height);
    test_program("tiles.cl")
        .kernel("pixels_of_rays")
        .launch(pixels.size(), Arguments().add("width", width).add("height", height).add("pixels", pixels, "uint2"));
    std::vector<GatherPoint> points;
    for (const Uint2& pixel : pixels.download()) {
        const float x = static_cast<float>(pixel.x) + 0.5f, y = static_cast<float>(pixel.y) + 0.5f;
        const glm::dvec3 d(c.corner_x + x * c.right_x + y * c.down_x, c.corner_y + x * c.right_y + y * c.down_y,
                           c.corner_z + x * c.right_z + y * c.down_z);
        const glm::dvec3 p = glm::dvec3(c.position_x, c.position_y, c.position_z) - d * (double(c.position_y) / d.y);
        GatherPoint point{};
        point.x = static_cast<float>(p.x), point.y = 0.0f, point.z = static_cast<float>(p.z);
        point.ny = 1.0f;
        point.pixel = pixel.y * width + pixel.x;
        point.maps = maps;
        point.weight = weight;
        points.push_back(point);
    }
    return points;
}

struct Photons {
    std::vector<PhotonHead> heads;
    std::vector<Flux16> flux;
};

std::vector<float> scores_of(const Photons& photons, std::uint32_t map, const std::vector<GatherPoint>& points,
                             const Flux16& reflectance) {
    PassConstants pass{};
    for (std::size_t k = 0; k < 16; ++k) {
        pass.to_x[k] = 1.0f + static_cast<float>(k);
        pass.to_y[k] = 2.0f;
        pass.to_z[k] = k < 8 ? 3.0f : 0.0f;
    }
    const auto slots = static_cast<std::uint32_t>(photons.heads.size());
    const Buffer<float> scores(test_device(), "scores", slots);
    Program(test_device(), "score_photons.cl")
        .kernel("score_photons")
        .launch(slots, Arguments()
                           .add("slots", slots)
                           .add("map", map)
                           .add("camera", make_camera_record(camera(), width, height))
                           .add("pass", on_device(std::vector<PassConstants>{pass}))
                           .add("map_heads", on_device(photons.heads))
                           .add("map_flux", on_device(photons.flux))
                           .add("gather_points", on_device(points))
                           .add("spectra", on_device(std::vector<Flux16>{reflectance}))
                           .add("texture_records", no_textures(1).records)
                           .add("scores", scores));
    return scores.download();
}

// X, Y, Z of radiance.
glm::dvec3 value_of(const Flux16& radiance) {
    glm::dvec3 sum(0.0);
    for (std::size_t k = 0; k < 16; ++k)
        sum += static_cast<double>(radiance.v[k]) * glm::dvec3(1.0 + static_cast<double>(k), 2.0, k < 8 ? 3.0 : 0.0);
    return sum;
}

PhotonHead head_at(double x, double y, double z, const glm::dvec3& normal = {0.0, 1.0, 0.0}) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), pack_normal_twin(normal)};
}

}  // namespace

TEST_CASE("every pixel's ray is found again", "[score_photons][tiny]") {
    for (const auto& [w, h] :
         std::vector<std::pair<std::uint32_t, std::uint32_t>>{{1, 1}, {7, 3}, {8, 8}, {17, 9}, {61, 43}}) {
        const std::vector<std::uint32_t> rays = rays_of_pixels(w, h);
        for (std::uint32_t i = 0; i < rays.size(); ++i) REQUIRE(rays[i] == i);
    }
}

TEST_CASE("paths are noted at the slots of their deposits", "[score_photons][tiny]") {
    const Buffer<std::uint32_t> slots = on_device(std::vector<std::uint32_t>(20, unwritten));
    const std::vector<std::uint32_t> list = {1, 2, 7, 3, 9, 30};
    // Slots 5 to 16, of which 15 and 16 are beyond the map.
    Program(test_device(), "score_photons.cl")
        .kernel("note_paths")
        .launch(4, Arguments()
                       .add("count", 4u)
                       .add("exits_each", 3u)
                       .add("first_entry", 2u)
                       .add("first_slot", 5u)
                       .add("slot_limit", 15u)
                       .add("event_lists", on_device(list))
                       .add("path_of_slot", slots));
    const std::vector<std::uint32_t> written = slots.download();
    for (std::uint32_t i = 0; i < 20; ++i) CHECK(written[i] == (i >= 5 && i < 15 ? list[2 + (i - 5) / 3] : unwritten));
}

// The density estimate itself: in a disk of radius r the photon adds value/(pi r^2) to each pixel whose point is nearer
// than r, counted one by one; the sum of their squares is the score over pi r^2. The pixels' number in a disk of 350 of
// them differs from its area by their perimeter's roughness, a few in a hundred.
TEST_CASE("a photon's score is what it adds to the squares of the pixels", "[score_photons]") {
    const CameraRecord record = make_camera_record(camera(), width, height);
    const Flux16 reflectance = constant_flux(0.5f);
    std::mt19937 generator(3);
    for (const std::uint32_t map : {STOKES_MAP_FLUORESCENCE, STOKES_MAP_SURFACE}) {
        const std::vector<GatherPoint> points = points_on_floor(record, 1u << map, 1.25f);
        for (const glm::dvec2 place : {glm::dvec2(0.0, 0.0), glm::dvec2(6.0, -9.0), glm::dvec2(-11.0, 8.0)}) {
            Photons photons{{head_at(place.x, 0.0, place.y)}, {random_flux(generator, 0.5, 2.0)}};
            constexpr double radius = 10.0;
            Flux16 radiance = photons.flux[0];
            for (float& v : radiance.v)
                v *= 1.25f / static_cast<float>(M_PI) * (map == STOKES_MAP_SURFACE ? 0.5f : 1.0f);
            const glm::dvec3 added = value_of(radiance) / (M_PI * radius * radius);
            double squares = 0.0;
            for (const GatherPoint& p : points)
                if (std::hypot(static_cast<double>(p.x) - place.x, static_cast<double>(p.z) - place.y) < radius)
                    squares += glm::dot(added, added);
            const double score = static_cast<double>(scores_of(photons, map, points, reflectance)[0]);
            CHECK(score / (M_PI * radius * radius) == Approx(squares).epsilon(0.05));
        }
    }
}

TEST_CASE("photons that the camera does not see score nothing", "[score_photons][tiny]") {
    const CameraRecord record = make_camera_record(camera(), width, height);
    std::vector<GatherPoint> points = points_on_floor(record, 1u << STOKES_MAP_SINGLE, 1.0f);
    Photons photons;
    photons.heads = {head_at(0, 0, 0),     // seen
                     head_at(0, -6, 0),    // below the floor
                     head_at(0, 20, 12),   // above it, in the same pixels
                     head_at(400, 0, 0),   // beside the picture
                     head_at(0, 100, 70),  // behind the camera
                     head_at(0, 0, 0),    head_at(0, 0, 0)};
    photons.heads[5].normal = STOKES_EMPTY_SLOT;
    photons.heads[6].normal |= 1u << 24;  // of another body
    photons.flux.assign(7, constant_flux(1.0f));
    const std::vector<float> scores = scores_of(photons, STOKES_MAP_SINGLE, points, constant_flux(1.0f));
    CHECK(scores[0] > 0.0f);
    for (std::size_t i = 1; i < scores.size(); ++i) {
        CAPTURE(i);
        CHECK(scores[i] == 0.0f);
    }
    // The material there is not lit by this map.
    CHECK(scores_of(photons, STOKES_MAP_MULTIPLE, points, constant_flux(1.0f))[0] == 0.0f);
}
