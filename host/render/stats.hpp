// The figures of a render, as JSON.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "host/render/ledger.hpp"

namespace stokes {

struct RenderStats {
    std::string scene, device, driver, ray_kernel, transport, wavelengths, branches, distances, emission, direct, radii;
    int exits = 1;       // of an entry and component
    bool tables = true;  // light below surfaces was looked up in tables
    std::uint32_t passes = 0, seed = 0;
    int width = 0, height = 0;
    double wall_s = 0.0;              // of the passes, without set-up
    double processor_s = 0.0;         // the same, of all the host's threads together
    double trials_processor_s = 0.0;  // of the trial passes at set-up
    double set_up_s = 0.0;            // reading, building, compiling
    std::uint64_t photons_emitted = 0, rays_traced = 0, deposits = 0;
    std::map<std::string, double> stages;  // kernel name -> seconds, by the device's own clock
    std::map<std::string, std::uint64_t> dropped;
    Ledger ledger;
    double alpha = 0.0, radius_first_mm = 0.0, radius_last_mm = 0.0;
    std::uint64_t device_memory_bytes = 0;
};

// Writes stats to path, complete or not at all. RunError when it cannot be written.
void write_stats(const RenderStats& stats, const std::string& path);

}  // namespace stokes
