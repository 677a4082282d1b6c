// How thick a body is.
#pragma once

#include "host/scene/scene.hpp"

namespace stokes {

// The way [mm] from a body's surface along the inward normal to the other side: the median over the area of all shapes
// with this body, from up to 64 places spread over it, always the same ones. Whatever way the body is turned, it is a
// plate's thickness, a ball's diameter, a hollow thing's wall. Infinite where most of these lines meet no other side:
// of flat sheets, and of walls that face inward. O(triangles).
double median_thickness_mm(const Scene& scene, int body);

}  // namespace stokes
