// Photon power tables as JSON files, format "photon-power-table" version 1.
#pragma once

#include <string>

#include "host/subsurface/power_table.hpp"

namespace stokes {

// Writes the table to path, complete or not at all. Numbers keep every bit: read_power_table returns the same
// table. Throws RunError when the file cannot be written.
void write_power_table(const PowerTable& table, const std::string& path);

// Reads and checks a table: format, version, known model and component, that component's axes with their
// units, strictly increasing; as many values as the axes ask for, finite and not negative. Throws InputError
// "PATH: KEY: expected ..." (or with the line, for a syntax error).
PowerTable read_power_table(const std::string& path);

}  // namespace stokes
