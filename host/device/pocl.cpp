#include "host/device/pocl.hpp"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "host/core/error.hpp"
#include "host/core/log.hpp"

namespace stokes {

namespace {

namespace fs = std::filesystem;

std::string environment(const char* name) {
    const char* value = ::getenv(name);
    return value ? value : "";
}

// Makes the folder, and those it is in, where they are not there yet.
bool can_be_written(const fs::path& folder) {
    std::error_code ignored;
    fs::create_directories(folder, ignored);
    return fs::is_directory(folder, ignored) && ::access(folder.c_str(), W_OK | X_OK) == 0;
}

// Where PoCL keeps its compiled kernels by itself; "" where it would find no place.
fs::path chosen_by_pocl() {
    const std::string cache = environment("POCL_CACHE_DIR"), xdg = environment("XDG_CACHE_HOME"),
                      home = environment("HOME");
    if (!cache.empty()) return cache;
    if (!xdg.empty()) return fs::path(xdg) / "pocl" / "kcache";
    return home.empty() ? fs::path() : fs::path(home) / ".cache" / "pocl" / "kcache";
}

// One folder a user, which nobody else could have put there.
fs::path stand_in() {
    const std::string temporary = environment("TMPDIR");
    const fs::path folder =
        fs::path(temporary.empty() ? "/tmp" : temporary) / ("stokes-pocl-" + std::to_string(::getuid()));
    ::mkdir(folder.c_str(), 0700);
    struct stat found {};
    if (::lstat(folder.c_str(), &found) != 0 || !S_ISDIR(found.st_mode) || found.st_uid != ::getuid() ||
        (found.st_mode & 077) != 0 || !can_be_written(folder))
        throw RunError(folder.string() +
                       ": no folder of your own for compiled kernels can be made here; POCL_CACHE_DIR names another");
    return folder;
}

}  // namespace

void prepare_pocl_cache() {
    const fs::path chosen = chosen_by_pocl();
    if (!chosen.empty() && can_be_written(chosen)) return;
    const fs::path folder = stand_in();
    ::setenv("POCL_CACHE_DIR", folder.c_str(), 1);
    warn("the folder for compiled kernels, " + (chosen.empty() ? "$HOME/.cache" : chosen.string()) +
         ", cannot be written; they are kept in " + folder.string());
}

void check_pocl_devices() {
    const char* chosen = ::getenv("POCL_DEVICES");
    if (chosen == nullptr || *chosen == '\0') return;
    std::string word;
    for (const char* c = chosen;; ++c) {
        if (*c != ' ' && *c != '\0') {
            word += *c;
            continue;
        }
        if (!word.empty() && word != "pthread" && word != "basic" && word != "cuda" && word != "ttasim")
            throw InputError("POCL_DEVICES: \"" + word + "\" is not a PoCL device; expected pthread or basic");
        word.clear();
        if (*c == '\0') return;
    }
}

}  // namespace stokes
