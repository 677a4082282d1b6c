#include "host/render/assumptions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/render/transport/transport_model.hpp"
#include "host/scene/mesh/mesh_thickness.hpp"
#include "host/scene/mesh/mesh_topology.hpp"

namespace stokes {
namespace {

constexpr double opaque_mean_free_paths = 3.0;
constexpr double largest_relative_curvature = 1.0;

// The longest over the render's wavelengths.
struct Length {
    double mm = 0.0;
    int lambda_nm = 0;
    double sigma_t = 0.0;  // there [1/mm]
};

// The longer of the diffuse length and this many mean free paths.
Length longest_reach(const Scene& scene, const Medium& medium, double mean_free_paths) {
    Length longest;
    for (int lambda = scene.render.lambda_min_nm; lambda <= scene.render.lambda_max_nm; ++lambda) {
        const double sigma_a = medium.sigma_a.at(lambda), sigma_t = medium.sigma_s.at(lambda) + sigma_a;
        const double mm = std::max(1.0 / std::sqrt(3.0 * sigma_a * sigma_t), mean_free_paths / sigma_t);
        if (mm > longest.mm) longest = {mm, lambda, sigma_t};
    }
    return longest;
}

// The first shape of each body with this material and transport.
std::vector<const Shape*> bodies_of(const Scene& scene, const MaterialUse& use) {
    std::vector<const Shape*> bodies;
    for (const Shape& shape : scene.shapes) {
        const auto known = [&](const Shape* other) { return other->body == shape.body; };
        if (shape.material == use.material && transport_of_body(scene, shape.body) == use.transport &&
            std::none_of(bodies.begin(), bodies.end(), known))
            bodies.push_back(&shape);
    }
    return bodies;
}

// The body farthest from a half-space, by one of the two measures.
struct Worst {
    const Shape* shape = nullptr;
    double value = 0.0;
    std::size_t failed = 0;  // bodies that fail

    void add(const Shape* candidate, double candidate_value, bool worse) {
        ++failed;
        if (shape != nullptr && !worse) return;
        shape = candidate;
        value = candidate_value;
    }
    std::string name() const {
        if (failed == 1) return fmt::format("shape \"{}\"", shape->name);
        return fmt::format("shape \"{}\" (and {} more)", shape->name, failed - 1);
    }
};

std::string length_text(double mm) { return std::isfinite(mm) ? fmt::format("{:.3g} mm", mm) : "any distance"; }

std::string thin_line(const Worst& thinnest, const Length& reach) {
    return fmt::format(
        "{} is thinner than its light reaches: half of its surface is within {} of the other side (optical "
        "thickness {:.3g}), the light reaches {} at {} nm",
        thinnest.name(), length_text(thinnest.value), thinnest.value * reach.sigma_t, length_text(reach.mm),
        reach.lambda_nm);
}

std::string curved_line(const Worst& most_curved, const Length& diffuse) {
    return fmt::format(
        "{} is curved within a diffuse length: its mean radius of curvature is {}, the diffuse length {} at "
        "{} nm",
        most_curved.name(), length_text(1.0 / most_curved.value), length_text(diffuse.mm), diffuse.lambda_nm);
}

// "" where every body of this material is as good as a half-space.
std::string failure(const Scene& scene, const MaterialUse& use, const Medium& medium) {
    const Length reach = longest_reach(scene, medium, opaque_mean_free_paths);
    const Length diffuse = longest_reach(scene, medium, 1.0);
    Worst thinnest, most_curved;
    for (const Shape* shape : bodies_of(scene, use)) {
        const BodyTopology topology = body_topology(scene, shape->body);
        if (topology.kind == BodyKind::flat || !(topology.area_mm2 > 0.0)) continue;
        const double thickness = median_thickness_mm(scene, shape->body);
        if (thickness < reach.mm) thinnest.add(shape, thickness, thickness < thinnest.value);
        const double curvature = std::abs(topology.mean_curvature_mm) / topology.area_mm2;
        if (curvature * diffuse.mm > largest_relative_curvature)
            most_curved.add(shape, curvature, curvature > most_curved.value);
    }
    if (thinnest.shape != nullptr) return thin_line(thinnest, reach);
    if (most_curved.shape != nullptr) return curved_line(most_curved, diffuse);
    return "";
}

}  // namespace

std::vector<std::string> failed_assumptions(const Scene& scene) {
    std::vector<std::string> lines;
    for (const MaterialUse& use : material_uses(scene)) {
        const Material& material = scene.materials[static_cast<std::size_t>(use.material)];
        const std::optional<int> medium = medium_of(material);
        if (!medium || !transport_model(use.transport).takes_bodies_for_half_spaces()) continue;
        const std::string failed = failure(scene, use, scene.media[static_cast<std::size_t>(*medium)]);
        if (failed.empty()) continue;
        lines.push_back(fmt::format("{}: materials.{}: {}; transport \"{}\" takes it for a half-space", scene.file,
                                    material.name, failed, word_of(use.transport)));
    }
    return lines;
}

}  // namespace stokes
