#include "host/render/stats.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/core/atomic_file.hpp"
#include "host/core/json_text.hpp"

namespace stokes {

namespace {

std::string number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "null"; }
std::string number(std::uint64_t value) { return std::to_string(value); }

template <class T>
std::string object(const std::map<std::string, T>& entries) {
    std::string result;
    for (const auto& [name, value] : entries)
        result += fmt::format("{}\n    {}: {}", result.empty() ? "" : ",", json_quoted(name), number(value));
    return "{" + result + "\n  }";
}

std::map<std::string, double> members(const Balance& b) {
    return {{"emitted", b.emitted},   {"absorbed", b.absorbed}, {"stokes_loss", b.stokes_loss},
            {"stored", b.stored},     {"escaped", b.escaped},   {"dropped", b.dropped},
            {"roulette", b.roulette}, {"created", b.created},   {"imbalance", b.imbalance()}};
}

}  // namespace

void write_stats(const RenderStats& s, const std::string& path) {
    const Ledger& l = s.ledger;
    const std::map<std::string, std::uint64_t> paths = {{"emitted", l.paths},
                                                        {"absorbed", l.absorbed_paths},
                                                        {"escaped", l.escaped_paths},
                                                        {"dropped", l.dropped_paths}};
    const auto rate = [&](std::uint64_t count) { return s.wall_s > 0.0 ? static_cast<double>(count) / s.wall_s : 0.0; };
    std::string text = "{\n";
    const auto add = [&](const char* key, const std::string& value) {
        text += fmt::format("{}  {}: {}", text.size() > 2 ? ",\n" : "", json_quoted(key), value);
    };
    add("scene", json_quoted(s.scene));
    add("device", json_quoted(s.device));
    add("driver", json_quoted(s.driver));
    add("ray_kernel", json_quoted(s.ray_kernel));
    add("transport", json_quoted(s.transport));
    add("tables", s.tables ? "true" : "false");
    add("wavelengths", json_quoted(s.wavelengths));
    add("branches", json_quoted(s.branches));
    add("distances", json_quoted(s.distances));
    add("exits", std::to_string(s.exits));
    add("emission", json_quoted(s.emission));
    add("direct", json_quoted(s.direct));
    add("radii", json_quoted(s.radii));
    add("passes", number(std::uint64_t{s.passes}));
    add("seed", number(std::uint64_t{s.seed}));
    add("width", std::to_string(s.width));
    add("height", std::to_string(s.height));
    add("wall_s", number(s.wall_s));
    add("processor_s", number(s.processor_s));
    add("trials_processor_s", number(s.trials_processor_s));
    add("set_up_s", number(s.set_up_s));
    add("photons_emitted", number(s.photons_emitted));
    add("photons_per_second", number(rate(s.photons_emitted)));
    add("rays_traced", number(s.rays_traced));
    add("rays_per_second", number(rate(s.rays_traced)));
    add("deposits", number(s.deposits));
    add("alpha", number(s.alpha));
    add("radius_first_mm", number(s.radius_first_mm));
    add("radius_last_mm", number(s.radius_last_mm));
    add("device_memory_bytes", number(s.device_memory_bytes));
    add("stages", object(s.stages));
    add("dropped", object(s.dropped));
    add("ledger", object(members(l.power)));
    add("ledger_photons", object(members(l.photons)));
    add("paths", object(paths));
    write_file_atomically(path, text + "\n}\n");
}

}  // namespace stokes
