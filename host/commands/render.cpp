#include <algorithm>
#include <chrono>
#include <memory>

#include "host/commands/commands.hpp"
#include "host/commands/device_flags.hpp"
#include "host/commands/number_in.hpp"
#include "host/commands/outputs.hpp"
#include "host/commands/progress.hpp"
#include "host/commands/render_outputs.hpp"
#include "host/commands/setting_flags.hpp"
#include "host/core/console.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/signals.hpp"
#include "host/render/assumptions.hpp"
#include "host/render/conflicts.hpp"
#include "host/render/ignored_keys.hpp"
#include "host/render/renderer.hpp"
#include "host/render/stats.hpp"
#include "host/render/translucent_bodies.hpp"
#include "host/render/transport/transport_model.hpp"
#include "host/scene/readers/scene_reader.hpp"

namespace stokes {

namespace {

struct RenderOptions {
    std::string scene_file, kernel_directory, reference_file;
    OutputFiles files;
    int every = 0;
    DeviceFlags device;
    FlagValues settings;
    double max_memory_gib = 0.0;
    bool quiet = false;
};

Device open_device_for(const RenderOptions& options) {
    Device device = open_device(options.device);
    device.set_kernel_directory(options.kernel_directory);
    if (options.max_memory_gib > 0.0)
        device.set_memory_budget(static_cast<std::uint64_t>(options.max_memory_gib * (1 << 30)));
    return device;
}

// None when a signal came meanwhile.
std::unique_ptr<Renderer> set_up(Device& device, const Scene& scene) {
    device.set_stop([] { return caught_signal() != 0; });
    try {
        auto renderer = std::make_unique<Renderer>(device, scene);
        device.finish();
        device.set_stop({});  // a pass that has begun is finished
        return renderer;
    } catch (const Interrupted&) {
        return nullptr;
    }
}

void render_passes(Renderer& renderer, const Device& device, int passes, Progress& progress, ErrorCurve* curve) {
    const auto measure = [&] {
        const double elapsed_s = progress.elapsed_s();
        progress.pause([&] { curve->add(renderer.passes(), elapsed_s, renderer.image()); });
    };
    for (std::uint32_t pass = 0; pass < static_cast<std::uint32_t>(passes) && caught_signal() == 0; ++pass) {
        renderer.render_pass(pass);
        device.finish();
        progress.update(pass + 1, renderer.book().photons());
        if (curve && curve->due(pass + 1)) measure();
    }
    if (curve && curve->last() != renderer.passes()) measure();
    progress.finish();
}

// None where none was asked for.
std::unique_ptr<ErrorCurve> make_curve(const RenderOptions& options, const Film& film) {
    if (options.files.csv.empty()) return nullptr;
    return std::make_unique<ErrorCurve>(options.reference_file, options.files.csv, options.every, film);
}

void render(const RenderOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<std::string> outputs = {options.files.exr, options.files.png, options.files.stats,
                                              options.files.csv};
    if (std::all_of(outputs.begin(), outputs.end(), [](const std::string& file) { return file.empty(); }))
        throw InputError("render: expected an output, -o OUT.exr, --png OUT.png, --stats FILE.json or --csv FILE.csv");
    check_outputs(outputs, options.scene_file);
    check_keeps(outputs, options.reference_file, "the reference");
    check_endings({{"-o", options.files.exr, ".exr"},
                   {"--png", options.files.png, ".png"},
                   {"--stats", options.files.stats, ".json"},
                   {"--csv", options.files.csv, ".csv"}});
    set_at_stake(AtStake::set_up);
    const Scene scene = read_scene(options.scene_file, options.settings);
    for (const Transport transport : transports_of(scene)) transport_model(transport).check(scene);
    for (const std::string& line : find_conflicts(scene)) warn(line);
    const std::unique_ptr<ErrorCurve> curve = make_curve(options, scene.film);
    for (const Transport transport : transports_of(scene))
        for (const std::string& line : transport_model(transport).remarks(scene)) warn(line);
    for (const std::string& line : ignored_keys(scene)) warn(line);
    if (const std::string line = unused_objects(scene); !line.empty() && !options.quiet)
        tell("stokes: note: " + line + "\n");
    for (const std::string& line : failed_assumptions(scene)) warn(line);
    check_keeps_inputs(outputs);
    Device device = open_device_for(options);
    Progress progress(static_cast<std::uint32_t>(scene.render.passes), options.quiet);
    progress.preparing();
    const std::unique_ptr<Renderer> renderer = set_up(device, scene);
    if (renderer)
        for (const std::string& line : black_back_lines(scene, renderer->seen_sides())) warn(line);
    const double set_up_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    progress.start();
    if (renderer) set_at_stake(AtStake::passes);
    if (renderer) render_passes(*renderer, device, scene.render.passes, progress, curve.get());
    const double wall_s = progress.elapsed_s(), processor_s = progress.processor_s();
    if (!renderer || renderer->passes() == 0) {
        tell(interrupted_in_set_up);
        return;
    }
    const FilmImage film = renderer->image();
    RenderStats stats = collect_stats(scene, device, *renderer);
    stats.wall_s = wall_s;
    stats.processor_s = processor_s;
    stats.set_up_s = set_up_s;
    const auto words = [&] {
        if (!options.quiet) say_what_was_dropped(stats);
        warn_about(stats.ledger, renderer->emitted_part());
        for (const std::string& line : unmet_body_lines(scene, renderer->unmet_bodies())) warn(line);
        warn_about(film);
    };
    try {
        write_results(options.files, scene, film, stats, curve.get(), options.quiet);
    } catch (...) {
        words();
        throw;
    }
    words();
}

}  // namespace

void add_render_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("render", "Render a scene");
    const auto options = std::make_shared<RenderOptions>();
    command->add_option("scene", options->scene_file, "Scene file")->required()->type_name("SCENE.json");
    command->add_option("-o,--output", options->files.exr, "OpenEXR picture, one layer a component")
        ->type_name("OUT.exr")
        ->check(output_name());
    command->add_option("--png", options->files.png, "Picture for the screen")
        ->type_name("OUT.png")
        ->check(output_name());
    command->add_option("--stats", options->files.stats, "Figures of the render")
        ->type_name("FILE.json")
        ->check(output_name());
    CLI::Option* reference =
        command->add_option("--rmse-against", options->reference_file, "Measure the error against this picture")
            ->type_name("REF.exr");
    CLI::Option* csv =
        command->add_option("--csv", options->files.csv, "Error after 1, 2, 4 .. passes, written while it renders")
            ->type_name("FILE.csv")
            ->check(output_name())
            ->needs(reference);
    reference->needs(csv);
    command->add_option("--every", options->every, "Error after every N passes instead")
        ->type_name("N")
        ->check(CLI::Range(1, 100000000))
        ->needs(reference);
    add_setting_flags(*command, options->settings);
    add_size_flag(*command, options->settings);
    add_device_flags(*command, options->device);
    command->add_option("--max-memory", options->max_memory_gib, "Device memory to use at most; default: 3/4 of it")
        ->type_name("GiB")
        ->check(number_in(1e-3, 1e6));
    command->add_option("--kernel-dir", options->kernel_directory, "Read the kernels from here, for development")
        ->check(CLI::ExistingDirectory);
    command->add_flag("--quiet", options->quiet, "Print nothing but errors and warnings");
    command->callback([options] { render(*options); });
}

}  // namespace stokes
