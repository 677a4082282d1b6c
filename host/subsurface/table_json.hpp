// What the files of power tables and of Green's function tables have in common.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/subsurface/power_table.hpp"

namespace stokes {

constexpr const char* table_format = "photon-power-table";
constexpr int table_version = 1;

// The file's first keys.
inline nlohmann::ordered_json table_json(const std::string& model, const std::string& component) {
    return {{"format", table_format}, {"version", table_version}, {"model", model}, {"component", component}};
}

inline nlohmann::ordered_json axes_json(const std::vector<TableAxis>& axes) {
    auto list = nlohmann::ordered_json::array();
    for (const TableAxis& axis : axes)
        list.push_back({{"name", axis.name}, {"unit", axis.unit}, {"values", axis.values}});
    return list;
}

}  // namespace stokes
