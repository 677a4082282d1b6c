// trace_closest and trace_any against a plain double-precision search over all triangles.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "tests/support/catch.hpp"
#include "tests/support/traced_scene.hpp"
#include "tests/support/triangle_meshes.hpp"

using namespace stokes;

namespace {

// Nothing that lies clearly on the segment, and clearly within a triangle, is nearer than the hit; and the
// hit is on the ray and on its triangle. tolerance_mm: rounding of coordinates.
int count_wrong(const std::vector<Triangle>& triangles, const std::vector<Ray>& rays, const std::vector<Hit>& hits,
                double tolerance_mm) {
    int wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Ray& r = rays[i];
        const glm::dvec3 o(r.ox, r.oy, r.oz), d(r.dx, r.dy, r.dz);
        const bool found = hits[i].triangle != STOKES_NONE;
        const double t = found ? hits[i].t : infinity;
        bool good = true;
        for (const Triangle& triangle : triangles) {
            const double nearer = crossing(triangle, o, d, 1e-3);
            if (nearer > r.t_min + tolerance_mm && nearer < r.t_max - tolerance_mm && nearer < t - tolerance_mm)
                good = false;
        }
        if (found) {
            const Triangle& at = triangles.at(hits[i].triangle);
            const glm::dvec3 point = v0_of(at) + double(hits[i].u) * e1_of(at) + double(hits[i].v) * e2_of(at);
            good = good && glm::length(o + t * d - point) < tolerance_mm && hits[i].u >= 0.0f && hits[i].v >= 0.0f &&
                   hits[i].u + hits[i].v <= 1.0f + 1e-6f && hits[i].t >= r.t_min && hits[i].t <= r.t_max;
        }
        wrong += !good;
    }
    return wrong;
}

std::size_t count_hits(const std::vector<Hit>& hits) {
    return static_cast<std::size_t>(
        std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return h.triangle != STOKES_NONE; }));
}

// A fifth of the rays keeps one direction component, another fifth loses two.
void flatten_directions(std::vector<Ray>& rays) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
        glm::vec3 d(rays[i].dx, rays[i].dy, rays[i].dz);
        const auto axis = static_cast<int>(i % 3);
        if (i % 5 == 0) d = glm::vec3(0.0f), d[axis] = i % 2 ? 1.0f : -1.0f;
        if (i % 5 == 1) d[axis] = i % 2 ? 0.0f : -0.0f, d = glm::normalize(d);
        rays[i].dx = d.x, rays[i].dy = d.y, rays[i].dz = d.z;
    }
}

}  // namespace

TEST_CASE("nearest hits agree with a double-precision search over soups, needles and plates") {
    const glm::vec3 shapes[] = {glm::vec3(1.0f), {10.0f, 0.002f, 0.002f}, {5.0f, 5.0f, 1e-5f}};
    for (const glm::vec3& stretch : shapes) {
        Traced scene(triangle_soup(2000, 4.0f, stretch, 11));
        auto rays = random_rays(3000, -20.0f, 120.0f, 12);
        flatten_directions(rays);
        const auto hits = scene.closest(rays);
        CHECK(count_wrong(scene.triangles, rays, hits, 2e-4) == 0);
        if (stretch.y > 0.01f) CHECK(count_hits(hits) > 300);
    }
}

TEST_CASE("rays in and along the planes of boxes find what a double-precision search finds") {
    std::vector<Triangle> boxes;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
            for (int k = 0; k < 3; ++k) {
                const glm::vec3 lo(10.0f * glm::vec3(i, j, k));
                append(boxes, box_mesh(lo, lo + glm::vec3(5.0f, 10.0f, 7.0f)));
            }
    Traced scene(boxes);
    auto rays = random_rays(3000, -5.0f, 65.0f, 13);
    for (Ray& r : rays) r.ox = 5.0f * std::round(r.ox / 5.0f), r.oz = std::round(r.oz);  // on faces and their planes
    flatten_directions(rays);
    const auto hits = scene.closest(rays);
    CHECK(count_wrong(scene.triangles, rays, hits, 1e-4) == 0);
    for (const Hit& hit : hits) CHECK_FALSE((std::isnan(hit.t) || std::isnan(hit.u) || std::isnan(hit.v)));
}

TEST_CASE("segments: nearest and any hit agree, and respect both ends") {
    Traced scene(triangle_soup(3000, 4.0f, glm::vec3(1.0f), 14));
    auto rays = random_rays(20000, -10.0f, 110.0f, 15);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        rays[i].t_min = static_cast<float>(i % 7) * 3.0f - 6.0f;
        rays[i].t_max = rays[i].t_min + static_cast<float>(i % 11) * 6.0f;
    }
    const auto hits = scene.closest(rays);
    const auto occluded = scene.any(rays);
    int differ = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) differ += occluded[i] != (hits[i].triangle != STOKES_NONE ? 1u : 0u);
    CHECK(differ == 0);
    CHECK(count_hits(hits) > 2000);
    rays.resize(2000);
    CHECK(count_wrong(scene.triangles, rays, scene.closest(rays), 2e-4) == 0);
}

