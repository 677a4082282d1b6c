#include "tests/bench/bench_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "host/scene/readers/mesh_reader.hpp"
#include "tests/support/triangle_meshes.hpp"

namespace stokes::bench {

namespace {

void add_quad(std::vector<Triangle>& all, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
              const glm::vec3& d) {
    all.push_back(make_triangle(a, b, c));
    all.push_back(make_triangle(a, c, d));
}

// The rectangle from corner along u and v, as boards along u.
void add_boards(std::vector<Triangle>& all, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v,
                int boards) {
    for (int i = 0; i < boards; ++i) {
        const glm::vec3 low = corner + v * (static_cast<float>(i) / static_cast<float>(boards));
        const glm::vec3 high = corner + v * (static_cast<float>(i + 1) / static_cast<float>(boards));
        add_quad(all, low, low + u, high + u, high);
    }
}

// An open tube of eight sides.
void add_wire(std::vector<Triangle>& all, const glm::vec3& from, const glm::vec3& to, float radius_mm) {
    constexpr int sides = 8;
    const glm::vec3 axis = glm::normalize(to - from);
    const glm::vec3 away = std::fabs(axis.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    const glm::vec3 s = glm::normalize(glm::cross(axis, away)), t = glm::cross(axis, s);
    const auto corner = [&](int i) {
        const double angle = 2.0 * M_PI * (i % sides) / sides;
        return radius_mm * (static_cast<float>(std::cos(angle)) * s + static_cast<float>(std::sin(angle)) * t);
    };
    for (int i = 0; i < sides; ++i)
        add_quad(all, from + corner(i), from + corner(i + 1), to + corner(i + 1), to + corner(i));
}

}  // namespace

std::vector<Triangle> mesh_triangles(const std::string& file) {
    const Mesh mesh = placed_mesh(read_mesh(file), glm::dmat4(1.0), false);
    glm::vec3 low = mesh.positions_mm.front(), high = low;
    for (const glm::vec3& p : mesh.positions_mm) low = glm::min(low, p), high = glm::max(high, p);
    const glm::vec3 extent = high - low;
    const float scale = 100.0f / std::max({extent.x, extent.y, extent.z});
    std::vector<Triangle> triangles;
    for (const glm::uvec3& t : mesh.triangles)
        triangles.push_back(make_triangle(scale * (mesh.positions_mm[t.x] - low),
                                          scale * (mesh.positions_mm[t.y] - low),
                                          scale * (mesh.positions_mm[t.z] - low)));
    return triangles;
}

std::vector<Triangle> needle_room(int wires) {
    const glm::vec3 size(6000.0f, 3000.0f, 8000.0f);
    const glm::vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z), none(0.0f);
    std::vector<Triangle> all;
    for (const glm::vec3& corner : {none, y}) add_boards(all, corner, z, x, 300);
    for (const glm::vec3& corner : {none, x}) add_boards(all, corner, z, y, 150);
    for (const glm::vec3& corner : {none, z}) add_boards(all, corner, x, y, 150);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    const auto point = [&] {
        const float u = unit(random), v = unit(random), w = unit(random);
        return glm::vec3(u, v, w) * size;
    };
    for (int i = 0; i < wires; ++i) {
        const glm::vec3 from = point();
        glm::vec3 to = point();
        if (i % 3 == 0) {
            const int axis = i / 3 % 3;
            const float along = to[axis];
            to = from;
            to[axis] = along;
        }
        if (glm::length(to - from) < 100.0f) continue;
        add_wire(all, from, to, 2.0f + 6.0f * unit(random));
    }
    return all;
}

std::vector<Triangle> sphere_hall(std::size_t count) {
    const int edge = std::clamp(static_cast<int>(std::cbrt(static_cast<double>(count) / 3000.0)), 2, 8);
    const double each = static_cast<double>(count) / (edge * edge * edge);
    const int rings = std::max(4, static_cast<int>(std::sqrt(each / 4.0)));
    const float cell = 1000.0f / static_cast<float>(edge);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    std::vector<Triangle> all = box_mesh(glm::vec3(0.0f), glm::vec3(1000.0f));
    all.reserve(count + count / 8);
    // One bumpy sphere, set down again and again: larger and smaller, its grid the same.
    const std::vector<Triangle> smooth = sphere_mesh(rings, 2 * rings, 1.0f, glm::vec3(0.0f));
    const auto bumpy = [](const glm::vec3& p) {
        return p * (1.0f + 0.06f * std::sin(9.0f * p.x) * std::sin(11.0f * p.y) * std::sin(7.0f * p.z));
    };
    std::vector<glm::vec3> corners;
    for (const Triangle& t : smooth) {
        const glm::vec3 v0(t.v0x, t.v0y, t.v0z), e1(t.e1x, t.e1y, t.e1z), e2(t.e2x, t.e2y, t.e2z);
        corners.insert(corners.end(), {bumpy(v0), bumpy(v0 + e1), bumpy(v0 + e2)});
    }
    for (int i = 0; i < edge * edge * edge; ++i) {
        const glm::vec3 at(static_cast<float>(i % edge), static_cast<float>(i / edge % edge),
                           static_cast<float>(i / edge / edge));
        const float radius = cell * (0.2f + 0.25f * unit(random));
        const glm::vec3 centre = cell * (at + 0.5f);
        for (std::size_t k = 0; k < corners.size(); k += 3)
            all.push_back(make_triangle(centre + radius * corners[k], centre + radius * corners[k + 1],
                                        centre + radius * corners[k + 2]));
    }
    return all;
}

Box bounds_of(const std::vector<Triangle>& triangles) {
    Box box{glm::vec3(1e30f), glm::vec3(-1e30f)};
    for (const Triangle& t : triangles) {
        const glm::vec3 v0(t.v0x, t.v0y, t.v0z), e1(t.e1x, t.e1y, t.e1z), e2(t.e2x, t.e2y, t.e2z);
        for (const glm::vec3& p : {v0, v0 + e1, v0 + e2})
            box.low = glm::min(box.low, p), box.high = glm::max(box.high, p);
    }
    return box;
}

}  // namespace stokes::bench
