#include <cmath>

#include "host/render/gather.hpp"
#include "host/render/local_radii.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/normals.hpp"

using namespace stokes;

namespace {

struct Photons {
    std::vector<PhotonHead> heads;
    std::vector<Flux16> flux;
};

// Photons of body 2 in the plane z = 0, a grid of this spacing up to that far from the origin in x and y, four times as
// thick for x < 0.
Photons two_densities(float spacing_mm, float half_mm = 20.0f) {
    Photons photons;
    const auto fill = [&](float from_x, float to_x, float spacing) {
        for (float x = from_x + 0.5f * spacing; x < to_x; x += spacing)
            for (float y = -half_mm + 0.5f * spacing; y < half_mm; y += spacing) {
                photons.heads.push_back({x, y, 0.0f, pack_normal_twin({0.0, 0.0, 1.0}, 2)});
                photons.flux.push_back({});
                for (float& v : photons.flux.back().v) v = 0.25f;
            }
    };
    fill(-half_mm, 0.0f, 0.5f * spacing_mm);
    fill(0.0f, half_mm, spacing_mm);
    return photons;
}

GatherPoint point_at(float x, float y) {
    GatherPoint p{};
    p.x = x;
    p.y = y;
    p.nz = 1.0f;
    p.body = 2;
    p.maps = 1u << STOKES_MAP_SURFACE;
    return p;
}

// [count_levels][points]
std::vector<float> counts_of(const std::vector<GatherPoint>& points, const Photons& photons, float radius_mm,
                             float enough = enough_photons, std::uint32_t map = STOKES_MAP_SURFACE) {
    const auto slots = static_cast<std::uint32_t>(photons.heads.size());
    HashBuilder builder(test_device(), slots);
    SpatialHash hash(test_device(), "test", slots);
    const Buffer<PhotonHead> heads(test_device(), "heads", photons.heads);
    const Buffer<Flux16> flux(test_device(), "flux", photons.flux);
    const Buffer<GatherPoint> given(test_device(), "points", points);
    const Buffer<float> counts(test_device(), "counts", std::vector<float>(count_levels * points.size(), 0.0f));
    Kernel kernel = Program(test_device(), "count_photons.cl").kernel("count_photons");
    float counted_mm = least_count_factor * radius_mm;
    const auto count = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t level = 0; level < count_levels; ++level, counted_mm *= 2.0f) {
        builder.build(hash, heads, flux, slots, {-20.0f, -20.0f, 0.0f}, {20.0f, 20.0f, 0.0f}, counted_mm);
        kernel.launch(count, Arguments()
                                 .add("gather_points", given)
                                 .add("count", count)
                                 .add("map", map)
                                 .add("level", level)
                                 .add("enough", enough)
                                 .add("counts", counts)
                                 .add(hash.arguments()));
    }
    return counts.download();
}

}  // namespace

// A disk of radius r over a grid of spacing d holds pi r^2 / d^2 points, within some 3 r / d of them at its rim.
TEST_CASE("photons are counted in each disk up to the first with enough", "[count_photons]") {
    const std::vector<GatherPoint> points = {point_at(10.0f, 0.0f), point_at(-10.0f, 0.0f)};
    const std::vector<float> all = counts_of(points, two_densities(0.4f), 1.0f, 1e9f);
    const std::vector<float> some = counts_of(points, two_densities(0.4f), 1.0f);
    double radius = double(least_count_factor);
    for (std::size_t level = 0; level < count_levels; ++level, radius *= 2.0) {
        const double cells = M_PI * radius * radius / 0.16;
        CHECK(double(all[2 * level]) == Approx(cells).margin(3.0 * radius / 0.4));
        CHECK(double(all[2 * level + 1]) == Approx(4.0 * cells).margin(3.0 * radius / 0.2));
        for (std::size_t i : {0u, 1u}) {
            const bool needed = level == 0 || all[2 * (level - 1) + i] < enough_photons;
            CHECK(some[2 * level + i] == (needed ? all[2 * level + i] : 0.0f));
        }
    }
}

TEST_CASE("what does not light a point is not counted, and unequal photons count as fewer", "[count_photons][tiny]") {
    Photons photons = two_densities(1.0f, 6.0f);
    std::vector<GatherPoint> points(4, point_at(3.0f, 0.0f));
    points[1].body = 3;
    points[2].nz = -1.0f;
    points[3].z = 5.0f;
    const std::vector<float> even = counts_of(points, photons, 2.0f, 1e9f);
    CHECK(even[0] > 8.0f);
    for (std::size_t i : {1u, 2u, 3u}) CHECK(even[i] == 0.0f);
    CHECK(counts_of(points, photons, 2.0f, 1e9f, STOKES_MAP_SINGLE)[0] == 0.0f);
    // One with as much light as all others: (2 n)^2 / (n^2 + n), below 4.
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < photons.heads.size(); ++i)
        if (std::hypot(photons.heads[i].x - 3.0f, photons.heads[i].y) <
            std::hypot(photons.heads[nearest].x - 3.0f, photons.heads[nearest].y))
            nearest = i;
    const float others = even[0] - 1.0f;
    for (float& v : photons.flux[nearest].v) v *= others;
    CHECK(counts_of(points, photons, 2.0f, 1e9f)[0] == Approx(4.0f * others / (others + 1.0f)));
}

// Four times fewer photons: the root of two times the radius. Away from the border, where disks hold both.
TEST_CASE("two densities have two radii", "[count_photons]") {
    constexpr std::uint32_t width = 40, height = 8;
    std::vector<GatherPoint> points;
    for (std::uint32_t i = 0; i < width * height; ++i) {
        points.push_back(
            point_at(0.9f * (static_cast<float>(i % width) - 19.5f), static_cast<float>(i / width) - 3.5f));
        points.back().pixel = i;
    }
    const float spacing_mm = 0.5f;
    const float radius_mm = 0.5f * spacing_mm * std::sqrt(20.0f / static_cast<float>(M_PI));
    const std::vector<PixelRadius> radii =
        pixel_radii(points, counts_of(points, two_densities(spacing_mm), radius_mm), width, height);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        if (std::abs(points[i].x) < 4.0f) continue;
        CHECK(double(radii[i].factor) == Approx(points[i].x > 0.0f ? std::sqrt(2.0) : 1.0).epsilon(0.04));
    }
}
