// stokes: spectral rendering of fluorescence on translucent materials.
#include <CLI/CLI.hpp>
#include <exception>
#include <new>
#include <sstream>

#include "host/commands/commands.hpp"
#include "host/core/console.hpp"
#include "host/core/error.hpp"
#include "host/core/memory_limit.hpp"
#include "host/core/signals.hpp"

namespace {

int report(const std::string& text, int code) {
    stokes::tell("stokes: " + text + "\n");
    return code;
}

// One line, whatever names of files are in it.
std::string one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
    return text;
}

// --help and --version.
int show(const CLI::App& app, const CLI::ParseError& asked) {
    std::ostringstream out, err;
    app.exit(asked, out, err);
    stokes::print(out.str());
    return 0;
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

int run(CLI::App& app, int argc, char** argv) {
    try {
        check_subcommand(app, argc, argv);
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return show(app, error);
        return report(one_line(error.what()) + "; stokes --help lists what there is", 2);
    } catch (const stokes::InputError& error) {
        return report(one_line(error.what()), 2);
    }
    const int signal = stokes::caught_signal();
    return signal == 0 ? 0 : 128 + signal;
}

}  // namespace

int main(int argc, char** argv) {
    stokes::prepare_standard_streams();
    stokes::watch_memory();
    stokes::watch_signals();
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
        return run(app, argc, argv);
    } catch (const std::bad_alloc&) {
        stokes::end_for_lack_of_memory(argv[1]);
    } catch (const std::exception& error) {
        return report(error.what(), 1);
    }
}
