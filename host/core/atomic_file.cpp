#include "host/core/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <optional>
#include <random>
#include <vector>

#include "host/core/error.hpp"

namespace stokes {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
    throw RunError(fmt::format("{}: cannot write: {}", path, reason));
}

[[noreturn]] void fail(const std::string& path) { fail(path, std::strerror(errno)); }

// The file that writing to a path replaces.
struct Target {
    std::string shown;   // as it was given
    std::string folder;  // "" or with a slash at its end
    std::string name;
    std::optional<struct stat> found;  // the file that is there

    std::string path() const { return folder + name; }
};

Target split(const std::string& shown, const std::string& path) {
    const std::size_t name = path.rfind('/') + 1;
    return {shown, path.substr(0, name), path.substr(name), {}};
}

// Where the symbolic link at this path leads, step by step as the system goes; none when it is no link.
std::optional<std::string> read_link(const std::string& path) {
    char text[PATH_MAX];
    const ssize_t size = ::readlink(path.c_str(), text, sizeof text);
    if (size < 0) return std::nullopt;
    return std::string(text, static_cast<std::size_t>(size));
}

// In a folder like /tmp a file can be written by all and replaced by its owner alone.
void check_may_be_replaced(const Target& target, const struct stat& file) {
    const uid_t me = ::geteuid();
    struct stat folder {};
    if (::stat(target.folder.empty() ? "." : target.folder.c_str(), &folder) != 0) fail(target.shown);
    if ((folder.st_mode & S_ISVTX) != 0 && me != 0 && me != file.st_uid && me != folder.st_uid)
        fail(target.shown, std::strerror(EPERM));
}

Target target_of(const std::string& path) {
    constexpr int most_links = 40;
    struct stat found {};
    const bool exists = ::stat(path.c_str(), &found) == 0;
    if (!exists && errno != ENOENT) fail(path);
    if (exists && !S_ISREG(found.st_mode)) fail(path, "not a regular file");
    if (exists && ::access(path.c_str(), W_OK) != 0) fail(path);
    Target target = split(path, path);
    for (int i = 0; const auto link = read_link(target.path()); ++i) {
        if (i == most_links) fail(path, std::strerror(ELOOP));
        target = split(path, link->front() == '/' ? *link : target.folder + *link);
    }
    struct stat there {};
    if (exists && ::lstat(target.path().c_str(), &there) != 0)
        fail(path, "not a regular file");  // a link of the kind of /dev/fd, to a file without a name
    if (exists) {
        check_may_be_replaced(target, found);
        target.found = found;
    }
    return target;
}

std::mutex temporaries_mutex;
std::vector<std::string> temporaries;

// Files may be written by many programs at once, into one folder.
std::string random_name() {
    constexpr const char* letters = "abcdefghijklmnopqrstuvwxyz0123456789";
    std::random_device random;
    std::string name = ".stokes-";
    for (int i = 0; i < 12; ++i) name += letters[random() % 36];
    return name;
}

// A new file that removes itself unless it has been renamed.
class Temporary {
  public:
    explicit Temporary(const Target& target) : target_(target) {
        const std::lock_guard<std::mutex> lock(temporaries_mutex);
        std::string listed;
        temporaries.reserve(temporaries.size() + 1);  // once the file is there, nothing may fail
        do {
            listed = path_ = target_.folder + random_name();
            descriptor_ = ::open(path_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC | O_NOFOLLOW, 0666);
        } while (descriptor_ < 0 && errno == EEXIST);
        if (descriptor_ < 0) fail(target_.shown);
        temporaries.push_back(std::move(listed));
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    ~Temporary() {
        if (descriptor_ >= 0) ::close(descriptor_);
        const std::lock_guard<std::mutex> lock(temporaries_mutex);
        if (!renamed_) ::unlink(path_.c_str());
        temporaries.erase(std::find(temporaries.begin(), temporaries.end(), path_));
    }

    void write(std::string_view content) {
        while (!content.empty()) {
            const ssize_t written = ::write(descriptor_, content.data(), content.size());
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) fail(target_.shown);
            content.remove_prefix(static_cast<std::size_t>(written));
        }
    }

    void become_target() {
        if (target_.found) take_owner_and_permissions(*target_.found);
        if (::fsync(descriptor_) != 0) fail(target_.shown);
        const int closed = ::close(descriptor_);
        descriptor_ = -1;
        if (closed != 0 || ::rename(path_.c_str(), target_.path().c_str()) != 0) fail(target_.shown);
        renamed_ = true;
    }

  private:
    void take_owner_and_permissions(const struct stat& file) {
        // Only root can give files away; for others the new file is their own.
        [[maybe_unused]] const int ignored = ::fchown(descriptor_, file.st_uid, file.st_gid);
        if (::fchmod(descriptor_, file.st_mode & 0777) != 0) fail(target_.shown);
    }

    const Target& target_;
    std::string path_;
    int descriptor_ = -1;
    bool renamed_ = false;
};

// Makes the rename itself durable; file systems that cannot are not an error.
void flush_folder(const std::string& folder) {
    const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
}

}  // namespace

void write_file_atomically(const std::string& path, std::string_view content) {
    const Target target = target_of(path);
    Temporary temporary(target);
    temporary.write(content);
    temporary.become_target();
    flush_folder(target.folder);
}

void check_can_be_written(const std::string& path) {
    const Target target = target_of(path);
    const Temporary temporary(target);
}

void remove_temporaries() {
    const std::lock_guard<std::mutex> lock(temporaries_mutex);
    for (const std::string& path : temporaries) ::unlink(path.c_str());
}

}  // namespace stokes
