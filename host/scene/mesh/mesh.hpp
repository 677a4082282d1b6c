// What can be done with a triangle mesh: measure it, move it, clean it.
#pragma once

#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/scene.hpp"

namespace stokes {

struct Bounds {
    glm::dvec3 low_mm{INFINITY};  // empty until something is added
    glm::dvec3 high_mm{-INFINITY};

    void add(const glm::dvec3& p) {
        low_mm = glm::min(low_mm, p);
        high_mm = glm::max(high_mm, p);
    }
    void add(const Bounds& other) {
        low_mm = glm::min(low_mm, other.low_mm);
        high_mm = glm::max(high_mm, other.high_mm);
    }
    // Whether two come within a distance of one another; negative: whether they overlap by more than that.
    bool meets(const Bounds& other, double distance_mm) const {
        return glm::all(glm::lessThanEqual(low_mm - distance_mm, other.high_mm)) &&
               glm::all(glm::lessThanEqual(other.low_mm - distance_mm, high_mm));
    }
};

// Of the vertices.
Bounds mesh_bounds(const Mesh& mesh);
// A triangle's area times its normal [mm^2].
inline glm::dvec3 area_vector_mm2(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return 0.5 * glm::cross(b - a, c - a);
}
glm::dvec3 area_vector_mm2(const Mesh& mesh, const glm::uvec3& triangle);
// Total area of the triangles [mm^2], one side.
double mesh_area_mm2(const Mesh& mesh);
// Volume inside a closed mesh [mm^3]; negative when its triangles face inward.
double mesh_volume_mm3(const Mesh& mesh);

// Turns the triangles over: the front becomes the back.
void turn_over(Mesh& mesh);

// Triangles whose normal could not be found in single precision though the mesh lay about the origin.
std::size_t count_flat_triangles(const std::vector<glm::dvec3>& positions, const std::vector<glm::uvec3>& triangles);

// Drops the triangles whose normal cannot be found in single precision, and the vertices that no triangle
// uses. Returns the number of triangles dropped.
std::size_t drop_degenerate_triangles(Mesh& mesh);

}  // namespace stokes
