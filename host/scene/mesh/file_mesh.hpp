// A mesh as its file has it, before it gets a place in a scene.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "host/scene/scene.hpp"

namespace stokes {

struct FileMesh {
    std::vector<glm::dvec3> positions;  // in the file's units
    std::vector<glm::uvec3> triangles;  // as its polygons are turned
    // Of each triangle's corners, v counted from the top of the picture; empty: none.
    std::vector<std::array<glm::dvec2, 3>> uv = {};
    std::string uv_fault = {};  // why the texture coordinates cannot be used; empty: they can, or there are none
    // Which of the materials each triangle has; empty: all the first one.
    std::vector<std::uint32_t> material = {};
    std::vector<std::string> materials = {};  // names of those that have triangles; "" of triangles before any name
    std::size_t objects = 0;                  // named ones that have triangles
    std::size_t groups = 0;                   // those that have triangles; ones that share vertices count once
    std::vector<std::string> remarks = {};    // what is wrong with it, though it can be used: "FILE:LINE: ..."
};

// Some triangles of a mesh that stand for a polygon, as the fan from its first corner.
struct FanOfMesh {
    std::size_t first = 0;   // triangle
    std::size_t count = 0;   // triangles
    std::int64_t place = 0;  // line or number of the polygon, for messages
};

// Cuts the polygons anew where a fan does not cover them. Returns the places of those that cross themselves.
std::vector<std::int64_t> cut_polygons(FileMesh& mesh, const std::vector<FanOfMesh>& fans);

FileMesh as_file_mesh(const Mesh& mesh);

// The mesh brought to its place by an affine transform in double precision, then rounded; one that mirrors also turns
// the triangles over, so that what was outside stays outside. repeats: texture coordinates may be moved by whole
// pictures, to where single precision is finer.
Mesh placed_mesh(const FileMesh& mesh, const glm::dmat4& transform, bool repeats);

}  // namespace stokes
