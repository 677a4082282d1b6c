// The text of JSON files.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace stokes {

// Members keep their order, bytes that are not UTF-8 become U+FFFD, and numbers that are not finite become null, so
// that the file is valid whatever a path or a driver's name holds. indent: blanks a level; -1 for a single line.
inline std::string json_text(const nlohmann::ordered_json& json, int indent = 2) {
    return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace stokes
