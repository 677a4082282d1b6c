// Pairs of triangles that are near one another.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/mesh/mesh.hpp"

namespace stokes {

// A triangle and what it is part of.
struct BodyTriangle {
    std::array<glm::dvec3, 3> corners;
    Bounds box;
    glm::dvec3 normal{0.0};  // unit length; zero where it has no area
    int body = 0;
    std::uint32_t index = 0;  // in the order of the scene's shapes
};

// Calls visit(a, b) once for each two triangles of different bodies whose boxes come within the distance. The order of
// the triangles changes. O(n log n + pairs).
void visit_near_pairs(std::vector<BodyTriangle>& triangles, double distance_mm,
                      const std::function<void(const BodyTriangle&, const BodyTriangle&)>& visit);

// Whether two triangles lie within a distance of one plane and overlap in it by more than the distance.
bool share_a_plane(const BodyTriangle& a, const BodyTriangle& b, double distance_mm);

// Whether two triangles pass through one another, each by more than the distance.
bool cross_each_other(const BodyTriangle& a, const BodyTriangle& b, double distance_mm);

// The side of a plane triangle on which another one stands with an edge within it: 1 its front, -1 its back; 0: it does
// not.
int stands_on(const BodyTriangle& a, const BodyTriangle& plane, double distance_mm);

}  // namespace stokes
