// The radius of the density estimate: where it starts and how it shrinks.
#pragma once

#include <cstdint>
#include <vector>

#include "host/scene/scene.hpp"
#include "kernels/shared/camera.h"
#include "kernels/shared/gather.h"
#include "kernels/shared/photon.h"

namespace stokes {

// Radius [mm] of the pass with this index (from 0): radius[i+1]^2 = radius[i]^2 (i + alpha) / (i + 1), i from 1.
// Knaus and Zwicker, "Progressive photon mapping: a probabilistic approach", ACM TOG 30(3), 2011, eq. 20.
// In closed form, so that passes do not depend on each other. alpha in (0, 1].
double pass_radius_mm(double first_mm, double alpha, std::uint32_t pass);

// First radius [mm] from how thickly a trial pass's photons lie where the camera looks: the picture is cut into square
// tiles, and the median over tiles of photons per surface area [1/mm^2] sets the disk that catches twenty of them.
// points: what the camera rays meet, one a pixel; those in reflections count as the rest of their tile. photons:
// positions in the maps. 0 when no photon lies where the camera looks.
double first_radius_mm(const CameraRecord& camera, const std::vector<GatherPoint>& points,
                       const std::vector<PhotonHead>& photons);

// The first radius when no photon lies where the camera looks: all photons are taken as uniform over the scene's
// surface (or over its bounding sphere, where that is smaller). RunError for a scene without surfaces.
double spread_radius_mm(const Scene& scene, std::int64_t photons);

// The scene's bounding box [mm]; a point at the origin for a scene without shapes.
struct SceneExtent {
    glm::dvec3 minimum{0.0}, maximum{0.0};
    double half_diagonal_mm() const { return 0.5 * glm::length(maximum - minimum); }
};
SceneExtent scene_extent(const Scene& scene);

}  // namespace stokes
