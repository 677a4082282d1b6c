// Bodies that touch, lie within one another or cross, and surfaces that lie in one place.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "host/scene/mesh/triangle_pairs.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

struct Contacts {
    // By body.
    std::vector<bool> touches;                 // a triangle of another body is as near as the distance, or may be
    std::vector<std::vector<Bounds>> regions;  // [mm] together hold the places of those that touch where that is so
    std::vector<bool> solid;  // of those that touch, cross or may hold something: the surface is closed
    std::vector<bool> holds;  // a solid one with a medium: surfaces of other bodies may lie within it
    // By triangle, in the order of the scene's shapes: one of another body may lie in its plane.
    std::vector<bool> contested;

    using Pair = std::pair<int, int>;  // of bodies, the first with a medium
    std::vector<Pair> coincide;  // both have a medium, and parts of their surfaces lie in one place, facing one way
    std::vector<Pair> cross;     // surfaces of the two pass through one another, deeper than the distance
    bool any_touch = false, any_contested = false;
};

// distance_mm: as far as rays start off a surface. O(n log n) in the triangles that lie where boxes of bodies overlap.
Contacts find_contacts(const Scene& scene, double distance_mm);

// How much of a thing lies within a solid body.
enum class Within { no, partly, wholly };

// Of points [mm], by the winding number of the body's triangles; those on its surface count for nothing. With many
// points, some of them stand for all.
Within within_body(const Scene& scene, int body, const std::vector<glm::dvec3>& points);

// The solid body with a medium within which a body, a light or the camera wholly lies, the smallest; or none. partly:
// one that it lies within in part, if there is one.
struct Container {
    std::optional<int> whole, part;
};
Container container_of_body(const Scene& scene, int body);
Container container_of_light(const Scene& scene, const Light& light);
Container container_of_camera(const Scene& scene);

}  // namespace stokes
