#include "host/render/translucent_bodies.hpp"

#include <fmt/format.h>

#include <set>

namespace stokes {

namespace {

// Named in full, or in part where there are more.
constexpr std::size_t most_lines = 3;

bool is_translucent(const Scene& scene, const Shape& shape) {
    return as_translucent(scene.materials[static_cast<std::size_t>(shape.material)]) != nullptr;
}

// By the first of its translucent shapes.
std::string name_of(const Scene& scene, int body) {
    for (const Shape& shape : scene.shapes)
        if (shape.body == body && is_translucent(scene, shape)) return shape.name;
    return "";
}

}  // namespace

std::vector<int> translucent_bodies(const Scene& scene) {
    std::set<int> bodies;
    for (const Shape& shape : scene.shapes)
        if (is_translucent(scene, shape)) bodies.insert(shape.body);
    return {bodies.begin(), bodies.end()};
}

std::vector<std::string> unmet_body_lines(const Scene& scene, const std::vector<int>& bodies) {
    constexpr const char* advice =
        "black but for what it reflects: no light reaches it, or too little for the photons of this render";
    std::vector<std::string> lines;
    if (bodies.size() <= most_lines) {
        for (const int body : bodies)
            lines.push_back(
                fmt::format("no photon met the translucent body \"{}\"; it is {}", name_of(scene, body), advice));
        return lines;
    }
    std::string names;
    for (std::size_t i = 0; i < most_lines; ++i) names += fmt::format("\"{}\", ", name_of(scene, bodies[i]));
    lines.push_back(fmt::format("no photon met {} translucent bodies, {}..; each is {}", bodies.size(), names, advice));
    return lines;
}

}  // namespace stokes
