#include "host/commands/compare_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/core/json_text.hpp"

namespace stokes {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* channels[] = {"X", "Y", "Z"};

std::string shown(double value) { return std::isnan(value) ? "-" : fmt::format("{:.5g}", value); }

std::string counts(const LayerError& error) {
    if (error.not_finite == 0 && error.reference_not_finite == 0) return "";
    return fmt::format("  {} and {} pixels not finite", error.not_finite, error.reference_not_finite);
}

Json layer_json(const LayerError& e) {
    Json json = {{"rmse", e.rmse},
                 {"relative_rmse", e.relative_rmse},
                 {"psnr_db", e.psnr_db},
                 {"mean_error", e.mean_error},
                 {"max_error", e.max_error},
                 {"max_error_pixel", nullptr},
                 {"max_error_channel", nullptr},
                 {"rmse_xyz", e.rmse_xyz},
                 {"mean_error_xyz", e.mean_error_xyz},
                 {"reference_mean", e.reference_mean},
                 {"peak", e.peak},
                 {"pixels", e.compared},
                 {"not_finite", e.not_finite},
                 {"reference_not_finite", e.reference_not_finite}};
    if (e.compared > 0) {
        json["max_error_pixel"] = {e.max_x, e.max_y};
        json["max_error_channel"] = channels[e.max_channel];
    }
    return json;
}

Json diff_json(const Comparison& c) {
    if (c.diff_file.empty()) return nullptr;
    return {{"file", c.diff_file},        {"layer", c.diff_layer},        {"from", 0},
            {"to", c.diff.largest_shown}, {"pixels_above", c.diff.above}, {"not_finite", c.diff.not_finite}};
}

// "whole 3, single 3" of the layers where count is not 0.
template <class Count>
std::string where(const Comparison& comparison, const Count& count) {
    std::string text;
    for (const auto& [name, error] : comparison.layers)
        if (count(error) != 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, count(error));
    return text;
}

}  // namespace

std::string Comparison::complaint() const {
    std::string text;
    const auto add = [&](const std::string& what, const std::string& list) {
        if (!list.empty()) text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", what, list);
    };
    add("pixels of " + picture + " that are not finite",
        where(*this, [](const LayerError& e) { return e.not_finite; }));
    add("pixels of " + reference + " that are not finite",
        where(*this, [](const LayerError& e) { return e.reference_not_finite; }));
    std::string above;
    for (const auto& [name, error] : layers)
        if (tolerance && error.relative_rmse > *tolerance)
            above += fmt::format("{}{} {:.5g}", above.empty() ? "" : ", ", name, error.relative_rmse);
    if (tolerance) add(fmt::format("relative RMSE above the tolerance {}", *tolerance), above);
    return text;
}

std::string comparison_table(const Comparison& comparison) {
    const int room = std::accumulate(
        comparison.layers.begin(), comparison.layers.end(), 5,
        [](int widest, const auto& layer) { return std::max(widest, static_cast<int>(layer.first.size())); });
    std::string text = fmt::format(
        "{} against {}: {} x {} pixels, X, Y, Z in cd/m^2\n{:<{}}  {:>11}  {:>11}  {:>9}  "
        "{:>11}  {:>11}\n",
        comparison.picture, comparison.reference, comparison.width, comparison.height, "layer", room, "RMSE",
        "relative", "PSNR [dB]", "mean error", "max error");
    for (const auto& [name, e] : comparison.layers) {
        text += fmt::format("{:<{}}  {:>11}  {:>11}  {:>9}  {:>11}  {:>11}", name, room, shown(e.rmse),
                            shown(e.relative_rmse), shown(e.psnr_db), shown(e.mean_error), shown(e.max_error));
        if (e.max_error > 0.0) text += fmt::format("  {} at ({}, {})", channels[e.max_channel], e.max_x, e.max_y);
        text += counts(e) + "\n";
    }
    return text;
}

std::string scale_text(const ErrorMap& map, const std::string& layer) {
    std::string text = fmt::format(
        "error of {}, root mean square of X, Y, Z, linear from black, 0, by violet, red and orange to "
        "white, {:.6g} cd/m^2",
        layer, map.largest_shown);
    if (map.above > 0) text += fmt::format(" and above ({} pixels)", map.above);
    if (map.not_finite > 0) text += fmt::format("; green: not finite ({} pixels)", map.not_finite);
    return text;
}

std::string comparison_json(const Comparison& c) {
    Json layers = Json::object();
    for (const auto& [name, error] : c.layers) layers[name] = layer_json(error);
    return json_text({{"picture", c.picture},
                      {"reference", c.reference},
                      {"width", c.width},
                      {"height", c.height},
                      {"layers", layers},
                      {"diff", diff_json(c)},
                      {"tolerance", c.tolerance ? Json(*c.tolerance) : Json()},
                      {"passed", c.complaint().empty()}});
}

}  // namespace stokes
