// The camera of a scene file.
#pragma once

#include "host/scene/json_cursor.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

// Throws InputError.
Camera read_camera(const JsonCursor& camera);

}  // namespace stokes
