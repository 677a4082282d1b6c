// Whether a body's meshes enclose a volume, and how much they bend.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/scene.hpp"

namespace stokes {

enum class BodyKind {
    closed,  // every edge has a neighbour: two triangles, or pairs of triangles, pass it in opposite directions
    flat,    // all triangles in one plane, facing the same way: the surface of a half-space
    open
};

struct BodyTopology {
    BodyKind kind = BodyKind::open;
    double area_mm2 = 0.0;
    double volume_mm3 = 0.0;         // closed only: negative when the triangles face inward
    double mean_curvature_mm = 0.0;  // integral of the mean curvature over the surface, convex positive
    std::size_t rim_edges = 0;       // edges without a neighbour
    glm::dvec3 rim_mm{0.0};          // the middle of one of them
};

// The union of the meshes of all shapes with this body. Vertices in the same place are one; at the rim, vertices within
// a few roundings of their coordinates are one too, and an edge may have two or more edges in a row as its neighbour.
// Triangles without area are ignored. The mean curvature of a polyhedron lies in its edges: length times bending angle
// over 2 (Steiner's formula); edges without a neighbour do not bend. O(triangles).
BodyTopology body_topology(const Scene& scene, int body);

// Bodies that model `walk` can walk in: closed and facing outward, or flat. Returns the kind of each body with a
// translucent material and subsurface light, `open` for the others. InputError names file and shape of one that is
// neither.
std::vector<BodyKind> check_walkable(
    const Scene& scene, const std::function<bool(int body)>& wanted = [](int) { return true; });

}  // namespace stokes
