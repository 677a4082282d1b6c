#include <cmath>

#include "host/render/local_radii.hpp"
#include "kernels/shared/photon.h"
#include "tests/support/catch.hpp"

using namespace stokes;

namespace {

constexpr std::uint32_t width = 24, height = 20;

// Photons in disks of the counted radii where an even density has this many in that of the first radius.
std::vector<float> counts_of(double at_one) {
    std::vector<float> counts;
    for (double radius = double(least_count_factor); counts.size() < count_levels; radius *= 2.0)
        counts.push_back(static_cast<float>(at_one * radius * radius));
    return counts;
}

struct Picture {
    std::vector<GatherPoint> points;
    std::vector<float> counts;  // [count_levels][points]
};

// One point a pixel, facing +z, of material 0, all with these counts.
Picture even_picture(double at_one) {
    Picture picture;
    for (std::uint32_t i = 0; i < width * height; ++i) {
        GatherPoint p{};
        p.pixel = width * height - 1 - i;  // any order will do
        p.nz = 1.0f;
        p.maps = 1u << STOKES_MAP_SURFACE;
        picture.points.push_back(p);
    }
    picture.counts.resize(count_levels * picture.points.size());
    for (std::size_t i = 0; i < picture.points.size(); ++i)
        for (std::size_t level = 0; level < count_levels; ++level)
            picture.counts[level * picture.points.size() + i] = counts_of(at_one)[level];
    return picture;
}

std::vector<PixelRadius> radii(const Picture& picture) {
    return pixel_radii(picture.points, picture.counts, width, height);
}

}  // namespace

// Twenty photons lie within sqrt(20 / n) of the first radius where n lie within that: the factor is the root of it.
TEST_CASE("the factor is the fourth root of what is missing", "[local_radii]") {
    for (const double n : {20.0, 15.0, 7.0, 5.0, 1.0, 0.2})
        CHECK(double(radius_factor(counts_of(n))) == Approx(std::pow(20.0 / n, 0.25)).epsilon(1e-4));
    CHECK(radius_factor(counts_of(20.0)) == Approx(1.0));
    CHECK(radius_factor(counts_of(5.0)) == Approx(std::sqrt(2.0)));
    CHECK(radius_factor(counts_of(1e9)) == least_radius_factor);
    CHECK(radius_factor(counts_of(0.0)) == largest_radius_factor);
    CHECK(radius_factor(counts_of(1e-9)) == largest_radius_factor);
    // More photons never make it larger.
    float last = largest_radius_factor;
    for (double n = 0.01; n < 1000.0; n *= 1.1) {
        const float factor = radius_factor(counts_of(n));
        CHECK(factor <= last * 1.0001f);
        last = factor;
    }
}

TEST_CASE("an even density makes one radius, and noise of the trial is averaged", "[local_radii]") {
    Picture picture = even_picture(5.0);
    for (const PixelRadius& r : radii(picture)) {
        CHECK(r.factor == Approx(std::sqrt(2.0)));
        CHECK(r.material == 0u);
    }
    const std::size_t odd = 7 * width + 11;
    for (std::size_t level = 0; level < count_levels; ++level)
        picture.counts[level * picture.points.size() + odd] = counts_of(20.0)[level];
    const std::vector<PixelRadius> smoothed = radii(picture);
    CHECK(smoothed[picture.points[odd].pixel].factor == Approx(std::exp2(0.5 * 24.0 / 25.0)));
}

TEST_CASE("what differs in material or normal is not averaged", "[local_radii]") {
    Picture picture = even_picture(5.0);
    for (std::size_t i = 0; i < picture.points.size(); ++i) {
        const std::uint32_t x = picture.points[i].pixel % width;
        if (x < 8) continue;
        if (x < 16) picture.points[i].material = 3;
        if (x >= 16) picture.points[i].nz = -1.0f;
        for (std::size_t level = 0; level < count_levels; ++level)
            picture.counts[level * picture.points.size() + i] = counts_of(20.0)[level];
    }
    const std::vector<PixelRadius> result = radii(picture);
    for (std::uint32_t pixel = 0; pixel < width * height; ++pixel) {
        CHECK(double(result[pixel].factor) == Approx(pixel % width < 8 ? std::sqrt(2.0) : 1.0));
        CHECK(result[pixel].material == (pixel % width / 8 == 1 ? 3u : 0u));
    }
}

TEST_CASE("pixels that saw a reflection take their neighbours' radius, those that see nothing have none",
          "[local_radii]") {
    Picture picture = even_picture(5.0);
    GatherPoint& mirrored = picture.points[100];
    mirrored.reflected = 1;
    mirrored.material = 9;
    GatherPoint& missed = picture.points[200];
    missed.maps = 0;
    for (std::size_t level = 0; level < count_levels; ++level)
        picture.counts[level * picture.points.size() + 100] = 1e6f;
    const std::vector<PixelRadius> result = radii(picture);
    CHECK(result[mirrored.pixel].factor == Approx(std::sqrt(2.0)));
    CHECK(result[mirrored.pixel].material == 0u);
    CHECK(result[missed.pixel].factor == 1.0f);
    CHECK(result[missed.pixel].material == STOKES_NONE);
}

TEST_CASE("every factor has its class", "[local_radii]") {
    CHECK(radius_classes({{1.0f, 0}}) == std::vector<float>{1.0f});
    CHECK(radius_classes({{0.5f, 0}, {2.0f, 0}, {4.0f, 0}}) == std::vector<float>{0.5f, 1.0f, 2.0f, 4.0f});
    for (float factor = 0.5f; factor < 4.0f; factor = std::nextafter(factor * 1.05f, 5.0f)) {
        int classes = 0;
        for (const float c : radius_classes({{factor, 0}})) classes += factor > 0.5f * c && factor <= c;
        CHECK(classes == 1);
    }
}
