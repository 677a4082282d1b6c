// The bodies that light goes into.
#pragma once

#include <string>
#include <vector>

#include "host/scene/scene.hpp"

namespace stokes {

// Those with a translucent part, by index, in ascending order.
std::vector<int> translucent_bodies(const Scene& scene);

// Says which of these bodies no photon has met, so that they are black in the picture: a line each, or where they are
// many a line for all.
std::vector<std::string> unmet_body_lines(const Scene& scene, const std::vector<int>& bodies);

}  // namespace stokes
