// The sRGB transfer function of IEC 61966-2-1.
#pragma once

#include <cmath>

namespace stokes {

// Linear [0, 1] to encoded [0, 1] and back.
inline double srgb_encode(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

inline double srgb_decode(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace stokes
