// The subcommands; each registers its options, and its work runs when the command line names it.
#pragma once

#include <CLI/CLI.hpp>

namespace stokes {

void add_render_command(CLI::App& app);
void add_tables_command(CLI::App& app);
void add_probe_command(CLI::App& app);
void add_compare_command(CLI::App& app);
void add_devices_command(CLI::App& app);
void add_schema_command(CLI::App& app);

}  // namespace stokes
