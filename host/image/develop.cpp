#include "host/image/develop.hpp"

#include <algorithm>
#include <cmath>

#include "host/core/srgb.hpp"
#include "host/image/colour.hpp"

namespace stokes {
namespace {

constexpr double shoulder_start = 0.8;
constexpr int chroma_steps = 14;  // halvings: well below what 8 bits show
constexpr double lit_fraction = 1.0 / 200.0;

double largest(const glm::dvec3& rgb) { return std::max({rgb.r, rgb.g, rgb.b}); }

double smallest(const glm::dvec3& rgb) { return std::min({rgb.r, rgb.g, rgb.b}); }

// rgb with just so much of its chroma that no channel is negative; black where there is no light.
glm::dvec3 into_gamut(const glm::dvec3& rgb) {
    if (smallest(rgb) >= 0.0 && std::isfinite(largest(rgb))) return rgb;
    const glm::dvec3 lab = oklab_of_rec709(rgb);
    const double sum = lab.x + lab.y + lab.z;
    if (!std::isfinite(sum) || lab.x <= 0.0) return glm::dvec3(0.0);
    glm::dvec3 inside = rec709_of_oklab({lab.x, 0.0, 0.0});
    double low = 0.0, high = 1.0;
    for (int step = 0; step < chroma_steps; ++step) {
        const double chroma = 0.5 * (low + high);
        const glm::dvec3 tried = rec709_of_oklab({lab.x, chroma * lab.y, chroma * lab.z});
        if (smallest(tried) >= 0.0) {
            low = chroma;
            inside = tried;
        } else {
            high = chroma;
        }
    }
    return inside;
}

double shoulder(double value) {
    if (value <= shoulder_start) return value;
    const double room = 1.0 - shoulder_start;
    return 1.0 - room * std::exp(-(value - shoulder_start) / room);
}

std::uint8_t to_byte(double linear) {
    if (!(linear > 0.0)) return 0;  // NaN as well: an exposure that is none
    if (linear >= 1.0) return 255;
    return static_cast<std::uint8_t>(std::floor(255.0 * srgb_encode(linear) + 0.5));
}

glm::dvec3 pixel(const std::vector<float>& rgb, std::size_t at) { return {rgb[at], rgb[at + 1], rgb[at + 2]}; }

// The value below which this fraction of values lies; reorders them.
double percentile(std::vector<double>& values, double fraction) {
    const auto rank = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

}  // namespace

Rgb8 develop(const FilmImage& film, double exposure_ev) {
    const std::vector<float> total = total_rgb(film);
    const double scale = std::exp2(exposure_ev);
    Rgb8 image{film.width, film.height, std::vector<std::uint8_t>(total.size(), 0)};
    for (std::size_t i = 0; i < total.size(); i += 3) {
        const glm::dvec3 colour = into_gamut(pixel(total, i));
        const double brightest = largest(colour);
        if (brightest <= 0.0) continue;
        const glm::dvec3 shown = colour / brightest * shoulder(brightest * scale);
        image.rgb[i] = to_byte(shown.r);
        image.rgb[i + 1] = to_byte(shown.g);
        image.rgb[i + 2] = to_byte(shown.b);
    }
    return image;
}

double automatic_exposure_ev(const FilmImage& film) {
    const std::vector<float> total = total_rgb(film);
    std::vector<double> values;
    values.reserve(film.pixels());
    for (std::size_t i = 0; i < total.size(); i += 3) {
        const double value = largest(into_gamut(pixel(total, i)));
        if (value > 0.0) values.push_back(value);
    }
    if (values.empty()) return 0.0;
    const double threshold = lit_fraction * percentile(values, 0.995);
    values.erase(std::remove_if(values.begin(), values.end(), [=](double v) { return v < threshold; }), values.end());
    return std::log2(shoulder_start / percentile(values, 0.95));
}

}  // namespace stokes
