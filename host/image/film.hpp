// The rendered picture, before it becomes a file.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kernels/shared/layers.h"
#include "kernels/shared/photon.h"

namespace stokes {

// What the light last went through before it reached the camera.
enum class Layer {
    fluorescence = STOKES_LAYER_FLUORESCENCE,
    single = STOKES_LAYER_SINGLE,
    multiple = STOKES_LAYER_MULTIPLE,
    surface = STOKES_LAYER_SURFACE
};

struct LayerRow {
    Layer layer;
    const char* name;        // in files, in statistics and on the command line
    std::optional<int> map;  // STOKES_MAP_*: whose photons light it; none: a kernel of its own does
};
inline constexpr std::size_t layer_count = STOKES_LAYER_COUNT;
// In the order of the film on the device.
inline constexpr std::array<LayerRow, layer_count> layer_rows = {
    {{Layer::fluorescence, "fluorescence", STOKES_MAP_FLUORESCENCE},
     {Layer::single, "single", STOKES_MAP_SINGLE},
     {Layer::multiple, "multiple", STOKES_MAP_MULTIPLE},
     {Layer::surface, "surface", STOKES_MAP_SURFACE}}};

// Kernels add a map's light to the layer of its number.
constexpr bool maps_come_first() {
    for (std::size_t i = 0; i < layer_count; ++i) {
        const LayerRow& row = layer_rows[i];
        if (static_cast<std::size_t>(row.layer) != i || row.map.has_value() != (i < STOKES_MAP_COUNT)) return false;
        if (row.map && static_cast<std::size_t>(*row.map) != i) return false;
    }
    return layer_count >= STOKES_MAP_COUNT;
}
static_assert(maps_come_first());

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
