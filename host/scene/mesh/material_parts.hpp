// A mesh of several materials, taken apart.
#pragma once

#include <cstddef>
#include <vector>

#include "host/scene/mesh/file_mesh.hpp"

namespace stokes {

// The triangles of each part, part_of_material[i] being that of mesh.materials[i]; every part has some.
std::vector<FileMesh> split_mesh(const FileMesh& mesh, const std::vector<std::size_t>& part_of_material,
                                 std::size_t parts);

// Which parts are surfaces of one body: those that are open and meet at edges where each one ends. Parts that are
// closed by themselves stay by themselves, also where they touch. Returns for each part the first one of its body.
// may_join: of each part.
std::vector<std::size_t> joined_parts(const std::vector<FileMesh>& parts, const std::vector<bool>& may_join);

}  // namespace stokes
