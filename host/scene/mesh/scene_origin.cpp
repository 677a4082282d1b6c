#include "host/scene/mesh/scene_origin.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stokes {
namespace {

// A half, less than which rounding cannot tell from it.
constexpr double half = 0.5 - 1e-9;
constexpr double least_step_in_sizes = 8.0;

struct Thing {
    glm::dvec3 place_mm;
    double size_mm;
    double weight;
};

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

std::vector<Thing> things_of(const Camera& camera, const std::vector<Bounds>& shapes) {
    const double view_per_mm = 2.0 * std::tan(glm::radians(camera.vertical_fov_deg) / 2.0);
    std::vector<Thing> things;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Bounds& shape : shapes) {
        const double size = largest(shape.high_mm - shape.low_mm);
        if (!(size > 0.0) || !std::isfinite(size)) continue;
        const glm::dvec3 outside =
            glm::max(glm::max(shape.low_mm - camera.position_mm, camera.position_mm - shape.high_mm), glm::dvec3(0.0));
        const double distance = glm::length(outside), share = size / (view_per_mm * distance);  // may be infinite
        things.push_back({0.5 * (shape.low_mm + shape.high_mm), size, std::min(share * share, 1.0) / size});
        nearest = std::min(nearest, distance + size);
    }
    if (!things.empty()) things.push_back({camera.position_mm, nearest, 1.0 / nearest});
    return things;
}

// of: a thing's value.
template <class Value>
double median(const std::vector<Thing>& things, Value&& of) {
    std::vector<std::pair<double, double>> values;  // and weights
    double total = 0.0, below = 0.0;
    for (const Thing& thing : things) {
        values.emplace_back(of(thing), thing.weight);
        total += thing.weight;
    }
    std::sort(values.begin(), values.end());
    for (const auto& [value, weight] : values)
        if ((below += weight) >= half * total) return value;
    return values.back().first;
}

}  // namespace

glm::dvec3 scene_origin_mm(const Camera& camera, const std::vector<Bounds>& shapes) {
    const std::vector<Thing> things = things_of(camera, shapes);
    glm::dvec3 origin(0.0);
    if (things.empty()) return origin;
    for (int axis = 0; axis < 3; ++axis)
        origin[axis] = median(things, [&](const Thing& t) { return t.place_mm[axis]; });
    const double size =
        median(things, [&](const Thing& t) { return largest(glm::abs(t.place_mm - origin)) + t.size_mm; });
    const double step = std::exp2(std::ceil(std::log2(least_step_in_sizes * size)));
    return step * glm::round(origin / step) + 0.0;  // -0 becomes 0
}

}  // namespace stokes
