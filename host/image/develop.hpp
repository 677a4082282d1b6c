// From the film to a picture for the screen.
#pragma once

#include <cstdint>
#include <vector>

#include "host/image/film.hpp"

namespace stokes {

// sRGB, 8 bits a channel: index (y * width + x) * 3 + channel, top row first.
struct Rgb8 {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;
};

// The film's total times 2^exposure_ev (0 EV: 1 cd/m^2 is white) in sRGB; non-finite pixels become black.
// Colours outside Rec. 709, as saturated fluorescence is, lose Oklab chroma, at the same hue and lightness,
// until no channel is negative. Highlights: the largest channel m becomes m up to 0.8 and 1 - 0.2 exp(-(m -
// 0.8) / 0.2) above, and the other channels scale along.
Rgb8 develop(const FilmImage& film, double exposure_ev);

// The exposure that puts the 95th percentile of the lit pixels at 0.8, where the shoulder begins. A pixel's
// value is the largest channel of its colour in the gamut; lit is above 1/200 of the 99.5th percentile of the
// positive values, so that neither a dark surround nor a few stray bright pixels matter. Black film: 0.
double automatic_exposure_ev(const FilmImage& film);

}  // namespace stokes
