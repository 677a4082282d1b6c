// The settings of a scene file and of the command line.
#pragma once

#include <map>
#include <string>

#include "host/core/json_cursor.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

// Settings from the command line, by key, each with the flag that gave it.
struct FlagValue {
    std::string flag;
    JsonValue value;
};
using FlagValues = std::map<std::string, FlagValue>;

// Reads the settings of a scene file, then those of the flags, which take their place. InputError at the key or flag
// whose value is out of its bounds, or which the chosen transport has not.
void read_settings(const JsonCursor& root, const FlagValues& flags, Scene& scene);
// The same without a scene file.
void read_settings(const FlagValues& flags, Scene& scene);

}  // namespace stokes
