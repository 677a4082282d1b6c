#include "host/commands/error_curve.hpp"

#include <fmt/format.h>

#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/image/compare.hpp"

namespace stokes {

namespace {

std::vector<std::string> layers_of_a_render() {
    std::vector<std::string> layers = {""};
    for (const LayerRow& row : layer_rows) layers.emplace_back(row.name);
    return layers;
}

void check_finite(const std::string& file, const RgbLayers& layers, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        const std::vector<float>& rgb = layers.at(name);
        const std::size_t bad = compare_layer(rgb, rgb, 1).not_finite;
        if (bad > 0)
            throw InputError(fmt::format("{}: expected finite pixels, got {} in layer {} that are not", file, bad,
                                         shown_layer(name)));
    }
}

}  // namespace

ErrorCurve::ErrorCurve(const std::string& reference_file, const std::string& csv_file, int every, const Film& film)
    : csv_file_(csv_file), every_(static_cast<std::uint32_t>(every)), layers_(layers_of_a_render()) {
    ExrImage reference = read_exr(reference_file);
    if (reference.width != film.width || reference.height != film.height)
        throw InputError(fmt::format("{}: expected {} x {} pixels, as the render has, got {} x {}", reference_file,
                                     film.width, film.height, reference.width, reference.height));
    const PictureFrame& frame = reference.frame;
    if (frame.left != 0 || frame.top != 0 || frame.width != film.width || frame.height != film.height)
        throw InputError(fmt::format(
            "{}: expected the whole picture, as the render makes it, got {} x {} pixels from "
            "({}, {}) of {} x {}",
            reference_file, reference.width, reference.height, frame.left, frame.top, frame.width, frame.height));
    const std::vector<std::string> missing = missing_layers(layers_, reference.layers);
    if (!missing.empty()) throw InputError(fmt::format("{}: no layer {}", reference_file, shown_layers(missing)));
    check_finite(reference_file, reference.layers, layers_);
    reference_ = std::move(reference.layers);
    text_ = "passes,seconds";
    for (const std::string& layer : layers_) text_ += fmt::format(",rmse_{0},relative_rmse_{0}", shown_layer(layer));
    text_ += "\n";
}

bool ErrorCurve::due(std::uint32_t passes) const {
    return every_ > 0 ? passes % every_ == 0 : (passes & (passes - 1)) == 0;
}

void ErrorCurve::add(std::uint32_t passes, double seconds, const FilmImage& film) {
    const RgbLayers picture = film_layers(film);
    text_ += fmt::format("{},{:.6g}", passes, seconds);
    for (const std::string& layer : layers_) {
        const LayerError error = compare_layer(picture.at(layer), reference_.at(layer), film.width);
        text_ += fmt::format(",{:.8g},{:.8g}", error.rmse, error.relative_rmse);
    }
    text_ += "\n";
    last_ = passes;
    try {
        write();
    } catch (const RunError& error) {
        warn(error.what());
    }
}

void ErrorCurve::write() const { write_file_atomically(csv_file_, text_); }

}  // namespace stokes
