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

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Spectral renderer of fluorescence on translucent materials.", "stokes");
    app.set_version_flag("--version", STOKES_VERSION);
    app.require_subcommand(1);
    stokes::add_render_command(app);
    stokes::add_tables_command(app);
    stokes::add_devices_command(app);
    try {
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
