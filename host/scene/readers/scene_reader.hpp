// Scene files: JSON as scenes/scene.schema.json describes it.
#pragma once

#include <string>
#include <string_view>

#include "host/scene/scene.hpp"
#include "host/scene/settings/settings_reader.hpp"

namespace stokes {

// The scene in a file, complete, checked and in world space. Files that it names are looked for in its own
// folder; flags take the place of its own settings. Throws InputError, one line: "PATH:LINE: KEY.PATH: what was
// expected", or "--FLAG: what was expected".
Scene read_scene(const std::string& path, const FlagValues& flags = {});

// The same from text in memory; path names it in messages and says where its files are.
Scene parse_scene(std::string_view text, const std::string& path, const FlagValues& flags = {});

}  // namespace stokes
