// Whether things stand where the render can follow the light between them.
#pragma once

#include <string>
#include <vector>

#include "host/scene/scene.hpp"

namespace stokes {

// One line for each two things that the render does not take for what they are: bodies within bodies that are taken for
// half-spaces, surfaces that pass through bodies, translucent bodies in one place. InputError for a camera within a
// translucent body, and for a light within one whose transport does not follow light from within, or partly within one.
std::vector<std::string> find_conflicts(const Scene& scene);

}  // namespace stokes
