#include "host/scene/mesh/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stokes {
namespace {

// Corner k of n on a circle about the y axis, counter-clockwise seen from above.
glm::vec3 on_circle(int k, int n, double radius, double y) {
    const double angle = 2.0 * M_PI * k / n;
    return glm::vec3(glm::dvec3(radius * std::cos(angle), y, -radius * std::sin(angle)));
}

std::uint32_t add_circle(Mesh& mesh, int n, double radius, double y) {
    const auto first = static_cast<std::uint32_t>(mesh.positions_mm.size());
    for (int k = 0; k < n; ++k) mesh.positions_mm.push_back(on_circle(k, n, radius, y));
    return first;
}

std::uint32_t add_point(Mesh& mesh, double y) {
    mesh.positions_mm.push_back(glm::vec3(glm::dvec3(0.0, y, 0.0)));
    return static_cast<std::uint32_t>(mesh.positions_mm.size()) - 1;
}

// Triangles between a point on the axis and a circle of n vertices, facing up or down.
void add_fan(Mesh& mesh, std::uint32_t apex, std::uint32_t circle, std::uint32_t n, bool up) {
    for (std::uint32_t k = 0; k < n; ++k) {
        const std::uint32_t a = circle + k;
        const std::uint32_t b = circle + (k + 1) % n;
        mesh.triangles.push_back(up ? glm::uvec3(apex, a, b) : glm::uvec3(apex, b, a));
    }
}

// Triangles between two circles of n vertices each, facing away from the axis.
void add_band(Mesh& mesh, std::uint32_t lower, std::uint32_t upper, std::uint32_t n) {
    for (std::uint32_t k = 0; k < n; ++k) {
        const std::uint32_t next = (k + 1) % n;
        mesh.triangles.push_back({lower + k, lower + next, upper + next});
        mesh.triangles.push_back({lower + k, upper + next, upper + k});
    }
}

// Four corners, counter-clockwise seen from outside.
void add_quad(Mesh& mesh, const std::array<glm::vec3, 4>& corners) {
    const auto first = static_cast<std::uint32_t>(mesh.positions_mm.size());
    mesh.positions_mm.insert(mesh.positions_mm.end(), corners.begin(), corners.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
}

void add_triangle(Mesh& mesh, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const auto first = static_cast<std::uint32_t>(mesh.positions_mm.size());
    mesh.positions_mm.insert(mesh.positions_mm.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
}

}  // namespace

Mesh make_box(const glm::dvec3& size_mm) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 sign(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
        mesh.positions_mm.push_back(glm::vec3(sign * size_mm));
    }
    const auto add_face = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    };
    add_face(0, 4, 6, 2);  // -x
    add_face(1, 3, 7, 5);  // +x
    add_face(0, 1, 5, 4);  // -y
    add_face(2, 6, 7, 3);  // +y
    add_face(0, 2, 3, 1);  // -z
    add_face(4, 5, 7, 6);  // +z
    return mesh;
}

Mesh make_sphere(double radius_mm, int segments) {
    Mesh mesh;
    const int rings = segments / 2;
    const auto n = static_cast<std::uint32_t>(segments);
    const std::uint32_t bottom = add_point(mesh, -radius_mm);
    std::uint32_t below = 0;
    for (int ring = 1; ring < rings; ++ring) {
        const double angle = M_PI * ring / rings;
        const std::uint32_t circle =
            add_circle(mesh, segments, radius_mm * std::sin(angle), -radius_mm * std::cos(angle));
        if (ring == 1) {
            add_fan(mesh, bottom, circle, n, false);
        } else {
            add_band(mesh, below, circle, n);
        }
        below = circle;
    }
    add_fan(mesh, add_point(mesh, radius_mm), below, n, true);
    return mesh;
}

Mesh make_rectangle(double width_mm, double height_mm) {
    const auto w = static_cast<float>(0.5 * width_mm);
    const auto h = static_cast<float>(0.5 * height_mm);
    const glm::vec2 uv[4] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    return {{{-w, 0, -h}, {-w, 0, h}, {w, 0, h}, {w, 0, -h}},
            {{0, 1, 2}, {0, 2, 3}},
            {{uv[0], uv[1], uv[2]}, {uv[0], uv[2], uv[3]}}};
}

