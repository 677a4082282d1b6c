#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <system_error>

#include "host/commands/commands.hpp"
#include "host/commands/number_in.hpp"
#include "host/commands/outputs.hpp"
#include "host/commands/progress.hpp"
#include "host/core/console.hpp"
#include "host/core/error.hpp"
#include "host/render/transport/green_walk.hpp"
#include "host/scene/readers/scene_reader.hpp"
#include "host/subsurface/power_table.hpp"

namespace stokes {
namespace {

namespace fs = std::filesystem;

struct TablesOptions {
    std::string scene;
    std::string output;  // a folder; with green, a file
    bool green = false;
    double eta = 1.0;
    std::uint64_t walks = 1000000;
    std::string device;
    int threads = 0;
};

void create_folder(const std::string& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw RunError(fmt::format("{}: cannot create folder: {}", folder, error.message()));
}

void write_tables(const std::vector<PowerTable>& tables, const std::string& material, const fs::path& folder) {
    for (const PowerTable& table : tables) {
        const std::string path = (folder / fmt::format("{}.{}.json", material, table.component)).string();
        check_keeps_inputs({path});
        write_power_table(table, path);
        note(path + "\n");
    }
}

void run_tables(const TablesOptions& options) {
    const Scene scene = read_scene(options.scene);
    bool any = false;
    for (std::size_t i = 0; i < scene.media.size(); ++i) {
        std::vector<PowerTable> tables;
        for (const Material& material : scene.materials) {
            if (medium_of(material) != static_cast<int>(i)) continue;
            if (tables.empty()) {
                create_folder(options.output);
                const Medium& m = scene.media[i];
                const MediumSpectra medium{m.name, m.sigma_s, m.sigma_a, m.eta, m.dipole_eta};
                tables = {make_fluorescence_table(medium), make_single_table(medium), make_multiple_table(medium)};
            }
            write_tables(tables, material.name, options.output);
            any = true;
        }
    }
    if (!any)
        throw InputError(fmt::format("{}: no translucent material with subsurface scattering, so no tables to write",
                                     options.scene));
}

void run_green(const TablesOptions& options) {
    if (!options.scene.empty()) throw InputError("tables: expected a scene or --green, not both");
    check_outputs({options.output}, "");
    check_endings({{"-o with --green", options.output, ".json.gz"}});
    const Device device = Device::open(options.device, options.threads);
    write_green_table(make_green_table(device, options.eta, options.walks, print_share), options.output);
    note(options.output + "\n");
}

}  // namespace

void add_tables_command(CLI::App& app) {
    const auto options = std::make_shared<TablesOptions>();
    CLI::App* command = app.add_subcommand("tables",
                                           "Write the photon power tables of a scene's translucent "
                                           "materials, or a half-space's Green's function");
    command->add_option("scene", options->scene, "Scene file (JSON)");
    command
        ->add_option("-o,--output", options->output,
                     "Folder for the tables, created if it is not there; with --green, the file")
        ->required()
        ->check(output_name());
    CLI::Option* green = command->add_flag("--green", options->green,
                                           "Compute the Green's function of a half-space by random walks (.json.gz)");
    command->add_option("--eta", options->eta, "Refractive index, 1 to 4")->needs(green);
    command->add_option("--walks", options->walks, "Random walks from each depth")->needs(green);
    command->add_option("--device", options->device, "OpenCL device: platform:device, part of a name, cpu, gpu")
        ->needs(green);
    command->add_option("--threads", options->threads, "CPU threads")->needs(green);
    command->callback([options] {
        if (options->green)
            run_green(*options);
        else if (options->scene.empty())
            throw InputError("tables: expected a scene file, or --green");
        else
            run_tables(*options);
    });
}

}  // namespace stokes
