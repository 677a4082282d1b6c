#include "host/image/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "host/core/error.hpp"
#include "host/image/colour.hpp"

namespace stokes {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

// XYZ of a pixel of Rec. 709; none where a value is not finite.
std::optional<glm::dvec3> xyz_at(const std::vector<float>& rgb, std::size_t at) {
    const glm::dvec3 colour(rgb[at], rgb[at + 1], rgb[at + 2]);
    if (!std::isfinite(colour.r) || !std::isfinite(colour.g) || !std::isfinite(colour.b)) return std::nullopt;
    return xyz_of_rec709(colour);
}

void check_same_length(const std::vector<float>& a, const std::vector<float>& b) {
    if (a.size() != b.size() || a.size() % 3 != 0)
        throw RunError(fmt::format("pictures of {} and {} values cannot be compared", a.size(), b.size()));
}

// Sums over the pixels; made into the figures by finish().
struct Sums {
    glm::dvec3 square{0.0}, difference{0.0}, reference{0.0};
};

double ratio(double part, double whole) {
    if (part == 0.0) return 0.0;
    return whole > 0.0 ? part / whole : infinite;
}

double peak_ratio_db(double peak, double rmse) {
    if (rmse == 0.0) return infinite;
    return peak > 0.0 ? 20.0 * std::log10(peak / rmse) : undefined;
}

void finish(LayerError& error, const Sums& sums) {
    const auto pixels = static_cast<double>(error.compared);
    double square = 0.0, difference = 0.0, reference = 0.0;
    for (int c = 0; c < 3; ++c) {
        const auto k = static_cast<std::size_t>(c);
        error.rmse_xyz[k] = std::sqrt(sums.square[c] / pixels);
        error.mean_error_xyz[k] = sums.difference[c] / pixels;
        square += sums.square[c];
        difference += sums.difference[c];
        reference += sums.reference[c];
    }
    error.rmse = std::sqrt(square / (3.0 * pixels));
    error.mean_error = difference / (3.0 * pixels);
    error.reference_mean = reference / (3.0 * pixels);
    error.relative_rmse = ratio(error.rmse, error.reference_mean);
    error.psnr_db = peak_ratio_db(error.peak, error.rmse);
}

void make_undefined(LayerError& error) {
    error.rmse = error.relative_rmse = error.psnr_db = error.mean_error = error.max_error = undefined;
    error.reference_mean = error.peak = undefined;
    error.rmse_xyz.fill(undefined);
    error.mean_error_xyz.fill(undefined);
}

}  // namespace

LayerError compare_layer(const std::vector<float>& picture, const std::vector<float>& reference, int width) {
    check_same_length(picture, reference);
    LayerError error;
    Sums sums;
    std::size_t worst = 0;  // pixel
    error.peak = -infinite;
    for (std::size_t pixel = 0; 3 * pixel < picture.size(); ++pixel) {
        const auto found = xyz_at(picture, 3 * pixel), expected = xyz_at(reference, 3 * pixel);
        if (!found) ++error.not_finite;
        if (!expected) ++error.reference_not_finite;
        if (!found || !expected) continue;
        const glm::dvec3 d = *found - *expected;
        if (error.compared++ == 0) worst = pixel;
        sums.square += d * d;
        sums.difference += d;
        sums.reference += glm::abs(*expected);
        for (int c = 0; c < 3; ++c) {
            error.peak = std::max(error.peak, (*expected)[c]);
            if (std::abs(d[c]) <= error.max_error) continue;
            error.max_error = std::abs(d[c]);
            error.max_channel = static_cast<std::size_t>(c);
            worst = pixel;
        }
    }
    error.max_x = static_cast<int>(worst % static_cast<std::size_t>(width));
    error.max_y = static_cast<int>(worst / static_cast<std::size_t>(width));
    if (error.compared > 0)
        finish(error, sums);
    else
        make_undefined(error);
    return error;
}

std::vector<double> pixel_errors(const std::vector<float>& picture, const std::vector<float>& reference) {
    check_same_length(picture, reference);
    std::vector<double> errors;
    errors.reserve(picture.size() / 3);
    for (std::size_t at = 0; at < picture.size(); at += 3) {
        const auto found = xyz_at(picture, at), expected = xyz_at(reference, at);
        errors.push_back(found && expected ? glm::length(*found - *expected) / std::sqrt(3.0) : undefined);
    }
    return errors;
}

std::string shown_layer(const std::string& layer) { return layer.empty() ? "whole" : layer; }

std::vector<std::string> layers_in_order(const RgbLayers& layers) {
    std::vector<std::string> names;
    const auto add = [&](const std::string& name) {
        const bool known = std::find(names.begin(), names.end(), name) != names.end();
        if (layers.count(name) != 0 && !known) names.push_back(name);
    };
    add("");
    for (const LayerRow& row : layer_rows) add(row.name);
    for (const auto& [name, rgb] : layers) add(name);
    return names;
}

std::vector<std::string> missing_layers(const std::vector<std::string>& names, const RgbLayers& layers) {
    std::vector<std::string> missing;
    std::copy_if(names.begin(), names.end(), std::back_inserter(missing),
                 [&](const std::string& name) { return layers.count(name) == 0; });
    return missing;
}

std::string shown_layers(const std::vector<std::string>& layers) {
    std::vector<std::string> shown;
    for (const std::string& layer : layers) shown.push_back(shown_layer(layer));
    return fmt::format("{}", fmt::join(shown, ", "));
}

}  // namespace stokes
