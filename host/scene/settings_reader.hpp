// How a scene file wants to be rendered and seen. All throw InputError.
#pragma once

#include "host/core/json_cursor.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

RenderSettings read_render_settings(const JsonCursor& render);
Film read_film(const JsonCursor& film);
Camera read_camera(const JsonCursor& camera);

}  // namespace stokes
