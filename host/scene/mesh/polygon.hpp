// Polygons cut into triangles.
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace stokes {

enum class PolygonCut {
    exact,    // the triangles cover the polygon once
    crossing  // the polygon crosses itself: the triangles are a fan from its first corner
};

// Cuts a polygon of three or more corners into its number of corners less two triangles of the same sense, which are
// indices of corners. The polygon may be concave, and bend a little out of its plane: it is seen along the normal of
// its vector area (Newell's). It may touch itself, as an outline joined to its holes by bridges does. A convex polygon
// becomes the fan from its first corner. Repeated corners give triangles without area.
PolygonCut cut_polygon(const std::vector<glm::dvec3>& corners, std::vector<glm::uvec3>& triangles);

}  // namespace stokes
