// Meshes of the simple shapes, in their own coordinates: y is up, triangles counter-clockwise seen from
// outside.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "host/scene/scene.hpp"

namespace stokes {

// Segments of round shapes, where the scene does not say.
inline constexpr int default_segments = 128;

// Centred on the origin.
Mesh make_box(const glm::dvec3& size_mm);

// Poles on the y axis; segments >= 4 around the equator, half as many (rounded down) from pole to pole. The
// vertices lie on the sphere, so that area and volume are a little below the sphere's.
Mesh make_sphere(double radius_mm, int segments = default_segments);

// In the plane y = 0, facing +y: width along x, height along z. Rectangles and disks have (u, v) from (0, 0)
// at the least x and z to (1, 1) at the largest.
Mesh make_rectangle(double width_mm, double height_mm);

// In the plane y = 0, facing +y; segments >= 3 around the edge.
Mesh make_disk(double radius_mm, int segments = default_segments);

// Upright, base in the plane y = 0, with sides >= 3; radius to the corners, the first of which lies on the +x
// axis.
Mesh make_prism(int sides, double radius_mm, double height_mm);

// A prism of many sides.
Mesh make_cylinder(double radius_mm, double height_mm, int segments = default_segments);

// The surface of a slab in parts, without walls inside: together they are closed, corners that parts share
// are the same bit for bit, and no corner lies within another part's edge. Tiles: a box centred on the
// origin, columns along x from -x on and rows along z from -z on; part k has the tiles (column i, row j) with
// (i + j) mod parts = k; 1 <= parts < columns + rows.
std::vector<Mesh> make_tiles(const glm::dvec3& size_mm, int columns, int rows, int parts);

// Sectors: a cylinder upright on the plane y = 0 cut into equal sectors, counter-clockwise seen from above,
// the first from start_deg on, measured from +x. segments: around the whole edge, rounded up to a multiple of
// sectors, at least 3.
std::vector<Mesh> make_sectors(double radius_mm, double height_mm, int sectors, int segments, double start_deg);

}  // namespace stokes
