// The table of the objects of a scene file: a key is declared in one place.
#pragma once

#include <vector>

#include "host/scene/settings/object.hpp"

namespace stokes {

using Objects = std::vector<ObjectDeclaration>;

// All of them.
const Objects& scene_objects();

// Its parts.
Objects material_objects();  // spectra, media, fluorophores too
Objects light_objects();
Objects shape_objects();

}  // namespace stokes
