#include "host/image/error_map.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "host/core/srgb.hpp"
#include "host/image/colour.hpp"

namespace stokes {
namespace {

constexpr double top_lightness = 0.97, most_chroma = 0.24;
constexpr double first_hue_deg = 270.0, turn_deg = 195.0;
constexpr double shown_share = 0.99;
constexpr std::size_t shades = 256;

bool in_gamut(const glm::dvec3& rgb) {
    const double slack = 1e-9;
    return std::min({rgb.r, rgb.g, rgb.b}) >= -slack && std::max({rgb.r, rgb.g, rgb.b}) <= 1.0 + slack;
}

std::uint8_t to_byte(double linear) {
    return static_cast<std::uint8_t>(std::lround(255.0 * srgb_encode(std::clamp(linear, 0.0, 1.0))));
}

double rounded_up(double value) {
    const double step = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
    return std::ceil(value / step * (1.0 - 1e-12)) * step;
}

double end_of_scale(const std::vector<double>& errors) {
    std::vector<double> finite;
    std::copy_if(errors.begin(), errors.end(), std::back_inserter(finite), [](double e) { return std::isfinite(e); });
    if (finite.empty()) return 1.0;
    const double largest = *std::max_element(finite.begin(), finite.end());
    if (!(largest > 0.0)) return 1.0;
    const auto rank = static_cast<std::ptrdiff_t>(std::ceil(shown_share * static_cast<double>(finite.size() - 1)));
    std::nth_element(finite.begin(), finite.begin() + rank, finite.end());
    const double percentile = finite[static_cast<std::size_t>(rank)];
    return rounded_up(percentile > 0.0 ? percentile : largest);
}

}  // namespace

std::array<std::uint8_t, 3> scale_colour(double t) {
    const double lightness = top_lightness * t;
    const double hue = (first_hue_deg + turn_deg * t) * M_PI / 180.0;
    const auto colour = [&](double chroma) {
        return rec709_of_oklab({lightness, chroma * std::cos(hue), chroma * std::sin(hue)});
    };
    double high = most_chroma * std::pow(std::sin(M_PI * std::clamp(t, 0.0, 1.0)), 0.75), low = 0.0;
    if (!in_gamut(colour(high))) {
        for (int step = 0; step < 20; ++step) {
            const double middle = 0.5 * (low + high);
            (in_gamut(colour(middle)) ? low : high) = middle;
        }
        high = low;
    }
    const glm::dvec3 rgb = colour(high);
    return {to_byte(rgb.r), to_byte(rgb.g), to_byte(rgb.b)};
}

ErrorMap draw_errors(const std::vector<double>& errors, int width, std::optional<double> largest) {
    ErrorMap map;
    map.largest_shown = largest ? *largest : end_of_scale(errors);
    map.image.width = width;
    map.image.height = static_cast<int>(errors.size() / static_cast<std::size_t>(width));
    map.image.rgb.reserve(3 * errors.size());
    std::array<std::array<std::uint8_t, 3>, shades> scale;
    for (std::size_t i = 0; i < shades; ++i) scale[i] = scale_colour(static_cast<double>(i) / (shades - 1));
    for (const double error : errors) {
        if (!std::isfinite(error)) ++map.not_finite;
        if (error > map.largest_shown) ++map.above;
        const double t = std::min(error / map.largest_shown, 1.0);
        const auto& colour =
            std::isfinite(error) ? scale[static_cast<std::size_t>(std::lround(t * (shades - 1)))] : no_number_colour;
        map.image.rgb.insert(map.image.rgb.end(), colour.begin(), colour.end());
    }
    return map;
}

}  // namespace stokes
