// The figures of a render, as JSON.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "host/render/ledger.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

struct RenderStats {
    std::string scene, device, driver, ray_kernel;
    ResolvedSettings settings;  // passes: those that were rendered
    Film film;
    double wall_s = 0.0;              // of the passes, without set-up
    double processor_s = 0.0;         // the same, of all the host's threads together
    double trials_processor_s = 0.0;  // of the trial passes at set-up
    double set_up_s = 0.0;            // reading, building, compiling
    std::uint64_t photons_emitted = 0, rays_traced = 0, deposits = 0;
    std::map<std::string, double> stages;  // kernel name -> seconds, by the device's own clock
    std::map<std::string, std::uint64_t> dropped;
    Ledger ledger;
    double radius_first_mm = 0.0, radius_last_mm = 0.0;
    std::uint64_t device_memory_bytes = 0;
};

// The settings by key, without those that the scene decides and nobody gave.
nlohmann::ordered_json settings_of(const RenderStats& stats);

// Writes stats to path, complete or not at all. RunError when it cannot be written.
void write_stats(const RenderStats& stats, const std::string& path);

}  // namespace stokes
