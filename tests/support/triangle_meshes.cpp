#include "tests/support/triangle_meshes.hpp"

#include <array>
#include <cmath>
#include <map>
#include <random>

#include "host/scene/scene.hpp"

namespace stokes {

bool are_watertight(const std::vector<Mesh>& parts) {
    using Place = std::array<float, 3>;
    std::map<std::pair<Place, Place>, int> edges;
    for (const Mesh& mesh : parts)
        for (const glm::uvec3& t : mesh.triangles)
            for (int k = 0; k < 3; ++k) {
                const glm::vec3 &from = mesh.positions_mm[t[k]], &to = mesh.positions_mm[t[(k + 1) % 3]];
                ++edges[{{from.x, from.y, from.z}, {to.x, to.y, to.z}}];
            }
    for (const auto& [edge, count] : edges)
        if (count != 1 || edges.count({edge.second, edge.first}) == 0) return false;
    return !edges.empty();
}

std::vector<Triangle> triangles_of(const Mesh& mesh, std::uint32_t body) {
    std::vector<Triangle> triangles;
    const std::vector<glm::vec3>& p = mesh.positions_mm;
    for (const glm::uvec3& t : mesh.triangles) triangles.push_back(make_triangle(p[t.x], p[t.y], p[t.z], 0, body));
    return triangles;
}

std::vector<Triangle> sphere_mesh(int rings, int segments, float radius_mm, const glm::vec3& centre_mm,
                                  std::uint32_t body) {
    const auto vertex = [&](int ring, int segment) {
        const double theta = M_PI * ring / rings;
        const double phi = 2.0 * M_PI * (segment % segments) / segments;
        const double s = ring == 0 || ring == rings ? 0.0 : std::sin(theta);
        return centre_mm + radius_mm * glm::vec3(s * std::cos(phi), std::cos(theta), -s * std::sin(phi));
    };
    std::vector<Triangle> triangles;
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < segments; ++j) {
            const glm::vec3 a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
            if (i + 1 < rings) triangles.push_back(make_triangle(a, b, c, 0, body));
            if (i > 0) triangles.push_back(make_triangle(a, c, d, 0, body));
        }
    return triangles;
}

std::vector<Triangle> box_mesh(const glm::vec3& lo, const glm::vec3& hi, std::uint32_t body) {
    const auto corner = [&](int i) { return glm::vec3(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z); };
    const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    std::vector<Triangle> triangles;
    for (const auto& f : faces) {
        triangles.push_back(make_triangle(corner(f[0]), corner(f[1]), corner(f[2]), 0, body));
        triangles.push_back(make_triangle(corner(f[0]), corner(f[2]), corner(f[3]), 0, body));
    }
    return triangles;
}

std::vector<Triangle> triangle_soup(int count, float size_mm, const glm::vec3& stretch, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    const auto point = [&] {
        const float x = unit(random), y = unit(random), z = unit(random);
        return glm::vec3(x, y, z);
    };
    std::vector<Triangle> triangles;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 centre = 100.0f * point();
        glm::vec3 v[3];
        for (glm::vec3& corner : v) corner = centre + size_mm * stretch * (2.0f * point() - 1.0f);
        triangles.push_back(make_triangle(v[0], v[1], v[2]));
    }
    return triangles;
}

std::vector<Triangle> rod_mesh(const glm::vec3& from_mm, const glm::vec3& to_mm, float radius_mm, int sides,
                               std::uint32_t body) {
    const glm::vec3 axis = glm::normalize(to_mm - from_mm);
    const glm::vec3 away = std::fabs(axis.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    const glm::vec3 s = glm::normalize(glm::cross(axis, away)), t = glm::cross(axis, s);
    const auto corner = [&](const glm::vec3& centre, int i) {
        const double angle = 2.0 * M_PI * (i % sides) / sides;
        const glm::vec3 out = static_cast<float>(std::cos(angle)) * s + static_cast<float>(std::sin(angle)) * t;
        return glm::round(1024.0f * (centre + radius_mm * out)) / 1024.0f;
    };
    std::vector<Triangle> triangles;
    for (int i = 0; i < sides; ++i) {
        const glm::vec3 a = corner(from_mm, i), b = corner(from_mm, i + 1);
        const glm::vec3 c = corner(to_mm, i + 1), d = corner(to_mm, i);
        triangles.push_back(make_triangle(a, b, c, 0, body));
        triangles.push_back(make_triangle(a, c, d, 0, body));
        if (i == 0 || i + 1 == sides) continue;
        triangles.push_back(make_triangle(corner(from_mm, 0), b, a, 0, body));
        triangles.push_back(make_triangle(corner(to_mm, 0), d, c, 0, body));
    }
    return triangles;
}

std::vector<Triangle> rod_soup(int count, float radius_mm, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0.0f, 100.0f);
    const auto point = [&] {
        const float x = unit(random), y = unit(random), z = unit(random);
        return glm::vec3(x, y, z);
    };
    std::vector<Triangle> triangles;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 from = point(), to = point();
        append(triangles, rod_mesh(from, to, radius_mm, 6, static_cast<std::uint32_t>(i)));
    }
    return triangles;
}

void append(std::vector<Triangle>& all, const std::vector<Triangle>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

}  // namespace stokes
