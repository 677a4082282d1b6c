#include "host/scene/settings/schema.hpp"

#include <memory>
#include <nlohmann/json.hpp>

#include "host/commands/commands.hpp"
#include "host/core/console.hpp"

namespace stokes {

void add_schema_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("schema", "Print the JSON schema of scene files");
    const auto settings = std::make_shared<bool>(false), table = std::make_shared<bool>(false);
    command->add_flag("--settings", *settings, "Print the settings in its place, by key, with flags and transports");
    command->add_flag("--table", *table, "Print the settings in its place, as scenes/README.md has them");
    command->callback([settings, table] {
        if (*table)
            print(settings_table());
        else
            print(as_lines(*settings ? settings_as_json() : scene_schema()) + "\n");
    });
}

}  // namespace stokes
