// stokes: spectral rendering of fluorescence on translucent materials.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "host/commands/commands.hpp"
#include "host/core/error.hpp"

namespace {

// One line, whatever the text.
int report(const char* text, int code) {
    std::fprintf(stderr, "stokes: %s\n", text);
    return code;
}

std::string subcommand_names(const CLI::App& app) {
    std::string names;
    for (const CLI::App* command : app.get_subcommands({})) names += (names.empty() ? "" : ", ") + command->get_name();
    return names;
}

// What CLI11 would say of a wrong word in a subcommand's place is that there is no subcommand.
void check_subcommand(const CLI::App& app, int argc, char** argv) {
    if (argc < 2) throw stokes::InputError("expected a subcommand: " + subcommand_names(app));
    const std::string word = argv[1];
    for (const CLI::App* command : app.get_subcommands({}))
        if (command->get_name() == word) return;
    if (!word.empty() && word[0] == '-') return;
    throw stokes::InputError("\"" + word + "\" is no subcommand; there are: " + subcommand_names(app));
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Spectral renderer of fluorescence on translucent materials.", "stokes");
    app.set_version_flag("--version", STOKES_VERSION);
    app.require_subcommand(1);
    stokes::add_render_command(app);
    stokes::add_tables_command(app);
    stokes::add_probe_command(app);
    stokes::add_compare_command(app);
    stokes::add_devices_command(app);
    stokes::add_schema_command(app);
    try {
        check_subcommand(app, argc, argv);
        app.parse(argc, argv);
        return stokes::interrupted_signal() == 0 ? 0 : 128 + stokes::interrupted_signal();
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
        return report((std::string(error.what()) + "; stokes --help lists what there is").c_str(), 2);
    } catch (const stokes::InputError& error) {
        return report(error.what(), 2);
    } catch (const std::exception& error) {
        return report(error.what(), 1);
    }
}
