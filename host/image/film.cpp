#include "host/image/film.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/core/error.hpp"
#include "host/image/colour.hpp"

namespace stokes {

FilmImage::FilmImage(int width_px, int height_px) : width(width_px), height(height_px) {
    for (std::vector<float>& component : xyz) component.assign(pixels() * 3, 0.0f);
}

std::vector<float> component_rgb(const FilmImage& film, Component component) {
    const std::vector<float>& xyz = film.xyz[static_cast<std::size_t>(component)];
    if (xyz.size() != film.pixels() * 3)
        throw RunError(fmt::format("film of {} x {} pixels has {} values in its {} component", film.width, film.height,
                                   xyz.size(), component_names[static_cast<std::size_t>(component)]));
    std::vector<float> rgb(xyz.size());
    for (std::size_t i = 0; i < xyz.size(); i += 3) {
        const glm::dvec3 colour = rec709_of_xyz({xyz[i], xyz[i + 1], xyz[i + 2]});
        for (int c = 0; c < 3; ++c) rgb[i + static_cast<std::size_t>(c)] = static_cast<float>(colour[c]);
    }
    return rgb;
}

std::vector<float> total_rgb(const FilmImage& film) {
    std::vector<double> sum(film.pixels() * 3, 0.0);
    for (std::size_t k = 0; k < component_count; ++k) {
        const std::vector<float> layer = component_rgb(film, static_cast<Component>(k));
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += layer[i];
    }
    std::vector<float> total(sum.size());
    for (std::size_t i = 0; i < sum.size(); ++i) total[i] = static_cast<float>(sum[i]);
    return total;
}

RgbLayers film_layers(const FilmImage& film) {
    RgbLayers layers;
    layers[""] = total_rgb(film);
    for (std::size_t k = 0; k < component_count; ++k)
        layers[component_names[k]] = component_rgb(film, static_cast<Component>(k));
    return layers;
}

std::size_t count_non_finite(const FilmImage& film) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < film.pixels() * 3; i += 3) {
        double sum = 0.0;
        for (const std::vector<float>& component : film.xyz)
            for (std::size_t c = 0; c < 3; ++c) sum += static_cast<double>(component[i + c]);
        if (!std::isfinite(sum)) ++count;
    }
    return count;
}

}  // namespace stokes
