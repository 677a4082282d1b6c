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

// SIGINT or SIGTERM if one ended a render early, 0 otherwise.
int interrupted_signal();

}  // namespace stokes
