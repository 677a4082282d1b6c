// The camera of a scene file.
#pragma once

#include "host/core/json_cursor.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

// Throws InputError.
Camera read_camera(const JsonCursor& camera);

}  // namespace stokes
