#include "tests/bench/hit_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

namespace stokes::bench {

namespace {

constexpr double rounding = 4e-6;
constexpr double infinity = std::numeric_limits<double>::infinity();

// Where a line crosses a triangle's plane. Edge functions, products of distances of corners from the ray, are rounded
// in single precision: where a triangle is thin beside its distance from the ray's start, that moves the crossing.
struct Crossing {
    double t = infinity;
    bool inside = false, surely_hit = false, surely_missed = false;  // surely: beyond the rounding of edge functions
    double doubt = infinity;                                         // of t, without edge functions [mm]
    double edge_doubt = infinity;  // of t interpolated with edge functions, doubt included [mm]
};

// Corners as they are in single precision.
std::array<glm::dvec3, 3> corners_of(const Triangle& t) {
    return {glm::dvec3(t.v0x, t.v0y, t.v0z), glm::dvec3(t.v0x + t.e1x, t.v0y + t.e1y, t.v0z + t.e1z),
            glm::dvec3(t.v0x + t.e2x, t.v0y + t.e2y, t.v0z + t.e2z)};
}

double largest(const glm::dvec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

Crossing cross_triangle(const Triangle& triangle, const Ray& ray) {
    const auto corner = corners_of(triangle);
    const glm::dvec3 o(ray.ox, ray.oy, ray.oz), d(ray.dx, ray.dy, ray.dz);
    const glm::dvec3 n = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double length = glm::length(n), facing = glm::dot(d, n) / length;
    Crossing result;
    if (!(length > 0.0) || std::fabs(facing) < 1e-7) return result;
    result.t = glm::dot(corner[0] - o, n) / length / facing;
    const glm::dvec3 at = o + result.t * d;
    double away = 0.0, longest = 0.0;  // of the corners from the ray's start; edge [mm]
    for (std::size_t i = 0; i < 3; ++i) {
        away = std::max(away, glm::length(corner[i] - o));
        longest = std::max(longest, glm::length(corner[(i + 1) % 3] - corner[i]));
    }
    const double scale =
        std::max({largest(o), largest(corner[0]), largest(corner[1]), largest(corner[2]), std::fabs(result.t)});
    const double product_error = 0x1p-22 * away * away / std::fabs(facing);
    result.doubt = rounding * scale / std::fabs(facing);
    result.edge_doubt = result.doubt + product_error / length * longest;
    result.inside = result.surely_hit = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 edge = corner[(i + 1) % 3] - corner[i];
        const double distance = glm::dot(at - corner[i], glm::cross(n, edge) / length) / glm::length(edge);
        const double doubt = result.doubt + product_error / glm::length(edge);
        result.inside = result.inside && distance >= 0.0;
        result.surely_hit = result.surely_hit && distance > doubt;
        result.surely_missed = result.surely_missed || distance < -doubt;
    }
    return result;
}

bool found(const Hit& hit) { return hit.triangle != STOKES_NONE; }

// Whether the hit cannot be, or is none or farther where the other surely is one.
bool refuted(const std::vector<Triangle>& triangles, const Ray& ray, const Hit& hit, const Hit& other) {
    double t = ray.t_max, doubt = 0.0;
    if (found(hit)) {
        const Crossing at = cross_triangle(triangles.at(hit.triangle), ray);
        if (at.surely_missed || std::fabs(at.t - hit.t) > 2.0 * at.edge_doubt) return true;
        t = hit.t;
        doubt = 2.0 * at.edge_doubt;
    }
    if (!found(other) || other.triangle == hit.triangle) return false;
    const Crossing at = cross_triangle(triangles.at(other.triangle), ray);
    return at.surely_hit && at.t - at.doubt > ray.t_min && at.t + at.doubt < t - doubt;
}

bool inexact(const std::vector<Triangle>& triangles, const Ray& ray, const Hit& hit) {
    if (!found(hit)) return false;
    const Crossing at = cross_triangle(triangles.at(hit.triangle), ray);
    return std::fabs(at.t - hit.t) > 2.0 * at.doubt;
}

}  // namespace

HitCount check_hits(const std::vector<Triangle>& triangles, const std::vector<Ray>& rays, const std::vector<Hit>& hits,
                    const std::vector<Hit>& reference) {
    HitCount count;
    count.rays = reference.size();
    for (std::size_t i = 0; i < reference.size(); ++i) {
        const Hit &hit = hits[i], &other = reference[i];
        count.hits += found(hit);
        count.differ += found(hit) != found(other) ||
                        (found(hit) && std::fabs(hit.t - other.t) > 1e-4f * std::max(std::fabs(other.t), 1.0f));
        count.wrong += refuted(triangles, rays[i], hit, other);
        count.inexact += inexact(triangles, rays[i], hit);
        count.reference_wrong += refuted(triangles, rays[i], other, hit);
        count.reference_inexact += inexact(triangles, rays[i], other);
    }
    return count;
}

std::vector<Hit> search_all(const std::vector<Triangle>& triangles, const std::vector<Ray>& rays, std::size_t count) {
    std::vector<Hit> hits;
    for (std::size_t i = 0; i < std::min(count, rays.size()); ++i) {
        Hit best{rays[i].t_max, 0.0f, 0.0f, STOKES_NONE};
        double nearest = rays[i].t_max;
        for (std::size_t k = 0; k < triangles.size(); ++k) {
            const Crossing at = cross_triangle(triangles[k], rays[i]);
            if (!(at.inside && at.t >= rays[i].t_min && at.t < nearest)) continue;
            nearest = at.t;
            best = {static_cast<float>(at.t), 0.0f, 0.0f, static_cast<std::uint32_t>(k)};
        }
        hits.push_back(best);
    }
    return hits;
}

}  // namespace stokes::bench
