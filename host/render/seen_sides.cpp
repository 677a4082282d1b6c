#include "host/render/seen_sides.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stokes {
namespace {

constexpr double told_share = 0.2;
// Fewer rays tell nothing: those that pass an edge by rounding may meet a back.
constexpr std::uint32_t fewest_backs = 4;
constexpr std::size_t most_lines = 4;

bool looks_black_from_behind(const Scene& scene, const Shape& shape) {
    const Material& material = scene.materials[static_cast<std::size_t>(shape.material)];
    return !shape.two_sided && shape.light < 0 && !std::holds_alternative<BlackMaterial>(material.kind);
}

}  // namespace

std::vector<std::string> black_back_lines(const Scene& scene, const std::vector<SeenSides>& sides) {
    std::vector<std::size_t> told;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const double seen = static_cast<double>(sides[i].front) + sides[i].back;
        if (sides[i].back >= fewest_backs && sides[i].back >= told_share * seen &&
            looks_black_from_behind(scene, scene.shapes[i]))
            told.push_back(i);
    }
    std::stable_sort(told.begin(), told.end(),
                     [&](std::size_t a, std::size_t b) { return sides[a].back > sides[b].back; });
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < told.size() && i < most_lines; ++i) {
        const SeenSides& of = sides[told[i]];
        lines.push_back(
            fmt::format("shape \"{}\": {:.0f} % of what the camera sees of it is its back, which is black: "
                        "these faces look away from the camera",
                        scene.shapes[told[i]].name, 100.0 * of.back / (static_cast<double>(of.front) + of.back)));
    }
    if (const std::size_t rest = told.size() - lines.size(); rest > 0)
        lines.push_back(fmt::format("the camera sees the black back of {} more shape{}", rest, rest == 1 ? "" : "s"));
    return lines;
}

}  // namespace stokes
