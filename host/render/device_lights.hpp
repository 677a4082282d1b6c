// The lights of a scene as kernels know them.
#pragma once

#include <cstdint>
#include <vector>

#include "host/scene/scene.hpp"
#include "kernels/shared/light.h"
#include "kernels/shared/ray.h"

namespace stokes {

struct LightTables {
    std::vector<LightRecord> records;      // [lights]
    std::vector<float> areas;              // cumulative area of the triangles of each surface light [mm^2]
    std::vector<double> surface_area_mm2;  // [lights], 0 for beams
};

// probability: of a photon to start at each light; first_triangle: of each shape in triangles, and one past the last.
LightTables light_tables(const Scene& scene, const std::vector<double>& probability,
                         const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& first_triangle);

}  // namespace stokes
