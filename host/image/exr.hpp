// OpenEXR files: the picture and its components as layers, in linear Rec. 709.
#pragma once

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

struct ExrImage {
    int width = 0;
    int height = 0;
    RgbLayers layers;     // a channel the file has not is 0
    Metadata attributes;  // those of type string, int, float or double
};

// Reads the data window of a single-part file. Throws InputError when it cannot be read, is truncated or
// corrupt, or has no layer of R, G, B.
ExrImage read_exr(const std::string& path);

}  // namespace stokes
