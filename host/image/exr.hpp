// OpenEXR files: the picture and its components as layers, in linear Rec. 709.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>

#include "host/image/film.hpp"

namespace stokes {

// Header attributes by name. Counts that do not fit in an int travel as double.
using Metadata = std::map<std::string, std::variant<std::string, int, double>>;

// Writes float channels, ZIP-compressed: R, G, B (total_rgb) and LAYER.R, LAYER.G, LAYER.B for each name in
// layer_rows (layer_rgb), with the standard attributes chromaticities (Rec. 709, D65) and
// whiteLuminance = 1 cd/m^2, and metadata. Atomic, as write_file_atomically. Throws RunError with path and
// reason.
void write_exr(const std::string& path, const FilmImage& film, const Metadata& metadata);

// Where the pixels that a file holds (its data window) lie in the picture that it shows (its display window).
struct PictureFrame {
    std::int64_t left = 0, top = 0;      // of the first pixel, from the top left corner of the picture
    std::int64_t width = 0, height = 0;  // of the picture, which may be larger or smaller than what there is of it
};

struct ExrImage {
    int width = 0;  // of the pixels that the file holds
    int height = 0;
    PictureFrame frame;
    RgbLayers layers;     // Rec. 709, from the primaries that the file names
    Metadata attributes;  // those of type string, int, float or double
};

// Reads the data window of a file of one part, in scan lines or tiles, of half, float or integer channels: each layer
// with R, G, B, and X, Y, Z or Y alone without a layer. Throws InputError when it cannot be read, is truncated or
// corrupt, has no such channels or not a value of each for every pixel, or names primaries that mix no white. Says
// where a white luminance other than 1 cd/m^2 is not applied.
ExrImage read_exr(const std::string& path);

}  // namespace stokes
