// Errors as a picture in false colours.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "host/image/develop.hpp"

namespace stokes {

// The scale's colour for t in [0, 1], sRGB: Oklab of lightness 0.97 t, so that equal steps look equal and grey prints
// keep their order; from black by violet, red and orange to white: hue 270 + 195 t degrees, chroma
// 0.24 sin(pi t)^(3/4), or as much of it as sRGB has.
std::array<std::uint8_t, 3> scale_colour(double t);

// Green, which the scale has not: pixels that are not finite.
inline constexpr std::array<std::uint8_t, 3> no_number_colour = {0, 255, 0};

struct ErrorMap {
    Rgb8 image;
    double largest_shown = 0.0;  // the error that has the scale's last colour, t = 1; 0 error is t = 0, linear between
    std::size_t above = 0;       // pixels beyond it, in the last colour too
    std::size_t not_finite = 0;
};

// errors: width * n, not negative, NaN where there is none. Without a largest the scale ends at the 99th percentile of
// the errors, so that single bright pixels do not darken the rest, or at the largest error where that is 0; rounded up
// to two digits.
ErrorMap draw_errors(const std::vector<double>& errors, int width, std::optional<double> largest);

}  // namespace stokes
