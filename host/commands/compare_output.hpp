// What `stokes compare` prints.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/image/compare.hpp"
#include "host/image/error_map.hpp"

namespace stokes {

struct Comparison {
    std::string picture, reference;  // files
    int width = 0, height = 0;
    std::vector<std::pair<std::string, LayerError>> layers;  // by shown_layer name, in the order of the files
    std::optional<double> tolerance;                         // of relative_rmse
    std::string diff_file, diff_layer;                       // empty: no map
    ErrorMap diff;

    // Why the pictures do not pass, in one line: relative errors above the tolerance, pixels that are not finite.
    // Empty when they do.
    std::string complaint() const;
};

// For a person: a line for each layer.
std::string comparison_table(const Comparison& comparison);

// What the colours of the map mean, in one line.
std::string scale_text(const ErrorMap& map, const std::string& layer);

// The whole as JSON; scenes/COMMANDS.md describes the keys. Numbers that are infinite or undefined are null.
std::string comparison_json(const Comparison& comparison);

}  // namespace stokes
