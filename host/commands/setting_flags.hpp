// The settings of the table as options of the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "host/scene/settings/settings_reader.hpp"

namespace stokes {

// Those with these keys, or all where none are named. flags has to live until the command line is parsed; whoever reads
// the scene checks the values.
void add_setting_flags(CLI::App& command, FlagValues& flags, const std::vector<std::string>& keys = {});

// --size WxH: width and height together.
void add_size_flag(CLI::App& command, FlagValues& flags);

}  // namespace stokes
