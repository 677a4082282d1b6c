#include "host/render/probe.hpp"

#include <fmt/core.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "host/commands/commands.hpp"
#include "host/commands/device_flags.hpp"
#include "host/commands/material_flags.hpp"
#include "host/commands/number_in.hpp"
#include "host/commands/outputs.hpp"
#include "host/commands/probe_output.hpp"
#include "host/commands/progress.hpp"
#include "host/commands/setting_flags.hpp"
#include "host/core/atomic_file.hpp"
#include "host/core/console.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/render/ignored_keys.hpp"
#include "host/scene/readers/scene_reader.hpp"

namespace stokes {

namespace {

struct ProbeOptions {
    std::string scene_file, material, json_file, matrix_file;
    DeviceFlags device;
    int lambda_nm = 365;
    double r_max_mm = 0.0;
    MaterialFlags flags;
    FlagValues render;
    ProbeSettings settings;
    bool quiet = false;
};

ProbeSettings settings_of(const CLI::App& command, const ProbeOptions& options, const RenderSettings& given) {
    const ResolvedSettings render = resolved(given);
    ProbeSettings settings = options.settings;
    settings.transport = render.transport;
    settings.first_collision_only = render.first_collision_only;
    settings.seed = render.seed;
    settings.lambda_min_nm = render.lambda_min_nm;
    settings.lambda_max_nm = render.lambda_max_nm;
    if (command.count("--r-max")) settings.r_max_mm = options.r_max_mm;
    return settings;
}

void check_source(const CLI::App& command, const ProbeOptions& options) {
    const bool scene = !options.scene_file.empty(), flags = has_material_flags(command);
    if (scene && flags) throw InputError("probe: expected a scene or the material by flags, not both");
    if (scene && options.material.empty())
        throw InputError("probe: expected --material, a name in " + options.scene_file);
    if (!scene && !options.material.empty()) throw InputError("--material: expected a scene that has it");
    if (!scene && !flags)
        throw InputError("probe: expected a scene and --material, or a material by --sigma-s and --sigma-a");
}

void warn_of_drops(const ProbeResult& result) {
    if (result.dropped > 1e-4)
        warn(
            fmt::format("{} nm: {:.2g} of the light was cut off: it left beyond the sheet's edge, or no room or no "
                        "time was left for it",
                        result.lambda_ex_nm, result.dropped));
}

// What the transport makes nothing of: keys of the material, its medium and its fluorophores, or flags.
void warn_of_ignored(const CLI::App& command, const Scene& scene, const std::string& name, Transport transport) {
    for (const Material& material : scene.materials)
        if (material.name == name)
            for (const std::string& line : ignored_keys(scene, material, transport)) warn(line);
    if (transport != Transport::paper) return;
    for (const char* flag : {"--fresnel", "--quantum-yield"})
        if (command.count(flag)) warn(fmt::format("transport \"{}\" ignores {}", word_of(transport), flag));
}

std::vector<ProbeResult> sweep(HalfSpaceProbe& probe, bool quiet) {
    std::vector<ProbeResult> results;
    const std::vector<int>& grid = probe.grid_nm();
    for (const int lambda : grid) {
        if (!quiet) print_share(static_cast<double>(results.size()) / static_cast<double>(grid.size()));
        results.push_back(probe.measure(lambda));
        warn_of_drops(results.back());
    }
    if (!quiet) print_share(1.0);
    return results;
}

void run_probe(const CLI::App& command, const ProbeOptions& options) {
    check_source(command, options);
    const std::vector<std::string> outputs = {options.json_file, options.matrix_file};
    check_outputs(outputs, options.scene_file);
    check_endings({{"--json", options.json_file, ".json"}, {"--matrix", options.matrix_file, ".csv"}});
    ProbeMaterial material;
    Scene scene;
    if (options.scene_file.empty()) {
        material = material_of(command, options.flags);
    } else {
        scene = read_scene(options.scene_file);
        material = probe_material(scene, options.material);
    }
    check_keeps_inputs(outputs);
    read_settings(options.render, scene);
    const ProbeSettings settings = settings_of(command, options, scene.render);
    warn_of_ignored(command, scene, options.material, settings.transport);
    const Device device = open_device(options.device);
    HalfSpaceProbe probe(device, material, settings);
    const ProbeResult result = probe.measure(options.lambda_nm);
    warn_of_drops(result);
    Attempts attempts;
    std::string written;
    const auto write = [&](const std::string& file, const auto& text) {
        if (!file.empty() && attempts.take([&] { write_file_atomically(file, text()); })) written += file + "\n";
    };
    write(options.json_file, [&] { return probe_json(result, material, settings); });
    if (!options.quiet) attempts.take([&] { print(probe_table(result, material, settings)); });
    if (!options.matrix_file.empty()) {
        const std::vector<ProbeResult> matrix = sweep(probe, options.quiet);
        write(options.matrix_file, [&] { return probe_matrix_csv(matrix, material, settings); });
    }
    if (!options.quiet) note(written);
    attempts.finish();
}

}  // namespace

void add_probe_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "probe", "Measure what a half-space of a translucent material sends back of a narrow beam of one wavelength");
    const auto options = std::make_shared<ProbeOptions>();
    ProbeSettings& settings = options->settings;
    command->add_option("scene", options->scene_file, "Scene file")->type_name("SCENE.json");
    command->add_option("--material", options->material, "Translucent material of the scene")->type_name("NAME");
    add_material_flags(*command, options->flags);
    add_setting_flags(*command, options->render,
                      {"transport", "first_collision_only", "seed", "lambda_min_nm", "lambda_max_nm"});
    command->add_option("--lambda", options->lambda_nm, "Wavelength of the beam [nm]; default 365")
        ->type_name("NM")
        ->check(CLI::Range(first_lambda_nm, last_lambda_nm));
    command->add_option("--angle", settings.angle_deg, "Angle of incidence [deg]; default 0")
        ->type_name("DEG")
        ->check(number_in(0.0, 89.9));
    command->add_option("--photons", settings.photons, "Photons for each set of 16 wavelengths; default 1000000")
        ->check(number_in(least_probe_photons, 1e12));
    command->add_option("--step", settings.step_nm, "Step of the wavelengths that are read [nm]; default 5")
        ->type_name("NM")
        ->check(CLI::Range(1, 50));
    command->add_option("--bins", settings.bins, "Bins of distance from the beam; default 40")
        ->check(CLI::Range(2, 10000));
    command->add_option("--r-max", options->r_max_mm, "End of the last of them [mm]; default: from the material")
        ->type_name("MM")
        ->check(number_in(1e-9, 1e12));
    command->add_option("--json", options->json_file, "All that was measured")
        ->type_name("FILE.json")
        ->check(output_name());
    command
        ->add_option("--matrix", options->matrix_file,
                     "Sweep the beam's wavelength too, and write the effective re-radiation matrix")
        ->type_name("FILE.csv")
        ->check(output_name());
    add_device_flags(*command, options->device);
    command->add_flag("--quiet", options->quiet, "Print nothing but errors and warnings");
    command->callback([command, options] { run_probe(*command, *options); });
}

}  // namespace stokes
