#include "host/commands/compare_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/core/json_text.hpp"

namespace stokes {

namespace {

constexpr const char* channels[] = {"X", "Y", "Z"};

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.8g}", value) : "null"; }

std::string shown(double value) { return std::isnan(value) ? "-" : fmt::format("{:.5g}", value); }

std::string triple(const std::array<double, 3>& values) {
    return fmt::format("[{}, {}, {}]", number(values[0]), number(values[1]), number(values[2]));
}

std::string counts(const LayerError& error) {
    if (error.not_finite == 0 && error.reference_not_finite == 0) return "";
    return fmt::format("  {} and {} pixels not finite", error.not_finite, error.reference_not_finite);
}

std::string layer_json(const LayerError& e) {
    const std::string at = e.compared == 0 ? "null" : fmt::format("[{}, {}]", e.max_x, e.max_y);
    const std::string channel = e.compared == 0 ? "null" : fmt::format("\"{}\"", channels[e.max_channel]);
    return fmt::format(
        "{{\"rmse\": {}, \"relative_rmse\": {}, \"psnr_db\": {}, \"mean_error\": {},\n      \"max_error\": {}, "
        "\"max_error_pixel\": {}, \"max_error_channel\": {},\n      \"rmse_xyz\": {}, \"mean_error_xyz\": {},\n"
        "      \"reference_mean\": {}, \"peak\": {}, \"pixels\": {}, \"not_finite\": {}, "
        "\"reference_not_finite\": {}}}",
        number(e.rmse), number(e.relative_rmse), number(e.psnr_db), number(e.mean_error), number(e.max_error), at,
        channel, triple(e.rmse_xyz), triple(e.mean_error_xyz), number(e.reference_mean), number(e.peak), e.compared,
        e.not_finite, e.reference_not_finite);
}

std::string diff_json(const Comparison& c) {
    if (c.diff_file.empty()) return "null";
    return fmt::format(
        "{{\"file\": {}, \"layer\": {}, \"from\": 0, \"to\": {}, \"pixels_above\": {}, \"not_finite\": {}}}",
        json_quoted(c.diff_file), json_quoted(c.diff_layer), number(c.diff.largest_shown), c.diff.above,
        c.diff.not_finite);
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
    std::string layers;
    for (const auto& [name, error] : c.layers)
        layers += fmt::format("{}\n    {}: {}", layers.empty() ? "" : ",", json_quoted(name), layer_json(error));
    return fmt::format(
        "{{\n  \"picture\": {},\n  \"reference\": {},\n  \"width\": {},\n  \"height\": {},\n  \"layers\": {{{}\n  }},\n"
        "  \"diff\": {},\n  \"tolerance\": {},\n  \"passed\": {}\n}}\n",
        json_quoted(c.picture), json_quoted(c.reference), c.width, c.height, layers, diff_json(c),
        c.tolerance ? number(*c.tolerance) : "null", c.complaint().empty());
}

}  // namespace stokes
