// scenes/scene.schema.json, from the tables of settings and of objects.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace stokes {

// JSON schema, draft 2020-12, of scene files.
nlohmann::ordered_json scene_schema();

// On one line what fits there.
std::string as_lines(const nlohmann::ordered_json& json, const std::string& indent = "");

// The settings for programs: by key, its flags, transports, words or range, default, and sentence.
nlohmann::ordered_json settings_as_json();

// The settings as a table of Markdown, which scenes/README.md holds.
std::string settings_table();

}  // namespace stokes
