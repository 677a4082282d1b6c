// Which side of the shapes the camera sees.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/scene/scene.hpp"

namespace stokes {

// Camera rays that meet a shape from each side.
struct SeenSides {
    std::uint32_t front = 0, back = 0;
};

// Says of which shapes the camera sees their black backs, where these are a fifth or more of what it sees of them; the
// most seen first, a line each, and where they are many a line for the rest. Two-sided and black shapes look alike from
// both sides, and lamps shine from their front: these have none. sides: of each shape.
std::vector<std::string> black_back_lines(const Scene& scene, const std::vector<SeenSides>& sides);

}  // namespace stokes
