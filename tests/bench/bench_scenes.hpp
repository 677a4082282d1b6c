// Triangles to cast rays at.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "kernels/shared/ray.h"

namespace stokes::bench {

// The triangles of a mesh file, its longest edge scaled to 100 mm.
std::vector<Triangle> mesh_triangles(const std::string& file);

// A room of 6 x 3 x 8 m whose walls, floor and ceiling are boards and which is full of thin straight wires, a third of
// them along an axis, the others across the room: triangles some hundred times as long as wide.
std::vector<Triangle> needle_room(int wires);

// About count triangles, at least some thousands: bumpy closed spheres of different size, in a box of 1 m.
std::vector<Triangle> sphere_hall(std::size_t count);

struct Box {
    glm::vec3 low, high;
};
Box bounds_of(const std::vector<Triangle>& triangles);

}  // namespace stokes::bench
