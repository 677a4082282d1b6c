// Where the scene's coordinates start, so that single precision suffices for what is seen.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "host/scene/mesh/mesh.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

// The place [mm] to subtract from all places of the scene before they are rounded: (0, 0, 0) where the things seen lie
// within some times their size of it, else a place among them. shapes: bounds of each.
//
// Rounding about an origin o moves the parts of a shape by some 6e-8 of their distance from o. That hurts the more the
// smaller the shape is, and the larger it looks: so o is close to the median of the shapes' places by the weight
// (share of the view's height, at most 1)^2 / size, each axis by itself; the camera counts as a shape as large as the
// shape next to it is far. A huge floor or a lamp far away so count for little beside what stands in the picture. The
// place is rounded to multiples of a power of two, 8 to 16 times the median of the sizes and distances from there. So a
// scene about the file's origin stays where it is, and one that is moved by a large power of two gets the same
// coordinates, bit by bit.
glm::dvec3 scene_origin_mm(const Camera& camera, const std::vector<Bounds>& shapes);

}  // namespace stokes
