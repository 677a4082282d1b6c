// The materials of a scene as kernels know them.
#pragma once

#include <vector>

#include "host/scene/scene.hpp"
#include "kernels/shared/material.h"

namespace stokes {

// Light goes below its surface.
bool has_subsurface(const Material& material);

// Its surface reflects specularly, with the scene's transport.
bool reflects(const Scene& scene, const Material& material);

// [materials]
std::vector<MaterialRecord> material_records(const Scene& scene);

}  // namespace stokes
