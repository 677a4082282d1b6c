#include "host/scene/settings/settings_reader.hpp"

#include <fmt/format.h>

#include <vector>

#include "host/scene/settings/object.hpp"
#include "host/scene/settings/settings.hpp"
#include "kernels/shared/limits.h"

namespace stokes {
namespace {

struct Chosen {
    const Setting* setting;
    JsonCursor where;
};

// The place of a setting in a scene file.
std::optional<JsonCursor> find_in(const JsonCursor& root, const Setting& setting) {
    if (setting.object.empty()) return root.find(setting.key);
    const auto object = root.find(setting.object);
    return object ? object->find(setting.key) : std::nullopt;
}

void check(const std::vector<Chosen>& chosen, const RenderSettings& given) {
    const ResolvedSettings settings = resolved(given);
    for (const Chosen& c : chosen) {
        const std::string complaint = c.setting->complaint(settings);
        if (!complaint.empty()) c.where.fail(complaint);
    }
}

std::vector<Chosen> read_flags(const FlagValues& flags, Scene& scene) {
    static const std::string no_file;
    std::vector<Chosen> chosen;
    for (const Setting& setting : settings()) {
        const auto found = flags.find(setting.key);
        if (found == flags.end()) continue;
        chosen.push_back({&setting, JsonCursor(found->second.value, no_file, found->second.flag)});
        setting.read(chosen.back().where, scene);
    }
    return chosen;
}

}  // namespace

void read_settings(const JsonCursor& root, const FlagValues& flags, Scene& scene) {
    for (const char* object : {"render", "film"})
        if (const auto found = root.find(object)) ObjectReader(*found, object);
    std::vector<Chosen> chosen;
    Scene unused;
    for (const Setting& setting : settings()) {
        const auto where = find_in(root, setting);
        if (!where) continue;
        const bool replaced = flags.count(setting.key) || (setting.traits.sampler && flags.count("sampling"));
        setting.read(*where, replaced ? unused : scene);
        if (!replaced) chosen.push_back({&setting, *where});
    }
    for (Chosen& flag : read_flags(flags, scene)) chosen.push_back(flag);
    check(chosen, scene.render);
    const int count = scene.render.lambda_max_nm - scene.render.lambda_min_nm + 1;
    if (count < STOKES_WAVELENGTHS)
        root.find("render").value_or(root).fail(
            fmt::format("expected at least {} whole wavelengths from lambda_min_nm to lambda_max_nm, got {} to {}",
                        STOKES_WAVELENGTHS, scene.render.lambda_min_nm, scene.render.lambda_max_nm));
}

void read_settings(const FlagValues& flags, Scene& scene) { check(read_flags(flags, scene), scene.render); }

}  // namespace stokes