Mesh make_disk(double radius_mm, int segments) {
    Mesh mesh;
    const std::uint32_t centre = add_point(mesh, 0.0);
    const std::uint32_t edge = add_circle(mesh, segments, radius_mm, 0.0);
    add_fan(mesh, centre, edge, static_cast<std::uint32_t>(segments), true);
    const auto scale = static_cast<float>(0.5 / radius_mm);
    const auto uv = [&](std::uint32_t i) {
        return glm::vec2(mesh.positions_mm[i].x, mesh.positions_mm[i].z) * scale + 0.5f;
    };
    for (const glm::uvec3& t : mesh.triangles) mesh.uv.push_back({uv(t.x), uv(t.y), uv(t.z)});
    return mesh;
}

Mesh make_prism(int sides, double radius_mm, double height_mm) {
    Mesh mesh;
    const auto n = static_cast<std::uint32_t>(sides);
    const std::uint32_t lower = add_circle(mesh, sides, radius_mm, 0.0);
    const std::uint32_t upper = add_circle(mesh, sides, radius_mm, height_mm);
    add_band(mesh, lower, upper, n);
    add_fan(mesh, add_point(mesh, 0.0), lower, n, false);
    add_fan(mesh, add_point(mesh, height_mm), upper, n, true);
    return mesh;
}

Mesh make_cylinder(double radius_mm, double height_mm, int segments) {
    return make_prism(segments, radius_mm, height_mm);
}

std::vector<Mesh> make_tiles(const glm::dvec3& size_mm, int columns, int rows, int parts) {
    const glm::dvec3 counts(columns, 1, rows);
    const auto corner = [&](const glm::ivec3& c) {
        return glm::vec3(size_mm * (glm::dvec3(c) / counts - glm::dvec3(0.5)));
    };
    std::vector<Mesh> meshes(static_cast<std::size_t>(parts));
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            Mesh& mesh = meshes[static_cast<std::size_t>((i + j) % parts)];
            const auto add_face = [&](const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c,
                                      const glm::ivec3& d) {
                add_quad(mesh, {corner(a), corner(b), corner(c), corner(d)});
            };
            const int k = i + 1, l = j + 1;
            add_face({i, 1, j}, {i, 1, l}, {k, 1, l}, {k, 1, j});
            add_face({i, 0, j}, {k, 0, j}, {k, 0, l}, {i, 0, l});
            if (i == 0) add_face({i, 0, j}, {i, 0, l}, {i, 1, l}, {i, 1, j});
            if (k == columns) add_face({k, 0, j}, {k, 1, j}, {k, 1, l}, {k, 0, l});
            if (j == 0) add_face({i, 0, j}, {i, 1, j}, {k, 1, j}, {k, 0, j});
            if (l == rows) add_face({i, 0, l}, {k, 0, l}, {k, 1, l}, {i, 1, l});
        }
    return meshes;
}

std::vector<Mesh> make_sectors(double radius_mm, double height_mm, int sectors, int segments, double start_deg) {
    const int per_sector = (std::max(segments, 3) + sectors - 1) / sectors, n = per_sector * sectors;
    const double start = glm::radians(start_deg);
    const auto rim = [&](int k, double y) {
        const double angle = start + 2.0 * M_PI * (k % n) / n;
        return glm::vec3(glm::dvec3(radius_mm * std::cos(angle), y, -radius_mm * std::sin(angle)));
    };
    const glm::vec3 top(glm::dvec3(0.0, height_mm, 0.0)), bottom(0.0f);
    std::vector<Mesh> meshes(static_cast<std::size_t>(sectors));
    for (int k = 0; k < n; ++k) {
        Mesh& mesh = meshes[static_cast<std::size_t>(k / per_sector)];
        const glm::vec3 a = rim(k, 0.0), b = rim(k + 1, 0.0), c = rim(k + 1, height_mm), d = rim(k, height_mm);
        add_quad(mesh, {a, b, c, d});
        add_triangle(mesh, bottom, b, a);
        add_triangle(mesh, top, d, c);
    }
    return meshes;
}

}  // namespace stokes
