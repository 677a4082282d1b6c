#include "host/scene/mesh/mesh.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

namespace stokes {
namespace {

constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();

glm::dvec3 corner(const Mesh& mesh, std::uint32_t index) { return glm::dvec3(mesh.positions_mm[index]); }

// Without a height beyond the rounding of its coordinates, or so small that the normal underflows.
bool is_degenerate(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 farthest = glm::max(glm::max(glm::abs(a), glm::abs(b)), glm::abs(c));
    const double rounding = FLT_EPSILON * std::max({farthest.x, farthest.y, farthest.z});
    const double longest =
        std::sqrt(std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)}));
    const double length = 2.0 * glm::length(area_vector_mm2(a, b, c));
    return !(length > rounding * longest && length * length >= FLT_MIN);
}

bool is_degenerate(const Mesh& mesh, const glm::uvec3& t) {
    return is_degenerate(corner(mesh, t.x), corner(mesh, t.y), corner(mesh, t.z));
}

void drop_unused_vertices(Mesh& mesh) {
    std::vector<std::uint32_t> moved(mesh.positions_mm.size(), unused);
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int k = 0; k < 3; ++k) moved[triangle[k]] = 0;
    }
    if (std::find(moved.begin(), moved.end(), unused) == moved.end()) return;
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < moved.size(); ++i) {
        if (moved[i] == unused) continue;
        moved[i] = kept;
        mesh.positions_mm[kept++] = mesh.positions_mm[i];
    }
    mesh.positions_mm.resize(kept);
    for (glm::uvec3& triangle : mesh.triangles) {
        triangle = {moved[triangle.x], moved[triangle.y], moved[triangle.z]};
    }
}

}  // namespace

Bounds mesh_bounds(const Mesh& mesh) {
    Bounds bounds;
    for (const glm::vec3& p : mesh.positions_mm) bounds.add(glm::dvec3(p));
    return bounds;
}

glm::dvec3 area_vector_mm2(const Mesh& mesh, const glm::uvec3& t) {
    return area_vector_mm2(corner(mesh, t.x), corner(mesh, t.y), corner(mesh, t.z));
}

double mesh_area_mm2(const Mesh& mesh) {
    double sum = 0.0;
    for (const glm::uvec3& t : mesh.triangles) sum += glm::length(area_vector_mm2(mesh, t));
    return sum;
}

double mesh_volume_mm3(const Mesh& mesh) {
    if (mesh.triangles.empty()) return 0.0;
    // Measured from a point of the mesh: far from the origin the terms would cancel badly.
    const glm::dvec3 apex = corner(mesh, mesh.triangles.front().x);
    double sum = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = corner(mesh, t.x) - apex;
        const glm::dvec3 b = corner(mesh, t.y) - apex;
        const glm::dvec3 c = corner(mesh, t.z) - apex;
        sum += glm::dot(a, glm::cross(b, c)) / 6.0;
    }
    return sum;
}

void turn_over(Mesh& mesh) {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    for (auto& uv : mesh.uv) std::swap(uv[1], uv[2]);
}

std::size_t count_flat_triangles(const std::vector<glm::dvec3>& positions, const std::vector<glm::uvec3>& triangles) {
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const glm::dvec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 middle = 0.5 * (low + high);
    return static_cast<std::size_t>(std::count_if(triangles.begin(), triangles.end(), [&](const glm::uvec3& t) {
        return is_degenerate(positions[t.x] - middle, positions[t.y] - middle, positions[t.z] - middle);
    }));
}

std::size_t drop_degenerate_triangles(Mesh& mesh) {
    const std::size_t before = mesh.triangles.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < before; ++i) {
        if (is_degenerate(mesh, mesh.triangles[i])) continue;
        mesh.triangles[kept] = mesh.triangles[i];
        if (!mesh.uv.empty()) mesh.uv[kept] = mesh.uv[i];
        ++kept;
    }
    mesh.triangles.resize(kept);
    if (!mesh.uv.empty()) mesh.uv.resize(kept);
    drop_unused_vertices(mesh);
    return before - kept;
}

}  // namespace stokes
