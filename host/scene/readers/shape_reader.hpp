// Shapes of a scene file.
#pragma once

#include <filesystem>
#include <string>

#include "host/core/json_cursor.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

// Reads "shapes" into scene.shapes, in world space; scene.materials are read already. Throws InputError.
void read_shapes(const JsonCursor& shapes, const std::filesystem::path& folder, Scene& scene);

// Appends a shape moved to its place by transform: drops triangles without area, there or already before,
// with a warning; throws InputError at where when none is left, when a coordinate is not finite or too
// large, or when the material has a texture and the mesh no uv. Returns its index.
int add_shape(const JsonCursor& where, Shape shape, const glm::dmat4& transform, Scene& scene);

// The key "name" of a shape or light, or "KIND INDEX" without one; a name in taken is an error.
std::string read_own_name(const JsonCursor& where, const std::string& fallback, const std::vector<std::string>& taken);

}  // namespace stokes
