#include "host/device/pocl.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
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

// 0, or the error that keeps a file from being kept there. PoCL writes one even for kernels that it has compiled
// before.
int error_of_a_file_in(const fs::path& folder) {
    constexpr off_t size = 1 << 20;
    std::string path = (folder / ".stokes-XXXXXX").string();
    const int file = ::mkstemp(path.data());
    if (file < 0) return errno;
    ::unlink(path.c_str());
    const int error = ::posix_fallocate(file, 0, size);
    ::close(file);
    return error == EOPNOTSUPP || error == EINVAL ? 0 : error;  // some file systems cannot say
}

// Why compiled kernels cannot be kept in a folder, or "". Makes the folder, and those it is in, where they are not
// there yet.
std::string obstacle_in(const fs::path& folder) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (!fs::is_directory(folder)) return failed ? failed.message() : "not a folder";
    const int error = error_of_a_file_in(folder);
    return error == 0 ? "" : std::strerror(error);
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
        (found.st_mode & 077) != 0)
        throw RunError(folder.string() +
                       ": no folder of your own for compiled kernels can be made here; POCL_CACHE_DIR names another");
    const std::string obstacle = obstacle_in(folder);
    if (!obstacle.empty())
        throw RunError(folder.string() + ": compiled kernels cannot be kept here: " + obstacle +
                       "; POCL_CACHE_DIR names another folder");
    return folder;
}

}  // namespace

void prepare_pocl_cache() {
    const fs::path chosen = chosen_by_pocl();
    const std::string obstacle = chosen.empty() ? "no HOME" : obstacle_in(chosen);
    if (obstacle.empty()) return;
    const fs::path folder = stand_in();
    ::setenv("POCL_CACHE_DIR", folder.c_str(), 1);
    warn("the folder for compiled kernels, " + (chosen.empty() ? "$HOME/.cache" : chosen.string()) + " (" + obstacle +
         "), cannot be written; they are kept in " + folder.string());
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
