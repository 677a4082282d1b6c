// Triangles for tests: one by one, closed spheres, boxes, soups.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/ray.h"

namespace stokes {

struct Mesh;

// A triangle by its corners; the normal is (v1 - v0) x (v2 - v0).
inline Triangle make_triangle(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2, std::uint32_t shape = 0,
                              std::uint32_t body = 0) {
    const glm::vec3 e1 = v1 - v0, e2 = v2 - v0;
    return {v0.x, v0.y, v0.z, shape, e1.x, e1.y, e1.z, body, e2.x, e2.y, e2.z, 0};
}

inline glm::dvec3 v0_of(const Triangle& t) { return {t.v0x, t.v0y, t.v0z}; }
inline glm::dvec3 e1_of(const Triangle& t) { return {t.e1x, t.e1y, t.e1z}; }
inline glm::dvec3 e2_of(const Triangle& t) { return {t.e2x, t.e2y, t.e2z}; }
inline glm::dvec3 normal_of(const Triangle& t) { return glm::normalize(glm::cross(e1_of(t), e2_of(t))); }
inline double area_of(const Triangle& t) { return 0.5 * glm::length(glm::cross(e1_of(t), e2_of(t))); }
inline glm::dvec3 point_on(const Triangle& t, double u, double v) { return v0_of(t) + u * e1_of(t) + v * e2_of(t); }

// Whether every directed edge, by the exact places of its ends, is in all the meshes once, and its reverse once.
bool are_watertight(const std::vector<Mesh>& parts);

std::vector<Triangle> triangles_of(const Mesh& mesh, std::uint32_t body = 0);

// A closed sphere of 2 * segments * (rings - 1) triangles, outward normals; vertices on the axes are exact
// neither in position nor in spacing, so that edges meet rays at all angles.
std::vector<Triangle> sphere_mesh(int rings, int segments, float radius_mm, const glm::vec3& centre_mm,
                                  std::uint32_t body = 0);

// The twelve triangles of an axis-aligned box, outward normals.
std::vector<Triangle> box_mesh(const glm::vec3& lo_mm, const glm::vec3& hi_mm, std::uint32_t body = 0);

// Random triangles with centres in [0, 100]^3 mm, corners up to size_mm away from them on each axis;
// stretch.x, .y, .z multiply that, for needles and plates.
std::vector<Triangle> triangle_soup(int count, float size_mm, const glm::vec3& stretch, std::uint32_t seed);

// A closed prism from one point to another, outward normals. Corners are multiples of 2^-10 mm, so that up to
// 2^13 mm a Triangle keeps them exactly.
std::vector<Triangle> rod_mesh(const glm::vec3& from_mm, const glm::vec3& to_mm, float radius_mm, int sides,
                               std::uint32_t body = 0);

// Six-sided rods between random points of [0, 100]^3 mm, of 20 triangles each; bodies number them.
std::vector<Triangle> rod_soup(int count, float radius_mm, std::uint32_t seed);

void append(std::vector<Triangle>& all, const std::vector<Triangle>& more);

}  // namespace stokes
