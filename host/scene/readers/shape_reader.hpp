// Shapes of a scene file.
#pragma once

#include <filesystem>
#include <string>

#include "host/core/json_cursor.hpp"
#include "host/scene/readers/placement.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

// Reads "shapes" into placement, which brings them into the scene; scene.materials are read already. Throws InputError.
void read_shapes(const JsonCursor& shapes, const std::filesystem::path& folder, Scene& scene, Placement& placement);

// The key "name" of a shape or light, or "KIND INDEX" without one; a name in taken is an error.
std::string read_own_name(const JsonCursor& where, const std::string& fallback, const std::vector<std::string>& taken);

}  // namespace stokes
