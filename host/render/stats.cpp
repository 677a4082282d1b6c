#include "host/render/stats.hpp"

#include <nlohmann/json.hpp>

#include "host/core/atomic_file.hpp"
#include "host/scene/settings/settings.hpp"

namespace stokes {

namespace {

using Json = nlohmann::ordered_json;

Json members(const Balance& b) {
    return {{"emitted", b.emitted},   {"absorbed", b.absorbed}, {"stokes_loss", b.stokes_loss},
            {"stored", b.stored},     {"escaped", b.escaped},   {"dropped", b.dropped},
            {"roulette", b.roulette}, {"created", b.created},   {"imbalance", b.imbalance()}};
}

Json as_json(const RenderStats& s) {
    const auto rate = [&](std::uint64_t count) { return s.wall_s > 0.0 ? static_cast<double>(count) / s.wall_s : 0.0; };
    Json json = {{"scene", s.scene}, {"device", s.device}, {"driver", s.driver}, {"ray_kernel", s.ray_kernel}};
    json.update(settings_of(s));
    json.update({{"wall_s", s.wall_s},
                 {"processor_s", s.processor_s},
                 {"trials_processor_s", s.trials_processor_s},
                 {"set_up_s", s.set_up_s},
                 {"photons_emitted", s.photons_emitted},
                 {"photons_per_second", rate(s.photons_emitted)},
                 {"rays_traced", s.rays_traced},
                 {"rays_per_second", rate(s.rays_traced)},
                 {"deposits", s.deposits},
                 {"radius_first_mm", s.radius_first_mm},
                 {"radius_last_mm", s.radius_last_mm},
                 {"device_memory_bytes", s.device_memory_bytes},
                 {"stages", s.stages},
                 {"dropped", s.dropped},
                 {"ledger", members(s.ledger.power)},
                 {"ledger_photons", members(s.ledger.photons)},
                 {"paths",
                  {{"emitted", s.ledger.paths},
                   {"absorbed", s.ledger.absorbed_paths},
                   {"escaped", s.ledger.escaped_paths},
                   {"dropped", s.ledger.dropped_paths}}}});
    return json;
}

}  // namespace

Json settings_of(const RenderStats& stats) {
    Json json = Json::object();
    for (const Setting& setting : settings())
        if (const Json value = setting.value(stats.settings, stats.film); !value.is_null()) json[setting.key] = value;
    return json;
}

void write_stats(const RenderStats& stats, const std::string& path) {
    write_file_atomically(path, as_json(stats).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace stokes
