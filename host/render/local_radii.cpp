#include "host/render/local_radii.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace stokes {

namespace {

// Neighbours to each side whose factors are averaged [pixels].
constexpr int reach = 2;

// Cosine between normals of neighbours on the same surface.
constexpr float same_surface = 0.9f;

bool counts_for(const GatherPoint& p) { return p.maps != 0 && p.reflected == 0; }

bool same(const GatherPoint& a, const GatherPoint& b) {
    return a.material == b.material && a.nx * b.nx + a.ny * b.ny + a.nz * b.nz > same_surface;
}

// f(x, y) for the pixels about one, within the picture, row by row.
template <class Function>
void for_neighbours(int x, int y, int width, int height, const Function& f) {
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, height - 1); ++v)
        for (int u = std::max(x - reach, 0); u <= std::min(x + reach, width - 1); ++u) f(v * width + u);
}

}  // namespace

float radius_factor(const std::vector<float>& counts) {
    // The radius at which the count would be enough, between two that were counted: log count is taken as linear in
    // log radius, as it is where photons lie evenly.
    float radius = least_count_factor, below = 0.0f;
    for (const float count : counts) {
        if (count >= enough_photons) {
            const float slope = below > 0.0f ? std::log2(count / std::max(below, 0.5f)) : 2.0f;
            const float enough_at = radius * std::exp2(std::log2(enough_photons / count) / std::max(slope, 0.25f));
            return std::clamp(std::sqrt(enough_at), least_radius_factor, largest_radius_factor);
        }
        below = count;
        radius *= 2.0f;
    }
    if (!(below > 0.0f)) return largest_radius_factor;
    const float enough_at = 0.5f * radius * std::sqrt(enough_photons / below);
    return std::clamp(std::sqrt(enough_at), least_radius_factor, largest_radius_factor);
}

std::vector<PixelRadius> pixel_radii(const std::vector<GatherPoint>& points, const std::vector<float>& counts,
                                     std::uint32_t width, std::uint32_t height) {
    std::vector<std::uint32_t> point_of(points.size());
    std::vector<float> logarithm(points.size(), 0.0f);  // by pixel
    std::vector<float> own(count_levels);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        point_of[points[i].pixel] = i;
        if (!counts_for(points[i])) continue;
        for (std::uint32_t level = 0; level < count_levels; ++level) own[level] = counts[level * points.size() + i];
        logarithm[points[i].pixel] = std::log2(radius_factor(own));
    }
    const auto at = [&](int pixel) -> const GatherPoint& { return points[point_of[static_cast<std::size_t>(pixel)]]; };
    const int columns = static_cast<int>(width), rows = static_cast<int>(height);
    std::vector<PixelRadius> result;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const GatherPoint* centre = &at(y * columns + x);
            if (centre->reflected != 0)
                for_neighbours(x, y, columns, rows, [&](int n) {
                    if (centre->reflected != 0 && counts_for(at(n))) centre = &at(n);
                });
            if (!counts_for(*centre)) {
                result.push_back({1.0f, STOKES_NONE});
                continue;
            }
            float sum = 0.0f, number = 0.0f;
            for_neighbours(x, y, columns, rows, [&](int n) {
                if (!counts_for(at(n)) || !same(at(n), *centre)) return;
                sum += logarithm[static_cast<std::size_t>(n)];
                number += 1.0f;
            });
            result.push_back({std::exp2(sum / number), centre->material});
        }
    return result;
}

std::vector<float> radius_classes(const std::vector<PixelRadius>& pixels) {
    std::set<float> classes = {1.0f};
    for (const PixelRadius& pixel : pixels) {
        int exponent = 0;
        const float mantissa = std::frexp(pixel.factor, &exponent);  // in [0.5, 1)
        classes.insert(std::ldexp(1.0f, mantissa > 0.5f ? exponent : exponent - 1));
    }
    return {classes.begin(), classes.end()};
}

}  // namespace stokes
