#include "host/image/film.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/core/error.hpp"
#include "host/image/colour.hpp"

namespace stokes {

FilmImage::FilmImage(int width_px, int height_px) : width(width_px), height(height_px) {
    for (std::vector<float>& layer : xyz) layer.assign(pixels() * 3, 0.0f);
}

std::vector<float> layer_rgb(const FilmImage& film, Layer layer) {
    const std::vector<float>& xyz = film.xyz[static_cast<std::size_t>(layer)];
    if (xyz.size() != film.pixels() * 3)
        throw RunError(fmt::format("film of {} x {} pixels has {} values in its layer {}", film.width, film.height,
                                   xyz.size(), layer_rows[static_cast<std::size_t>(layer)].name));
    std::vector<float> rgb(xyz.size());
    for (std::size_t i = 0; i < xyz.size(); i += 3) {
        const glm::dvec3 colour = rec709_of_xyz({xyz[i], xyz[i + 1], xyz[i + 2]});
        for (int c = 0; c < 3; ++c) rgb[i + static_cast<std::size_t>(c)] = static_cast<float>(colour[c]);
    }
    return rgb;
}

std::vector<float> total_rgb(const FilmImage& film) {
    std::vector<double> sum(film.pixels() * 3, 0.0);
    for (const LayerRow& row : layer_rows) {
        const std::vector<float> layer = layer_rgb(film, row.layer);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += layer[i];
    }
    std::vector<float> total(sum.size());
    for (std::size_t i = 0; i < sum.size(); ++i) total[i] = static_cast<float>(sum[i]);
    return total;
}

RgbLayers film_layers(const FilmImage& film) {
    RgbLayers layers;
    layers[""] = total_rgb(film);
    for (const LayerRow& row : layer_rows) layers[row.name] = layer_rgb(film, row.layer);
    return layers;
}

std::size_t count_non_finite(const FilmImage& film) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < film.pixels() * 3; i += 3) {
        double sum = 0.0;
        for (const std::vector<float>& layer : film.xyz)
            for (std::size_t c = 0; c < 3; ++c) sum += static_cast<double>(layer[i + c]);
        if (!std::isfinite(sum)) ++count;
    }
    return count;
}

}  // namespace stokes
