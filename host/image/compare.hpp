// How far a picture is from a reference, in numbers.
//
// Errors are differences of X, Y and Z [cd/m^2], the tristimulus values that the film sums up: linear in the light,
// comparable at once in hue and in luminance, and independent of the primaries of the file. In Rec. 709 the same
// noise would weigh more in colours outside its gamut, as those of most fluorophores are.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "host/image/film.hpp"

namespace stokes {

// Over the pixels that are finite in both pictures, and over X, Y and Z of each; d = picture - reference.
// All NaN where there is no such pixel.
struct LayerError {
    double rmse = 0.0;            // sqrt(mean of d^2) [cd/m^2]
    double relative_rmse = 0.0;   // rmse over the mean of |reference|; 0 / 0 is 0, and over a black reference infinite
    double psnr_db = 0.0;         // 20 log10(peak / rmse); infinite without error, NaN where the peak is not above 0
    double mean_error = 0.0;      // mean of d: the bias [cd/m^2]
    double max_error = 0.0;       // largest |d| [cd/m^2]
    int max_x = 0, max_y = 0;     // its pixel, from the top left; of several the first in reading order
    std::size_t max_channel = 0;  // and its channel: 0 X, 1 Y, 2 Z
    std::array<double, 3> rmse_xyz{}, mean_error_xyz{};    // by channel [cd/m^2]
    double reference_mean = 0.0;                           // of |reference| [cd/m^2]
    double peak = 0.0;                                     // largest value of the reference [cd/m^2]
    std::size_t compared = 0;                              // pixels that are finite in both
    std::size_t not_finite = 0, reference_not_finite = 0;  // pixels with a NaN or an infinity, in each
};

// Linear Rec. 709, width * n * 3 values each; RunError where they are not.
LayerError compare_layer(const std::vector<float>& picture, const std::vector<float>& reference, int width);

// The error of each pixel: the root of the mean over X, Y, Z of d^2 [cd/m^2], so that its root mean square over the
// picture is the rmse. NaN where a pixel is not finite in one of them.
std::vector<double> pixel_errors(const std::vector<float>& picture, const std::vector<float>& reference);

// Layers as people call them: "" is "whole". In the order whole, layer_rows, others by name.
std::string shown_layer(const std::string& layer);
std::vector<std::string> layers_in_order(const RgbLayers& layers);

// Those of the names ("" for the whole) that are not among layers.
std::vector<std::string> missing_layers(const std::vector<std::string>& names, const RgbLayers& layers);
// "whole, single".
std::string shown_layers(const std::vector<std::string>& layers);

}  // namespace stokes
