// What a render leaves behind.
#pragma once

#include <string>

#include "host/commands/error_curve.hpp"
#include "host/device/device.hpp"
#include "host/render/renderer.hpp"
#include "host/render/stats.hpp"

namespace stokes {

struct OutputFiles {  // empty: none
    std::string exr, png, stats, csv;
};

// Without the times that the command measures.
RenderStats collect_stats(const Scene& scene, const Device& device, const Renderer& renderer);

void say_what_was_dropped(const RenderStats& stats);

// Warns of pixels that are not finite.
void warn_about(const FilmImage& film);

// curve: of the CSV file, if there is one. RunError when one cannot be written, as write_outputs.
void write_results(const OutputFiles& files, const Scene& scene, const FilmImage& film, const RenderStats& stats,
                   const ErrorCurve* curve, bool quiet);

}  // namespace stokes
