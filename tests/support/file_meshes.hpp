// Meshes of files in their own place.
#pragma once

#include <string>

#include "host/scene/mesh/file_mesh.hpp"
#include "host/scene/mesh/mesh.hpp"
#include "host/scene/readers/mesh_reader.hpp"

namespace stokes {

inline Mesh as_read(const FileMesh& mesh) { return placed_mesh(mesh, glm::dmat4(1.0), false); }

inline void transform_mesh(Mesh& mesh, const glm::dmat4& transform) {
    mesh = placed_mesh(as_file_mesh(mesh), transform, false);
}

}  // namespace stokes
