#include "host/image/develop.hpp"

#include <algorithm>
#include <cmath>

#include "host/image/colour.hpp"

namespace stokes {
namespace {

constexpr double shoulder_start = 0.8;
constexpr double lit_fraction = 1.0 / 200.0;

double largest(const glm::dvec3& rgb) {
    return std::max({rgb.r, rgb.g, rgb.b});
}

// rgb mixed with grey of its luminance just enough to have no negative channel; black where there is no
// light.
glm::dvec3 into_gamut(const glm::dvec3& rgb) {
    const double grey = luminance(rgb);
    if (!std::isfinite(grey) || grey <= 0.0) return glm::dvec3(0.0);
    const double smallest = std::min({rgb.r, rgb.g, rgb.b});
    if (smallest >= 0.0) return rgb;
    const double saturation = grey / (grey - smallest);
    return glm::max(glm::dvec3(grey) + saturation * (rgb - grey), glm::dvec3(0.0));
}

double shoulder(double value) {
    if (value <= shoulder_start) return value;
    const double room = 1.0 - shoulder_start;
    return 1.0 - room * std::exp(-(value - shoulder_start) / room);
}

std::uint8_t to_byte(double linear) {
    return static_cast<std::uint8_t>(std::floor(255.0 * srgb_encode(linear) + 0.5));
}

glm::dvec3 pixel(const std::vector<float>& rgb, std::size_t at) {
    return {rgb[at], rgb[at + 1], rgb[at + 2]};
}

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
    values.erase(std::remove_if(values.begin(), values.end(), [=](double v) { return v < threshold; }),
                 values.end());
    return std::log2(shoulder_start / percentile(values, 0.95));
}

}  // namespace stokes
