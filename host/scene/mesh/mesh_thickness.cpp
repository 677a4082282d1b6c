#include "host/scene/mesh/mesh_thickness.hpp"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <limits>

#include "host/scene/mesh/mesh.hpp"

namespace stokes {
namespace {

constexpr std::size_t most_lines = 64;
constexpr std::size_t fewest_lines = 16;
constexpr std::size_t most_tests = 64'000'000;  // lines times triangles, of large meshes
constexpr float edge_margin = 1e-5f;            // share of a triangle by which it is taken larger: no gaps between them

struct Corners {
    glm::vec3 a, e1, e2;  // a vertex [mm] from the middle of the body, and the sides from there to the others
    float area() const { return 0.5f * glm::length(glm::cross(e1, e2)); }
};

// Lines inward from the surface; each array's elements side by side, as the compiler's vectors want them.
struct Lines {
    std::size_t count = 0;
    std::array<float, most_lines> ox{}, oy{}, oz{}, dx{}, dy{}, dz{}, length{};
};

struct Body {
    std::vector<Corners> triangles;
    double rounding_mm = 0.0;
};

Body body_of(const Scene& scene, int body) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const Shape& shape : scene.shapes) {
        if (shape.body != body) continue;
        const Bounds bounds = mesh_bounds(shape.mesh);
        low = glm::min(low, bounds.low_mm);
        high = glm::max(high, bounds.high_mm);
    }
    const glm::dvec3 middle = 0.5 * (low + high), farthest = glm::max(glm::abs(low), glm::abs(high));
    Body result;
    result.rounding_mm = 4.0 * FLT_EPSILON * std::max({farthest.x, farthest.y, farthest.z});
    for (const Shape& shape : scene.shapes) {
        if (shape.body != body) continue;
        const auto corner = [&](std::uint32_t i) { return glm::dvec3(shape.mesh.positions_mm[i]) - middle; };
        for (const glm::uvec3& t : shape.mesh.triangles) {
            const glm::dvec3 a = corner(t.x);
            const Corners corners{glm::vec3(a), glm::vec3(corner(t.y) - a), glm::vec3(corner(t.z) - a)};
            if (corners.area() > 0.0f) result.triangles.push_back(corners);
        }
    }
    return result;
}

double fraction(double x) { return x - std::floor(x); }

// From the middles of equal shares of the area, in the order of the triangles; within the triangle by
// Roberts's R2 sequence ("The unreasonable effectiveness of quasirandom sequences", 2018).
Lines lines_into(const std::vector<Corners>& triangles) {
    Lines lines;
    lines.count = std::clamp(most_tests / triangles.size(), fewest_lines, most_lines);
    double total = 0.0, below = 0.0;
    for (const Corners& t : triangles) total += t.area();
    std::size_t k = 0;
    for (const Corners& t : triangles) {
        below += t.area();
        for (; k < lines.count && (static_cast<double>(k) + 0.5) * total < below * static_cast<double>(lines.count);
             ++k) {
            const double root = std::sqrt(fraction(0.5 + 0.7548776662466927 * static_cast<double>(k)));
            const auto u = static_cast<float>(1.0 - root);
            const auto v = static_cast<float>(root * fraction(0.5 + 0.5698402909980532 * static_cast<double>(k)));
            const glm::vec3 o = t.a + u * t.e1 + v * t.e2, d = -glm::normalize(glm::cross(t.e1, t.e2));
            lines.ox[k] = o.x, lines.oy[k] = o.y, lines.oz[k] = o.z;
            lines.dx[k] = d.x, lines.dy[k] = d.y, lines.dz[k] = d.z;
        }
    }
    lines.count = k;
    lines.length.fill(std::numeric_limits<float>::infinity());
    return lines;
}

// Moeller and Trumbore 1997, for triangles that the line leaves through. Shortens lines to where they end.
void cut(Lines& lines, const Corners& t, float nearest) {
    for (std::size_t k = 0; k < lines.count; ++k) {
        const float dx = lines.dx[k], dy = lines.dy[k], dz = lines.dz[k];
        const float px = dz * t.e2.y - dy * t.e2.z, py = dx * t.e2.z - dz * t.e2.x, pz = dy * t.e2.x - dx * t.e2.y;
        const float facing = t.e1.x * px + t.e1.y * py + t.e1.z * pz;  // above 0: seen from within
        const float sx = lines.ox[k] - t.a.x, sy = lines.oy[k] - t.a.y, sz = lines.oz[k] - t.a.z;
        const float u = sx * px + sy * py + sz * pz;
        const float qx = t.e1.y * sz - t.e1.z * sy, qy = t.e1.z * sx - t.e1.x * sz, qz = t.e1.x * sy - t.e1.y * sx;
        const float v = dx * qx + dy * qy + dz * qz;
        const float length = (t.e2.x * qx + t.e2.y * qy + t.e2.z * qz) / facing;
        const float margin = edge_margin * facing;
        const bool hit = (facing > 0.0f) & (u >= -margin) & (v >= -margin) & (u + v <= facing + margin) &
                         (length >= nearest) & (length < lines.length[k]);
        lines.length[k] = hit ? length : lines.length[k];
    }
}

}  // namespace

double median_thickness_mm(const Scene& scene, int body) {
    const Body surface = body_of(scene, body);
    if (surface.triangles.empty()) return std::numeric_limits<double>::infinity();
    Lines lines = lines_into(surface.triangles);
    const auto nearest = static_cast<float>(-surface.rounding_mm);  // two sides back to back
    for (const Corners& triangle : surface.triangles) cut(lines, triangle, nearest);
    const auto middle = lines.length.begin() + (lines.count - 1) / 2;
    std::nth_element(lines.length.begin(), middle, lines.length.begin() + lines.count);
    return std::max(0.0, static_cast<double>(*middle));
}

}  // namespace stokes
