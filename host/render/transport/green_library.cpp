#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "host/core/embedded.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/render/transport/green_walk.hpp"

namespace stokes {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kCachedWalks = 300000;

std::string table_name(double eta) { return fmt::format("green-{}.json.gz", eta); }

// Empty where neither XDG_CACHE_HOME nor HOME names an absolute folder.
fs::path cache_folder() {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    if (cache != nullptr && fs::path(cache).is_absolute()) return fs::path(cache) / "stokes";
    const char* home = std::getenv("HOME");
    if (home != nullptr && fs::path(home).is_absolute()) return fs::path(home) / ".cache" / "stokes";
    return {};
}

bool read_cached(const fs::path& file, double eta, GreenTable& table) {
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return false;
    try {
        table = read_green_table(file.string());
        if (table.eta == eta && table.albedo.size() == STOKES_GREEN_ALBEDOS) return true;
        warn(fmt::format("{}: not the table it is named after; making it anew", file.string()));
    } catch (const InputError& error) {
        warn(fmt::format("{}; making the table anew", error.what()));
    }
    return false;
}

void write_cached(const GreenTable& table, const fs::path& file) {
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    try {
        if (error) throw RunError(fmt::format("{}: {}", file.parent_path().string(), error.message()));
        write_green_table(table, file.string());
    } catch (const RunError& failure) {
        warn(fmt::format("the Green's function table is not cached: {}", failure.what()));
    }
}

}  // namespace

GreenTable green_table_for(const Device& device, double eta, const GreenProgress& progress) {
    const std::string name = "tables/green/" + table_name(eta);
    const auto shipped = embedded_files().find(name);
    if (shipped != embedded_files().end()) return parse_green_table(shipped->second, name);

    const fs::path folder = cache_folder(), file = folder / table_name(eta);
    GreenTable table;
    if (!folder.empty() && read_cached(file, eta, table)) return table;
    warn(fmt::format(
        "no Green's function table for the refractive index {} yet: computing it, which takes a minute or two{}", eta,
        folder.empty() ? "" : ", once: it is kept in " + folder.string()));
    table = make_green_table(device, eta, kCachedWalks, progress);
    if (!folder.empty()) write_cached(table, file);
    return table;
}

}  // namespace stokes
