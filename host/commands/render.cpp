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
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/image/develop.hpp"
#include "host/image/exr.hpp"
#include "host/image/png.hpp"
#include "host/render/assumptions.hpp"
#include "host/render/renderer.hpp"
#include "host/render/stats.hpp"
#include "host/scene/mesh/mesh_topology.hpp"
#include "host/scene/readers/scene_reader.hpp"

namespace stokes {

namespace {

volatile std::sig_atomic_t caught_signal = 0;

extern "C" void catch_signal(int signal) {
    if (caught_signal != 0) std::_Exit(128 + signal);  // a second one does not wait
    caught_signal = signal;
}

struct RenderOptions {
    std::string scene_file, exr_file, png_file, stats_file, kernel_directory, size, transport;
    std::string reference_file, csv_file, sampling, wavelengths, branches, distances, emission, direct, radii;
    int passes = 0, every = 0, exits = 0;
    DeviceFlags device;
    std::int64_t photons = 0;
    std::uint32_t seed = 0;
    double alpha = 0.0, radius_mm = 0.0, exposure_ev = 0.0, max_memory_gib = 0.0;
    bool quiet = false, no_tables = false;
};

// What was given on the command line takes the place of what the scene says.
void apply(const CLI::App& command, const RenderOptions& options, Scene& scene) {
    RenderSettings& render = scene.render;
    if (command.count("--passes")) render.passes = options.passes;
    if (command.count("--photons")) render.photons_per_pass = options.photons;
    if (command.count("--seed")) render.seed = options.seed;
    if (command.count("--alpha")) render.alpha = options.alpha;
    if (command.count("--radius")) render.radius_mm = options.radius_mm;
    if (command.count("--transport"))
        render.transport = static_cast<Transport>(index_of_word(options.transport, transport_words));
    const auto expect_transport = [&](const std::string& flag, const std::string& expected, bool fits) {
        if (!fits)
            throw InputError(fmt::format("{}: expected transport {}, got \"{}\"", flag, expected,
                                         transport_words[static_cast<std::size_t>(render.transport)]));
    };
    if (options.no_tables) {
        expect_transport("--no-tables", "\"paper\"", render.transport == Transport::paper);
        render.tables = false;
    }
    if (command.count("--sampling")) {
        render.sampling = static_cast<Sampling>(index_of_word(options.sampling, sampling_words));
        render.wavelengths.reset();
        render.branches.reset();
        render.distances.reset();
        render.exits.reset();
        render.emission.reset();
        render.direct.reset();
        render.radii.reset();
    }
    if (command.count("--wavelengths"))
        render.wavelengths = static_cast<Wavelengths>(index_of_word(options.wavelengths, wavelengths_words));
    if (command.count("--branches")) {
        expect_transport("--branches", "\"paper\" or \"conserving\"", render.transport != Transport::walk);
        render.branches = static_cast<Branches>(index_of_word(options.branches, branches_words));
    }
    if (command.count("--distances")) {
        expect_transport("--distances", "\"paper\"", render.transport == Transport::paper);
        if (!render.tables) throw InputError("--distances: expected power tables, got --no-tables");
        render.distances = static_cast<Distances>(index_of_word(options.distances, distances_words));
    }
    if (command.count("--exits")) {
        expect_transport("--exits", "\"conserving\"", render.transport == Transport::conserving);
        render.exits = options.exits;
    }
    if (command.count("--emission"))
        render.emission = static_cast<Emission>(index_of_word(options.emission, emission_words));
    if (command.count("--direct")) render.direct = static_cast<Direct>(index_of_word(options.direct, direct_words));
    if (command.count("--radii")) render.radii = static_cast<Radii>(index_of_word(options.radii, radii_words));
    if (command.count("--exposure")) scene.film.exposure_ev = options.exposure_ev;
    if (command.count("--size")) {
        char rest = 0;
        int width = 0, height = 0;
        if (std::sscanf(options.size.c_str(), "%5dx%5d%c", &width, &height, &rest) != 2 || width < 1 || height < 1 ||
            width > 16384 || height > 16384)
            throw InputError("--size: expected WIDTHxHEIGHT in pixels, each 1 to 16384, got \"" + options.size + "\"");
        scene.film.width = width;
        scene.film.height = height;
    }
}

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
    RenderStats stats;
    stats.scene = scene.file;
    stats.device = device.description().name;
    stats.driver = device.description().platform + " " + device.description().driver;
    stats.ray_kernel = ray_shape_words[static_cast<std::size_t>(device.ray_shape())];
    stats.transport = transport_words[static_cast<std::size_t>(scene.render.transport)];
    stats.tables = scene.render.transport != Transport::walk && scene.render.tables;
    stats.wavelengths = wavelengths_words[static_cast<std::size_t>(chosen_wavelengths(scene.render))];
    stats.branches = branches_words[static_cast<std::size_t>(chosen_branches(scene.render))];
    stats.distances = distances_words[static_cast<std::size_t>(chosen_distances(scene.render))];
    stats.exits = chosen_exits(scene.render);
    stats.emission = emission_words[static_cast<std::size_t>(chosen_emission(scene.render))];
    stats.direct = direct_words[static_cast<std::size_t>(chosen_direct(scene.render))];
    stats.radii = radii_words[static_cast<std::size_t>(chosen_radii(scene.render))];
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

void render(const CLI::App& command, const RenderOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<std::string> outputs = {options.exr_file, options.png_file, options.stats_file, options.csv_file};
    if (std::all_of(outputs.begin(), outputs.end(), [](const std::string& file) { return file.empty(); }))
        throw InputError("render: expected an output, -o OUT.exr, --png OUT.png, --stats FILE.json or --csv FILE.csv");
    check_outputs(outputs, options.scene_file);
    check_keeps(outputs, options.reference_file, "the reference");
    Scene scene = read_scene(options.scene_file);
    apply(command, options, scene);
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
    command->add_option("--passes", options->passes, "Passes")->check(CLI::Range(1, 100000000));
    command->add_option("--photons", options->photons, "Photons per pass")
        ->check(number_in(1, static_cast<double>(most_photons_per_pass)));
    command->add_option("--size", options->size, "Picture size in pixels")->type_name("WxH");
    const auto add_choice = [&](const std::string& flag, std::string& word, const std::vector<std::string>& words,
                                const std::string& help, const std::string& type = "HOW") {
        command->add_option(flag, word, help)->type_name(type)->check(word_of(words));
    };
    add_choice("--transport", options->transport, transport_words, "How light travels below translucent surfaces",
               "MODEL");
    command->add_flag("--no-tables", options->no_tables,
                      "Model paper: every photon integrates its power itself, in place of the tables");
    add_choice("--sampling", options->sampling, sampling_words,
               "Plain samplers, or those with the least noise; default: best", "KIND");
    add_choice("--wavelengths", options->wavelengths, wavelengths_words,
               "How a pass draws its wavelengths; default: importance, for transport paper uniform");
    add_choice("--branches", options->branches, branches_words,
               "What a photon stores where it enters: one branch, or both; default: both with conserving");
    add_choice("--distances", options->distances, distances_words,
               "Transport paper: how far light leaves from its entry, from the power table or where more of it leaves; "
               "default: importance");
    command->add_option("--exits", options->exits, "Transport conserving: exit points an entry; default 1")
        ->type_name("N")
        ->check(CLI::Range(1, most_exits));
    add_choice("--emission", options->emission, emission_words,
               "Where photons start: at random, evenly spread, or also where the camera sees their light; default: "
               "aimed");
    add_choice("--direct", options->direct, direct_words,
               "Light straight from the lights on diffuse surfaces: by photons, or by shadow rays; default: rays");
    add_choice("--radii", options->radii, radii_words,
               "Radius of the density estimate: one for the picture, or larger where photons are few; default: one");
    command->add_option("--seed", options->seed, "Seed of the random numbers");
    command->add_option("--alpha", options->alpha, "How fast the radius shrinks, 0 to 1; default 2/3")
        ->check(number_in(1e-6, 1.0));
    command->add_option("--radius", options->radius_mm, "First radius of the density estimate [mm]")
        ->check(number_in(1e-6, 1e7));
    command->add_option("--exposure", options->exposure_ev, "Exposure of the PNG; default: automatic")
        ->type_name("EV")
        ->check(number_in(-100.0, 100.0));
    add_device_flags(*command, options->device);
    command->add_option("--max-memory", options->max_memory_gib, "Device memory to use at most; default: 3/4 of it")
        ->type_name("GiB")
        ->check(number_in(1e-3, 1e6));
    command->add_option("--kernel-dir", options->kernel_directory, "Read the kernels from here, for development")
        ->check(CLI::ExistingDirectory);
    command->add_flag("--quiet", options->quiet, "Print nothing but errors and warnings");
    command->callback([command, options] { render(*command, *options); });
}

}  // namespace stokes
