#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>

#include "host/commands/commands.hpp"
#include "host/commands/device_flags.hpp"
#include "host/commands/error_curve.hpp"
#include "host/commands/number_in.hpp"
#include "host/commands/outputs.hpp"
#include "host/commands/progress.hpp"
#include "host/commands/setting_flags.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/image/develop.hpp"
#include "host/image/exr.hpp"
#include "host/image/png.hpp"
#include "host/render/assumptions.hpp"
#include "host/render/renderer.hpp"
#include "host/render/stats.hpp"
#include "host/scene/mesh_topology.hpp"
#include "host/scene/scene_reader.hpp"

namespace stokes {

namespace {

volatile std::sig_atomic_t caught_signal = 0;

extern "C" void catch_signal(int signal) {
    if (caught_signal != 0) std::_Exit(128 + signal);  // a second one does not wait
    caught_signal = signal;
}

struct RenderOptions {
    std::string scene_file, exr_file, png_file, stats_file, kernel_directory, reference_file, csv_file;
    int every = 0;
    DeviceFlags device;
    FlagValues settings;
    double max_memory_gib = 0.0;
    bool quiet = false;
};

// Left, top, width, height.
std::string crop_text(const Crop& crop) {
    return fmt::format("{} {} {} {}", crop.left, crop.top, crop.width, crop.height);
}

Metadata exr_metadata(const Scene& scene, const RenderStats& stats, double exposure_ev) {
    return {{"stokes.version", std::string(STOKES_VERSION)},
            {"stokes.scene", stats.scene},
            {"stokes.device", stats.device},
            {"stokes.transport", stats.transport},
            {"stokes.wavelengths", stats.wavelengths},
            {"stokes.branches", stats.branches},
            {"stokes.distances", stats.distances},
            {"stokes.exits", stats.exits},
            {"stokes.emission", stats.emission},
            {"stokes.direct", stats.direct},
            {"stokes.radii", stats.radii},
            {"stokes.passes", static_cast<int>(stats.passes)},
            {"stokes.photonsPerPass", static_cast<double>(scene.render.photons_per_pass)},
            {"stokes.seed", static_cast<double>(stats.seed)},
            {"stokes.alpha", stats.alpha},
            {"stokes.radiusFirst_mm", stats.radius_first_mm},
            {"stokes.radiusLast_mm", stats.radius_last_mm},
            {"stokes.lambdaMin_nm", scene.render.lambda_min_nm},
            {"stokes.lambdaMax_nm", scene.render.lambda_max_nm},
            {"stokes.exposure_ev", exposure_ev},
            {"stokes.crop", crop_text(scene.camera.crop)},
            {"stokes.wall_s", stats.wall_s}};
}

RenderStats collect_stats(const Scene& scene, const Device& device, const Renderer& renderer) {
    const ResolvedSettings settings = resolved(scene.render);
    RenderStats stats;
    stats.scene = scene.file;
    stats.device = device.description().name;
    stats.driver = device.description().platform + " " + device.description().driver;
    stats.ray_kernel = word_of(device.ray_shape());
    stats.transport = word_of(scene.render.transport);
    stats.tables = settings.tables;
    stats.wavelengths = word_of(settings.wavelengths);
    stats.branches = word_of(settings.branches);
    stats.distances = word_of(settings.distances);
    stats.exits = settings.exits;
    stats.emission = word_of(settings.emission);
    stats.direct = word_of(settings.direct);
    stats.radii = word_of(settings.radii);
    stats.passes = renderer.passes();
    stats.seed = scene.render.seed;
    stats.width = scene.film.width;
    stats.height = scene.film.height;
    stats.photons_emitted = renderer.book().photons();
    stats.rays_traced = renderer.book().rays() + renderer.camera_rays();
    stats.deposits = renderer.book().deposits();
    stats.dropped = renderer.book().dropped();
    stats.ledger = renderer.book().ledger();
    stats.alpha = scene.render.alpha;
    stats.radius_first_mm = renderer.first_radius();
    stats.radius_last_mm = renderer.radius_of(renderer.passes() - 1);
    stats.device_memory_bytes = device.memory_in_use();
    for (const auto& [kernel, time] : device.stage_times()) stats.stages[kernel] = time.seconds;
    return stats;
}

void say_what_was_dropped(const RenderStats& stats) {
    std::string causes;
    for (const auto& [cause, count] : stats.dropped)
        if (count > 0) causes += fmt::format("{}{} {}", causes.empty() ? "" : ", ", count, cause);
    if (!causes.empty())
        fmt::print(stderr, "dropped: {} of {} deposits and {} photons\n", causes, stats.deposits,
                   stats.photons_emitted);
}

void write_results(const RenderOptions& options, const Scene& scene, const FilmImage& film, const RenderStats& stats,
                   const ErrorCurve* curve) {
    if (const std::size_t bad = count_non_finite(film))
        warn(fmt::format("{} pixels are not finite and are shown black", bad));
    const double exposure = scene.film.exposure_ev ? *scene.film.exposure_ev : automatic_exposure_ev(film);
    const auto write_picture = [&] { write_exr(options.exr_file, film, exr_metadata(scene, stats, exposure)); };
    const auto write_developed = [&] {
        write_png(options.png_file, develop(film, exposure), {{"Software", "stokes " STOKES_VERSION}});
    };
    const auto write_figures = [&] { write_stats(stats, options.stats_file); };
    write_outputs({{options.exr_file, write_picture},
                   {options.png_file, write_developed},
                   {options.stats_file, write_figures},
                   {options.csv_file, [&] { curve->write(); }}},
                  options.quiet);
}

Device open_device_for(const RenderOptions& options) {
    Device device = open_device(options.device);
    device.set_kernel_directory(options.kernel_directory);
    if (options.max_memory_gib > 0.0)
        device.set_memory_budget(static_cast<std::uint64_t>(options.max_memory_gib * (1 << 30)));
    return device;
}

// None when a signal came meanwhile.
std::unique_ptr<Renderer> set_up(Device& device, const Scene& scene) {
    device.set_stop([] { return caught_signal != 0; });
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
    for (std::uint32_t pass = 0; pass < static_cast<std::uint32_t>(passes) && caught_signal == 0; ++pass) {
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
    if (options.csv_file.empty()) return nullptr;
    return std::make_unique<ErrorCurve>(options.reference_file, options.csv_file, options.every, film);
}

void render(const RenderOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<std::string> outputs = {options.exr_file, options.png_file, options.stats_file, options.csv_file};
    if (std::all_of(outputs.begin(), outputs.end(), [](const std::string& file) { return file.empty(); }))
        throw InputError("render: expected an output, -o OUT.exr, --png OUT.png, --stats FILE.json or --csv FILE.csv");
    check_outputs(outputs, options.scene_file);
    check_keeps(outputs, options.reference_file, "the reference");
    const Scene scene = read_scene(options.scene_file, options.settings);
    if (scene.render.transport == Transport::walk) check_walkable(scene);  // before the device is opened
    const std::unique_ptr<ErrorCurve> curve = make_curve(options, scene.film);
    warn_about_models(scene);
    warn_about_assumptions(scene);
    std::signal(SIGINT, catch_signal);
    std::signal(SIGTERM, catch_signal);
    Device device = open_device_for(options);
    Progress progress(static_cast<std::uint32_t>(scene.render.passes), options.quiet);
    progress.preparing();
    const std::unique_ptr<Renderer> renderer = set_up(device, scene);
    const double set_up_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    progress.start();
    if (renderer) render_passes(*renderer, device, scene.render.passes, progress, curve.get());
    const double wall_s = progress.elapsed_s(), processor_s = progress.processor_s();
    if (!renderer || renderer->passes() == 0) {
        progress.finish();
        fmt::print(stderr, "stokes: interrupted before the first pass: nothing was written\n");
        return;
    }
    const FilmImage film = renderer->image();
    RenderStats stats = collect_stats(scene, device, *renderer);
    stats.wall_s = wall_s;
    stats.processor_s = processor_s;
    stats.trials_processor_s = renderer->trials_processor_s();
    stats.set_up_s = set_up_s;
    if (!options.quiet) say_what_was_dropped(stats);
    warn_about(stats.ledger);
    write_results(options, scene, film, stats, curve.get());
}

}  // namespace

int interrupted_signal() { return caught_signal; }

void add_render_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("render", "Render a scene");
    const auto options = std::make_shared<RenderOptions>();
    command->add_option("scene", options->scene_file, "Scene file")->required()->type_name("SCENE.json");
    command->add_option("-o,--output", options->exr_file, "OpenEXR picture, one layer a component")
        ->type_name("OUT.exr");
    command->add_option("--png", options->png_file, "Picture for the screen")->type_name("OUT.png");
    command->add_option("--stats", options->stats_file, "Figures of the render")->type_name("FILE.json");
    CLI::Option* reference =
        command->add_option("--rmse-against", options->reference_file, "Measure the error against this picture")
            ->type_name("REF.exr");
    CLI::Option* csv =
        command->add_option("--csv", options->csv_file, "Error after 1, 2, 4 .. passes, written while it renders")
            ->type_name("FILE.csv")
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
