#include "host/commands/render_outputs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "host/commands/outputs.hpp"
#include "host/core/console.hpp"
#include "host/core/log.hpp"
#include "host/image/develop.hpp"
#include "host/image/exr.hpp"
#include "host/image/png.hpp"

namespace stokes {

namespace {

// Left, top, width, height.
std::string crop_text(const Crop& crop) {
    return fmt::format("{} {} {} {}", crop.left, crop.top, crop.width, crop.height);
}

// "stokes.lambdaMin_nm" for lambda_min_nm: a unit keeps its underscore.
std::string attribute_name(const std::string& key) {
    std::string name = "stokes.";
    for (std::size_t i = 0; i < key.size(); ++i) {
        const std::string rest = key.substr(i);
        const bool joint = key[i] == '_' && rest != "_nm" && rest != "_mm" && rest != "_ev";
        if (joint) ++i;
        name += joint ? static_cast<char>(std::toupper(static_cast<unsigned char>(key[i]))) : key[i];
    }
    return name;
}

Metadata exr_metadata(const Scene& scene, const RenderStats& stats, double exposure_ev) {
    Metadata metadata = {{"stokes.version", std::string(STOKES_VERSION)},
                         {"stokes.scene", stats.scene},
                         {"stokes.device", stats.device},
                         {"stokes.radiusFirst_mm", stats.radius_first_mm},
                         {"stokes.radiusLast_mm", stats.radius_last_mm},
                         {"stokes.crop", crop_text(scene.camera.crop)},
                         {"stokes.wall_s", stats.wall_s}};
    const nlohmann::ordered_json settings = settings_of(stats);
    for (const auto& [key, value] : settings.items()) {
        auto& attribute = metadata[attribute_name(key)];
        if (value.is_string())
            attribute = value.get<std::string>();
        else if (value.is_boolean())
            attribute = value.get<bool>() ? 1 : 0;
        else if (value.is_number_integer() && value <= std::numeric_limits<int>::max())
            attribute = value.get<int>();
        else
            attribute = value.get<double>();
    }
    metadata["stokes.exposure_ev"] = exposure_ev;
    return metadata;
}

}  // namespace

RenderStats collect_stats(const Scene& scene, const Device& device, const Renderer& renderer) {
    RenderStats stats;
    stats.scene = scene.file;
    stats.device = device.description().name;
    stats.driver = device.description().platform + " " + device.description().driver;
    stats.ray_kernel = word_of(device.ray_shape());
    stats.settings = resolved(scene.render);
    stats.settings.passes = static_cast<int>(renderer.passes());
    stats.film = scene.film;
    stats.photons_emitted = renderer.book().photons();
    stats.rays_traced = renderer.book().rays() + renderer.camera_rays();
    stats.deposits = renderer.book().deposits();
    stats.dropped = renderer.book().dropped();
    stats.ledger = renderer.book().ledger();
    stats.radius_first_mm = renderer.first_radius();
    stats.radius_last_mm = renderer.radius_of(renderer.passes() - 1);
    stats.device_memory_bytes = device.memory_in_use();
    stats.trials_processor_s = renderer.trials_processor_s();
    for (const auto& [kernel, time] : device.stage_times()) stats.stages[kernel] = time.seconds;
    return stats;
}

void say_what_was_dropped(const RenderStats& stats) {
    std::string causes;
    for (const auto& [cause, count] : stats.dropped)
        if (count > 0) causes += fmt::format("{}{} {}", causes.empty() ? "" : ", ", count, cause);
    if (!causes.empty())
        tell(fmt::format("dropped: {} of {} deposits and {} photons\n", causes, stats.deposits, stats.photons_emitted));
}

void warn_about(const FilmImage& film) {
    if (const std::size_t bad = count_non_finite(film))
        warn(fmt::format("{} pixels are not finite and are shown black", bad));
    const auto dark = [](const std::vector<float>& layer) {
        return std::all_of(layer.begin(), layer.end(), [](float value) { return value == 0.0f; });
    };
    if (std::all_of(film.xyz.begin(), film.xyz.end(), dark))
        warn(
            "the picture is black: no light comes from what the camera sees; the camera may be within a body or behind "
            "a surface, whose back is black");
}

void write_results(const OutputFiles& files, const Scene& scene, const FilmImage& film, const RenderStats& stats,
                   const ErrorCurve* curve, bool quiet) {
    const double exposure = scene.film.exposure_ev ? *scene.film.exposure_ev : automatic_exposure_ev(film);
    const auto write_picture = [&] { write_exr(files.exr, film, exr_metadata(scene, stats, exposure)); };
    const auto write_developed = [&] {
        write_png(files.png, develop(film, exposure), {{"Software", "stokes " STOKES_VERSION}});
    };
    const auto write_figures = [&] { write_stats(stats, files.stats); };
    write_outputs({{files.exr, write_picture},
                   {files.png, write_developed},
                   {files.stats, write_figures},
                   {files.csv, [&] { curve->write(); }}},
                  quiet);
}

}  // namespace stokes
