#include "host/core/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "host/core/error.hpp"

namespace stokes {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
    throw RunError(fmt::format("{}: cannot write: {}", path, reason));
}

// A new file that removes itself unless it has been renamed.
class Temporary {
  public:
    Temporary(std::string target, std::string shown)
        : target_(std::move(target)), shown_(std::move(shown)), path_(target_ + ".tmp") {
        descriptor_ = ::open(path_.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC | O_NOFOLLOW, 0666);
        if (descriptor_ < 0) fail(shown_, std::strerror(errno));
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    ~Temporary() {
        if (descriptor_ >= 0) ::close(descriptor_);
        if (!renamed_) ::unlink(path_.c_str());
    }

    void write(std::string_view content) {
        while (!content.empty()) {
            const ssize_t written = ::write(descriptor_, content.data(), content.size());
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) fail(shown_, std::strerror(errno));
            content.remove_prefix(static_cast<std::size_t>(written));
        }
    }

    void become_target() {
        if (::fsync(descriptor_) != 0) fail(shown_, std::strerror(errno));
        const int closed = ::close(descriptor_);
        descriptor_ = -1;
        if (closed != 0 || ::rename(path_.c_str(), target_.c_str()) != 0) fail(shown_, std::strerror(errno));
        renamed_ = true;
    }

  private:
    std::string target_;
    std::string shown_;
    std::string path_;
    int descriptor_ = -1;
    bool renamed_ = false;
};

// Makes the rename itself durable; file systems that cannot are not an error.
void flush_folder(const fs::path& folder) {
    const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
}

// The file that writing to path replaces: what a symbolic link leads to.
fs::path target_of(const std::string& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    if (!fs::exists(status)) return path;
    if (!fs::is_regular_file(status)) fail(path, "not a regular file");
    return fs::canonical(path, ignored);
}

}  // namespace

void write_file_atomically(const std::string& path, std::string_view content) {
    const fs::path target = target_of(path);
    Temporary temporary(target.string(), path);
    temporary.write(content);
    temporary.become_target();
    flush_folder(target.parent_path());
}

void check_can_be_written(const std::string& path) { const Temporary temporary(target_of(path).string(), path); }

}  // namespace stokes