TEST_CASE("no ray leaves a closed mesh, not even through edges and vertices") {
    const glm::vec3 centre(3.0f, -7.0f, 31.0f);
    Traced scene(sphere_mesh(48, 96, 10.0f, centre));
    auto rays = random_rays(100000, -3.0f, 3.0f, 16);
    std::mt19937 random(17);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        rays[i].ox += centre.x, rays[i].oy += centre.y, rays[i].oz += centre.z;
        if (i % 2 == 0) continue;
        // Aimed at a point of an edge; every fourth at a vertex.
        const Triangle& t = scene.triangles[random() % scene.triangles.size()];
        const float along = i % 4 == 1 ? 0.0f : static_cast<float>(random() % 1000) / 1000.0f;
        const glm::dvec3 target = v0_of(t) + double(along) * e1_of(t);
        const glm::vec3 d(glm::normalize(target - glm::dvec3(rays[i].ox, rays[i].oy, rays[i].oz)));
        rays[i].dx = d.x, rays[i].dy = d.y, rays[i].dz = d.z;
    }
    const auto hits = scene.closest(rays);
    CHECK(count_hits(hits) == rays.size());
    const auto occluded = scene.any(rays);
    CHECK(std::accumulate(occluded.begin(), occluded.end(), 0u) == rays.size());
}

TEST_CASE("a far camera and a scene far from the origin lose no hits") {
    const glm::vec3 centre(20000.0f, 0.0f, -5000.0f);
    Traced scene(sphere_mesh(40, 80, 50.0f, centre));
    auto rays = random_rays(5000, -20.0f, 20.0f, 18);
    for (Ray& r : rays) {  // from 1e5 mm away to a point within the sphere
        const glm::vec3 target = centre + glm::vec3(r.ox, r.oy, r.oz), d(r.dx, r.dy, r.dz);
        const glm::vec3 origin = target - 1e5f * d;
        r.ox = origin.x, r.oy = origin.y, r.oz = origin.z;
    }
    CHECK(count_hits(scene.closest(rays)) == rays.size());
}

// Directions in single precision end up to 1 mm off at 1e7 mm, so some rays miss; t has the precision of the
// distance, but the point on the triangle that of the scene.
TEST_CASE("rays from very far away meet what a double-precision search meets, closest and any") {
    std::vector<Triangle> triangles = sphere_mesh(16, 32, 7.5f, glm::vec3(40.0f, -20.0f, 5.0f));
    append(triangles, box_mesh(glm::vec3(50.0f, -25.0f, 0.0f), glm::vec3(52.0f, -15.0f, 10.0f)));
    Traced scene(triangles);
    for (const float away : {3e3f, 1e5f, 1e7f, 1e9f, 1e12f}) {
        CAPTURE(away);
        auto rays = random_rays(2000, -9.0f, 9.0f, 25);
        for (Ray& r : rays) {
            r.ox += 42.0f - away * r.dx, r.oy += -20.0f - away * r.dy, r.oz += 5.0f - away * r.dz;
            if (&r < &rays[500]) r.t_max = away + 100.0f;
            if (&r >= &rays[1900]) r.t_max = 0.98f * away - 100.0f;  // ends short of the scene
        }
        const auto hits = scene.closest(rays);
        const auto occluded = scene.any(rays);
        int wrong = 0, undecided = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const glm::dvec3 o(rays[i].ox, rays[i].oy, rays[i].oz), d(rays[i].dx, rays[i].dy, rays[i].dz);
            double nearest = infinity, nearest_grown = infinity;
            for (const Triangle& t : triangles) {
                const double inner = crossing(t, o, d, 1e-3), outer = crossing(t, o, d, -1e-3);
                if (inner < nearest) nearest = inner;
                if (outer < nearest_grown) nearest_grown = outer;
            }
            if (i >= 1900) nearest = nearest_grown = infinity;
            const bool found = hits[i].triangle != STOKES_NONE;
            wrong += occluded[i] != (found ? 1u : 0u);
            if (nearest != nearest_grown) {
                ++undecided;
                continue;
            }
            wrong += found != std::isfinite(nearest);
            if (!found || !std::isfinite(nearest)) continue;
            const Triangle& at = triangles.at(hits[i].triangle);
            const glm::dvec3 point = v0_of(at) + double(hits[i].u) * e1_of(at) + double(hits[i].v) * e2_of(at);
            wrong += glm::length(o + nearest * d - point) > 1e-3;
            wrong += std::fabs(hits[i].t - nearest) > 1e-6 * away;
        }
        CHECK(wrong == 0);
        CHECK(undecided < 60);
        if (away <= 1e7f) CHECK(count_hits(hits) > 700);
    }
}

