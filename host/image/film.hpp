// The rendered picture, before it becomes a file.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "kernels/shared/layers.h"
#include "kernels/shared/photon.h"

namespace stokes {

// What the light last went through before it reached the camera: a word for each row of STOKES_LAYERS.
enum class Layer {
#define STOKES_LAYER_WORD(name, NAME) name = STOKES_LAYER_##NAME,
    STOKES_LAYERS(STOKES_LAYER_WORD)
#undef STOKES_LAYER_WORD
};

struct LayerRow {
    Layer layer;
    const char* name;  // in files, in statistics and on the command line
};
inline constexpr std::size_t layer_count = STOKES_LAYER_COUNT;
// In the order of the film on the device.
inline constexpr std::array<LayerRow, layer_count> layer_rows = {{
#define STOKES_LAYER_ROW(name, NAME) {Layer::name, #name},
    STOKES_LAYERS(STOKES_LAYER_ROW)
#undef STOKES_LAYER_ROW
}};

// Kernels add a map's light to the layer of its number.
static_assert(STOKES_LAYER_FLUORESCENCE == STOKES_MAP_FLUORESCENCE && STOKES_LAYER_SINGLE == STOKES_MAP_SINGLE &&
              STOKES_LAYER_MULTIPLE == STOKES_MAP_MULTIPLE && STOKES_LAYER_SURFACE == STOKES_MAP_SURFACE);
static_assert(STOKES_LAYER_COUNT >= STOKES_MAP_COUNT);

// XYZ (colour.hpp: Y in cd/m^2) of each layer, index (y * width + x) * 3 + channel, top row first.
struct FilmImage {
    int width = 0;
    int height = 0;
    std::array<std::vector<float>, layer_count> xyz;  // by Layer, width * height * 3 values each

    FilmImage() = default;
    FilmImage(int width_px, int height_px);  // black
    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

// Linear Rec. 709 in cd/m^2, laid out as xyz is; may be negative outside the gamut. Throws RunError when a
// layer has not width * height * 3 values.
std::vector<float> layer_rgb(const FilmImage& film, Layer layer);

// The sum of the layers, each taken as layer_rgb gives it, so that a file's layers add up to its picture.
std::vector<float> total_rgb(const FilmImage& film);

// Layers by name, "" for the whole picture: width * height * 3 values R, G, B each, laid out as xyz is.
using RgbLayers = std::map<std::string, std::vector<float>>;

// What a file holds of a film: total_rgb as "", and layer_rgb by the names of layer_rows.
RgbLayers film_layers(const FilmImage& film);

// Pixels with a NaN or an infinity in any layer: a caller may want to warn.
std::size_t count_non_finite(const FilmImage& film);

}  // namespace stokes
