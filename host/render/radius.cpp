#include "host/render/radius.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/core/error.hpp"
#include "host/scene/mesh/mesh.hpp"

namespace stokes {

namespace {

// Smooth enough for a preview of some dozen passes, and small beside what a picture shows.
constexpr double photons_per_disk = 20.0;

// Edge of the tiles in which photons are counted [pixels].
constexpr std::uint32_t tile_edge = 16;

}  // namespace

double pass_radius_mm(double first_mm, double alpha, std::uint32_t pass) {
    // The product telescopes: prod_{i=1}^{k} (i + alpha)/(i + 1) = Gamma(k+1+alpha) / (Gamma(1+alpha) Gamma(k+2)).
    const double k = pass;
    const double log_square = std::lgamma(k + 1.0 + alpha) - std::lgamma(1.0 + alpha) - std::lgamma(k + 2.0);
    return first_mm * std::exp(0.5 * log_square);
}

double first_radius_mm(const CameraRecord& camera, const std::vector<GatherPoint>& points,
                       const std::vector<PhotonHead>& photons) {
    const std::uint32_t columns = (camera.width + tile_edge - 1) / tile_edge;
    const std::uint32_t rows = (camera.height + tile_edge - 1) / tile_edge;
    std::vector<double> area(std::size_t{columns} * rows, 0.0), count(area.size(), 0.0);
    std::vector<double> direct(area.size(), 0.0), reflected(area.size(), 0.0);  // points
    const glm::dvec3 eye(camera.position_x, camera.position_y, camera.position_z);
    const glm::dvec3 corner(camera.corner_x, camera.corner_y, camera.corner_z);
    const glm::dvec3 right(camera.right_x, camera.right_y, camera.right_z);
    const glm::dvec3 down(camera.down_x, camera.down_y, camera.down_z);
    const glm::dvec3 axis = glm::normalize(glm::cross(right, down));
    const double pixel_area = glm::length(right) * glm::length(down);  // at distance 1 along the axis
    for (const GatherPoint& p : points) {
        const std::uint32_t tile = p.pixel / camera.width / tile_edge * columns + p.pixel % camera.width / tile_edge;
        if (p.reflected != 0) reflected[tile] += 1.0;
        if (p.reflected != 0 || p.maps == 0) continue;
        direct[tile] += 1.0;
        const glm::dvec3 to(p.x - eye.x, p.y - eye.y, p.z - eye.z);
        const double depth = glm::dot(to, axis);
        const double facing = std::abs(glm::dot(to, glm::dvec3(p.nx, p.ny, p.nz)));
        area[tile] += pixel_area * depth * depth * depth / std::max(facing, 1e-3 * depth);
    }
    for (const PhotonHead& photon : photons) {
        if (photon.normal == STOKES_EMPTY_SLOT) continue;
        const glm::dvec3 to(photon.x - eye.x, photon.y - eye.y, photon.z - eye.z);
        const double depth = glm::dot(to, axis);
        if (!(depth > 0.0)) continue;
        const glm::dvec3 on_film = to / depth - corner;
        const double x = glm::dot(on_film, right) / glm::dot(right, right);
        const double y = glm::dot(on_film, down) / glm::dot(down, down);
        if (!(x >= 0.0 && y >= 0.0 && x < camera.width && y < camera.height)) continue;
        count[static_cast<std::uint32_t>(y) / tile_edge * columns + static_cast<std::uint32_t>(x) / tile_edge] += 1.0;
    }
    std::vector<double> density;
    for (std::size_t tile = 0; tile < area.size(); ++tile)
        // Surfaces that reflect lie under the pixels of their reflections as well.
        if (area[tile] > 0.0 && count[tile] > 0.0)
            density.push_back(count[tile] / (area[tile] * (1.0 + reflected[tile] / direct[tile])));
    if (density.empty()) return 0.0;
    const auto middle = density.begin() + static_cast<std::ptrdiff_t>(density.size() / 2);
    std::nth_element(density.begin(), middle, density.end());
    return std::sqrt(photons_per_disk / (M_PI * *middle));
}

double spread_radius_mm(const Scene& scene, std::int64_t photons) {
    double area = 0.0;
    for (const Shape& shape : scene.shapes)
        if (shape.light < 0) area += mesh_area_mm2(shape.mesh);
    if (area == 0.0)
        for (const Shape& shape : scene.shapes) area += mesh_area_mm2(shape.mesh);
    const double extent = scene_extent(scene).half_diagonal_mm();
    area = std::min(area, 4.0 * M_PI * extent * extent);
    if (!(area > 0.0)) throw RunError(scene.file + ": the scene has no surface to store photons on");
    return std::sqrt(photons_per_disk * area / (M_PI * static_cast<double>(std::max<std::int64_t>(photons, 1))));
}

SceneExtent scene_extent(const Scene& scene) {
    SceneExtent extent;
    extent.minimum = glm::dvec3(std::numeric_limits<double>::infinity());
    extent.maximum = -extent.minimum;
    for (const Shape& shape : scene.shapes) {
        const Bounds bounds = mesh_bounds(shape.mesh);
        extent.minimum = glm::min(extent.minimum, bounds.low_mm);
        extent.maximum = glm::max(extent.maximum, bounds.high_mm);
    }
    if (!(extent.minimum.x <= extent.maximum.x)) extent.minimum = extent.maximum = glm::dvec3(0.0);
    return extent;
}

}  // namespace stokes
