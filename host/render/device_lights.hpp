// The lights of a scene as kernels know them.
#pragma once

#include <cstdint>
#include <vector>

#include "host/render/emission_bounds.hpp"
#include "host/scene/scene.hpp"
#include "kernels/shared/light.h"
#include "kernels/shared/ray.h"

namespace stokes {

struct LightTables {
    std::vector<LightRecord> records;  // [lights]
    std::vector<float> areas;          // cumulative area of the triangles of each surface light [mm^2]
    // [lights]: flux over it is the radiance of a surface, pi times its area [mm^2 sr], or the irradiance across a
    // beam, the area of its section [mm^2].
    std::vector<double> spread;
};

// Coordinates of a place in the light's cube (lib/lights.clh): 4 of a surface, which emits in many directions, else 2.
unsigned place_dimensions(const Light& light);

// probability: of a photon to start at each light; bounds: where on it; first_triangle: of each shape in triangles, and
// one past the last.
LightTables light_tables(const Scene& scene, const std::vector<double>& probability,
                         const std::vector<EmissionBounds>& bounds, const std::vector<Triangle>& triangles,
                         const std::vector<std::uint32_t>& first_triangle);

}  // namespace stokes