TEST_CASE("rays whose numbers are not finite, or barely, find nothing and read nothing astray", "[tiny]") {
    const float nan = std::numeric_limits<float>::quiet_NaN(), huge = std::numeric_limits<float>::max();
    Traced scene(triangle_soup(40, 0.05f, glm::vec3(1.0f), 26));  // six blocks: ten slots stay empty
    std::vector<Ray> rays;
    for (const float x : {nan, infinity, huge, 1e30f, 1e20f})
        for (int axes = 1; axes < 8; ++axes) {
            const glm::vec3 odd(axes & 1 ? x : 0.0f, axes & 2 ? x : 0.0f, axes & 4 ? x : 0.0f);
            rays.push_back(make_ray(odd, {0.6f, 0.0f, 0.8f}));
            rays.push_back(make_ray(odd, -glm::normalize(glm::vec3(axes & 1, axes & 2, axes & 4))));
            rays.push_back(make_ray(glm::vec3(-1.0f), odd));
        }
    rays.push_back(make_ray(glm::vec3(-1.0f), glm::vec3(0.0f)));
    CHECK(count_hits(scene.closest(rays)) == 0);
    const auto occluded = scene.any(rays);
    CHECK(std::accumulate(occluded.begin(), occluded.end(), 0u) == 0);
}

TEST_CASE("equal distances go to the lower triangle index, wherever the triangles lie in the hierarchy") {
    const auto once = sphere_mesh(12, 24, 10.0f, glm::vec3(0.0f));
    std::vector<Triangle> thrice = once;
    append(thrice, once);
    append(thrice, once);
    Traced scene(thrice);
    const auto rays = random_rays(5000, -4.0f, 4.0f, 19);
    const auto hits = scene.closest(rays);
    CHECK(same_bits(hits, Traced(once).closest(rays)));
    CHECK(std::all_of(hits.begin(), hits.end(), [&](const Hit& h) { return h.triangle < once.size(); }));
}

TEST_CASE("empty scenes, single triangles, degenerate triangles and untraced rays") {
    const Ray down = make_ray({0.2f, 1.0f, 0.2f}, {0.0f, -1.0f, 0.0f});
    CHECK(Traced({}).closest({down})[0].triangle == STOKES_NONE);
    CHECK(Traced({}).any({down})[0] == 0);

    const Triangle floor = make_triangle({0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f});
    Traced one({floor});
    const Hit hit = one.closest({down})[0];
    CHECK(hit.triangle == 0);
    CHECK(hit.t == 1.0f);
    CHECK(hit.u == Approx(0.2));  // of v1
    CHECK(hit.v == Approx(0.2));  // of v2
    Ray ray = down;
    ray.t_max = 1.0f;
    CHECK(one.closest({ray})[0].triangle == 0);
    ray.t_max = 0.999f;
    CHECK(one.closest({ray})[0].triangle == STOKES_NONE);
    ray.t_max = -1.0f;
    CHECK(one.closest({ray})[0].triangle == STOKES_NONE);
    CHECK(one.any({ray})[0] == 0);
    ray = down, ray.t_min = 1.001f;
    CHECK(one.closest({ray})[0].triangle == STOKES_NONE);
    ray = down, ray.oy = -1.0f, ray.t_min = -1.5f, ray.t_max = 0.0f;
    CHECK(one.closest({ray})[0].t == -1.0f);

    const glm::vec3 p(0.2f, 0.0f, 0.2f);
    std::vector<Triangle> degenerate(20, make_triangle(p, p, p));
    degenerate.push_back(make_triangle(p, p, p + glm::vec3(1.0f, 0.0f, 0.0f)));
    degenerate.push_back(floor);
    CHECK(Traced(degenerate).closest({down})[0].triangle == 21);
}

TEST_CASE("a list traces its rays and leaves the others' hits alone", "[tiny]") {
    Traced scene(triangle_soup(500, 10.0f, glm::vec3(1.0f), 20));
    const auto rays = random_rays(300, 0.0f, 100.0f, 21);
    const std::vector<cl_uint> list{7, 299, 0, 41};
    const Buffer<cl_uint> indices(test_device(), "list", list);
    const Buffer<Ray> in(test_device(), "rays", rays);
    const Hit untouched{-5.0f, -5.0f, -5.0f, 12345u};
    const Buffer<Hit> out(test_device(), "hits", std::vector<Hit>(rays.size(), untouched));
    scene.program.kernel("trace_closest")
        .launch(list.size(), Arguments()
                                 .add("list", indices)
                                 .add("n", static_cast<cl_uint>(list.size()))
                                 .add(scene.arguments())
                                 .add("rays", in)
                                 .add("hits", out));
    std::vector<Hit> expected(rays.size(), untouched);
    const auto all = scene.closest(rays);
    for (const cl_uint i : list) expected[i] = all[i];
    CHECK(same_bits(out.download(), expected));
}

TEST_CASE("the same bits for two work-group sizes") {
    const auto triangles = sphere_mesh(48, 96, 40.0f, glm::vec3(50.0f));
    const auto rays = random_rays(20000, 0.0f, 100.0f, 22);
    Traced scene(triangles);
    const auto hits = scene.closest(rays), packets = scene.packets(rays);
    const std::size_t usual = test_device().local_size();
    test_device().set_local_size(16);
    const auto in_sixteens = scene.closest(rays), packets_in_sixteens = scene.packets(rays);
    test_device().set_local_size(usual);
    CHECK(same_bits(hits, in_sixteens));
    CHECK(same_bits(hits, packets));
    CHECK(same_bits(hits, packets_in_sixteens));
}
