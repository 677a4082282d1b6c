// The materials of a scene as kernels know them.
#pragma once

#include <vector>

#include "host/scene/scene.hpp"
#include "kernels/shared/material.h"

namespace stokes {

// Its surface reflects specularly, with that transport.
bool reflects(const Material& material, Transport transport);

// Its surface may mirror camera rays.
bool may_mirror(const MaterialRecord& record);

// By index of material_uses().
std::vector<MaterialRecord> material_records(const Scene& scene);

}  // namespace stokes
