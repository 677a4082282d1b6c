// Rays against long triangles, which the hierarchy keeps in pieces: hits are those of the whole triangles.
#include <cmath>
#include <map>
#include <random>

#include "tests/support/catch.hpp"
#include "tests/support/traced_scene.hpp"
#include "tests/support/triangle_meshes.hpp"

using namespace stokes;

namespace {

constexpr int triangles_per_rod = 20;
constexpr double rounding_mm = 5e-3;  // of places on triangles of 100 mm by 0.7 mm that rays graze

std::size_t count_refs(const Bvh& bvh) {
    std::size_t refs = 0;
    for (const BvhBlock& block : bvh.blocks)
        for (const std::uint32_t triangle : block.triangle) refs += triangle != STOKES_NONE;
    return refs;
}

const BvhLayout layouts[]{
    {16, BvhBounds::counts}, {16, BvhBounds::floats}, {8, BvhBounds::counts}, {8, BvhBounds::floats}};

}  // namespace

TEST_CASE("nearest hits on cut triangles agree with a double-precision search") {
    const auto rods = rod_soup(120, 0.7f, 61);
    const auto rays = random_rays(3000, 0.0f, 100.0f, 62);
    std::vector<double> expected;
    for (const Ray& r : rays) {
        double nearest = infinity;
        for (const Triangle& triangle : rods) {
            const double t = crossing(triangle, {r.ox, r.oy, r.oz}, {r.dx, r.dy, r.dz}, 1e-4);
            if (t > 1e-4 && t < nearest) nearest = t;
        }
        expected.push_back(nearest);
    }
    for (const BvhLayout& layout : layouts) {
        CAPTURE(layout.width, layout.bounds == BvhBounds::floats);
        Traced scene(rods, {}, layout);
        REQUIRE(count_refs(scene.bvh) > 2 * rods.size());
        const auto hits = scene.closest(rays);
        const auto any = scene.any(rays);
        int missed = 0, invented = 0, differ = 0, found = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const bool hit = hits[i].triangle != STOKES_NONE;
            found += hit;
            missed += expected[i] < (hit ? hits[i].t : infinity) - rounding_mm;
            differ += (any[i] != 0) != hit;
            if (!hit) continue;
            const Triangle& at = rods.at(hits[i].triangle);
            const glm::dvec3 o(rays[i].ox, rays[i].oy, rays[i].oz), d(rays[i].dx, rays[i].dy, rays[i].dz);
            const glm::dvec3 point = v0_of(at) + double(hits[i].u) * e1_of(at) + double(hits[i].v) * e2_of(at);
            invented += glm::length(o + double(hits[i].t) * d - point) > rounding_mm;
        }
        CHECK(missed == 0);
        CHECK(invented == 0);
        CHECK(differ == 0);
        CHECK(found > 500);
    }
}

// Rays from the axes of closed rods, every other one to a point on an edge that two triangles share.
TEST_CASE("no ray leaves a rod of cut triangles") {
    const auto rods = rod_soup(120, 0.7f, 63);
    std::mt19937 random(64);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    std::normal_distribution<float> normal;
    std::vector<Ray> rays;
    std::vector<double> own;  // how far the ray's own rod reaches
    for (int i = 0; i < 20000; ++i) {
        const std::size_t rod = random() % (rods.size() / triangles_per_rod) * triangles_per_rod;
        const auto corner = [&](std::size_t triangle, bool far) {
            const Triangle& t = rods[rod + triangle];
            return glm::vec3(v0_of(t) + (far ? e2_of(t) : glm::dvec3(0.0)));
        };
        // The second triangle of a side runs from its first corner, at the start, to its third, at the end.
        glm::vec3 start(0.0f), end(0.0f), from[6], to[6];
        for (std::size_t side = 0, triangle = 0; side < 6; ++side, triangle += side == 1 || side == 6 ? 2 : 4) {
            from[side] = corner(triangle + 1, false), to[side] = corner(triangle + 1, true);
            start += from[side] / 6.0f, end += to[side] / 6.0f;
        }
        const glm::vec3 origin = glm::mix(start, end, 0.02f + 0.96f * unit(random));
        const float gx = normal(random), gy = normal(random), gz = normal(random);
        const float along = unit(random);
        const std::size_t side = random() % 6;
        const glm::vec3 target = i % 2 ? glm::mix(from[side], to[side], along) : origin + glm::vec3(gx, gy, gz);
        rays.push_back(make_ray(origin, glm::normalize(target - origin)));
        const glm::dvec3 o(origin), d(rays.back().dx, rays.back().dy, rays.back().dz);
        double reach = 0.0;
        for (std::size_t k = 0; k < triangles_per_rod; ++k) {
            const double t = crossing(rods[rod + k], o, d, -1e-4);
            if (t > reach) reach = t;
        }
        own.push_back(reach > 0.0 ? reach : infinity);
    }
    for (const BvhLayout& layout : layouts)
        for (const auto& shape : {std::vector<std::string>{}, {"-DSTOKES_BVH_SCALAR"}}) {
            CAPTURE(layout.width, layout.bounds == BvhBounds::floats, shape);
            Traced scene(rods, shape, layout);
            const auto hits = scene.closest(rays);
            int lost = 0;
            for (std::size_t i = 0; i < rays.size(); ++i)
                lost += hits[i].triangle == STOKES_NONE || hits[i].t > own[i] + 0.01;
            CHECK(lost == 0);
        }
}
