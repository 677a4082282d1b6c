// One row of the table of settings: all that the program knows of a setting. The reader of scene files, the flags of
// the command line, the resolved values, --stats, the attributes of pictures, the schema, --help and the table in
// scenes/README.md take it from there.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "host/core/json_cursor.hpp"
#include "host/scene/scene.hpp"
#include "host/scene/settings/domain.hpp"

namespace stokes {

inline const std::vector<Transport> all_transports = {Transport::paper, Transport::conserving, Transport::walk};

// What sets a setting apart from most.
struct SettingTraits {
    std::vector<Transport> transports = all_transports;  // that have it
    bool needs_tables = false;                           // it means nothing where the setting `tables` is off
    bool sampler = false;                                // --sampling takes back what the scene says of it
    std::string otherwise;  // what its default is where only the scene can say: "derived from the scene"
};

struct Setting {
    std::string object;  // of the scene file that has its key; empty: the scene itself
    std::string key;
    std::string flags;  // on the command line, as CLI11 takes them
    Domain domain;
    std::string help;  // one sentence, without its default and its transports
    SettingTraits traits = {};

    std::function<void(const JsonCursor&, Scene&)> read = {};
    std::function<void(const RenderSettings&, ResolvedSettings&)> resolve = {};
    // What it is where nobody says and it means something.
    std::function<nlohmann::ordered_json(const ResolvedSettings&)> fallback = {};
    // null where there is none.
    std::function<nlohmann::ordered_json(const ResolvedSettings&, const Film&)> value = {};

    // The first of its flags: "--alpha".
    std::string flag() const;
    // null where it depends on the transport, on other settings or on the scene.
    nlohmann::ordered_json constant_default() const;
    // The sentence with its transports and its default, as --help, the schema and scenes/README.md have it.
    std::string sentence() const;
    // Empty, or what a render with these settings lacks for it: "expected transport "paper", got "walk"".
    std::string complaint(const ResolvedSettings& settings) const;
};

}  // namespace stokes
