#include "host/render/radius.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/core/error.hpp"

namespace stokes {

namespace {

// Enough for a smooth first pass, few enough to keep the shadow edges of a preview.
constexpr double photons_per_disk = 10.0;

double surface_area_mm2(const Mesh& mesh) {
    double area = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions_mm[t.x]), b(mesh.positions_mm[t.y]), c(mesh.positions_mm[t.z]);
        area += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    return area;
}

}  // namespace

double pass_radius_mm(double first_mm, double alpha, std::uint32_t pass) {
    // The product telescopes: prod_{i=1}^{k} (i + alpha)/(i + 1) = Gamma(k+1+alpha) / (Gamma(1+alpha) Gamma(k+2)).
    const double k = pass;
    const double log_square = std::lgamma(k + 1.0 + alpha) - std::lgamma(1.0 + alpha) - std::lgamma(k + 2.0);
    return first_mm * std::exp(0.5 * log_square);
}

double first_radius_mm(const Scene& scene, std::int64_t photons) {
    double area = 0.0;
    for (const Shape& shape : scene.shapes)
        if (shape.light < 0) area += surface_area_mm2(shape.mesh);
    if (area == 0.0)
        for (const Shape& shape : scene.shapes) area += surface_area_mm2(shape.mesh);
    const double extent = scene_extent(scene).half_diagonal_mm();
    area = std::min(area, 4.0 * M_PI * extent * extent);
    if (!(area > 0.0)) throw RunError(scene.file + ": the scene has no surface to store photons on");
    return std::sqrt(photons_per_disk * area / (M_PI * static_cast<double>(std::max<std::int64_t>(photons, 1))));
}

SceneExtent scene_extent(const Scene& scene) {
    SceneExtent extent;
    extent.minimum = glm::dvec3(std::numeric_limits<double>::infinity());
    extent.maximum = -extent.minimum;
    for (const Shape& shape : scene.shapes)
        for (const glm::vec3& p : shape.mesh.positions_mm) {
            extent.minimum = glm::min(extent.minimum, glm::dvec3(p));
            extent.maximum = glm::max(extent.maximum, glm::dvec3(p));
        }
    if (!(extent.minimum.x <= extent.maximum.x)) extent.minimum = extent.maximum = glm::dvec3(0.0);
    return extent;
}

}  // namespace stokes
