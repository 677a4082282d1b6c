// Triangles for tests: closed spheres, boxes, soups.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/ray.h"

namespace stokes {

Triangle make_triangle(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2, std::uint32_t body = 0);

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
