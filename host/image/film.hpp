// The rendered picture, before it becomes a file.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace stokes {

// What the light last went through before it reached the camera.
enum class Component { fluorescence, single, multiple, surface };
inline constexpr std::size_t component_count = 4;
inline constexpr std::array<const char*, component_count> component_names = {"fluorescence", "single", "multiple",
                                                                             "surface"};

// XYZ (colour.hpp: Y in cd/m^2) of each component, index (y * width + x) * 3 + channel, top row first.
struct FilmImage {
    int width = 0;
    int height = 0;
    std::array<std::vector<float>, component_count> xyz;  // by Component, width * height * 3 values each

    FilmImage() = default;
    FilmImage(int width_px, int height_px);  // black
    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

// Linear Rec. 709 in cd/m^2, laid out as xyz is; may be negative outside the gamut. Throws RunError when a
// component has not width * height * 3 values.
std::vector<float> component_rgb(const FilmImage& film, Component component);

// The sum of the components, each taken as component_rgb gives it, so that a file's layers add up to its
// picture.
std::vector<float> total_rgb(const FilmImage& film);

// Layers by name, "" for the whole picture: width * height * 3 values R, G, B each, laid out as xyz is.
using RgbLayers = std::map<std::string, std::vector<float>>;

// What a file holds of a film: total_rgb as "", and component_rgb by the names of component_names.
RgbLayers film_layers(const FilmImage& film);

// Pixels with a NaN or an infinity in any component: a caller may want to warn.
std::size_t count_non_finite(const FilmImage& film);

}  // namespace stokes
