#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "host/commands/commands.hpp"
#include "host/core/error.hpp"
#include "host/scene/scene_reader.hpp"
#include "host/subsurface/power_table_json.hpp"

namespace stokes {
namespace {

namespace fs = std::filesystem;

struct TablesOptions {
    std::string scene;
    std::string folder;
};

void create_folder(const std::string& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw RunError(fmt::format("{}: cannot create folder: {}", folder, error.message()));
}

bool needs_tables(const Material& material) {
    return material.kind == MaterialKind::translucent && material.subsurface && material.medium >= 0;
}

void write_tables(const std::vector<PowerTable>& tables, const std::string& material,
                  const fs::path& folder) {
    for (const PowerTable& table : tables) {
        const std::string path = (folder / fmt::format("{}.{}.json", material, table.component)).string();
        write_power_table(table, path);
        fmt::print("{}\n", path);
        std::fflush(stdout);
    }
}

void run_tables(const TablesOptions& options) {
    const Scene scene = read_scene(options.scene);
    bool any = false;
    for (std::size_t i = 0; i < scene.media.size(); ++i) {
        std::vector<PowerTable> tables;
        for (const Material& material : scene.materials) {
            if (!needs_tables(material) || static_cast<std::size_t>(material.medium) != i) continue;
            if (tables.empty()) {
                const Medium& m = scene.media[i];
                const MediumSpectra medium{m.name, m.sigma_s, m.sigma_a, m.eta, m.dipole_eta};
                tables = {make_fluorescence_table(medium), make_single_table(medium),
                          make_multiple_table(medium)};
                create_folder(options.folder);
            }
            write_tables(tables, material.name, options.folder);
            any = true;
        }
    }
    if (!any)
        throw InputError(fmt::format(
            "{}: no translucent material with subsurface scattering, so no tables to write", options.scene));
}

}  // namespace

void add_tables_command(CLI::App& app) {
    const auto options = std::make_shared<TablesOptions>();
    CLI::App* command =
        app.add_subcommand("tables", "Write the photon power tables of a scene's translucent materials");
    command->add_option("scene", options->scene, "Scene file (JSON)")->required();
    command->add_option("-o,--output", options->folder, "Folder for the tables; created if it is not there")
        ->required();
    command->callback([options] { run_tables(*options); });
}

}  // namespace stokes
