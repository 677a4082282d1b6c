#include "host/core/console.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "host/core/error.hpp"

namespace stokes {
namespace {

std::atomic<bool> line_is_open{false};

// 0, or the error that kept a part from being written.
int write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor, text.data(), text.size());
        if (written >= 0) {
            text.remove_prefix(static_cast<std::size_t>(written));
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) {  // another program made the terminal so
            pollfd ready{descriptor, POLLOUT, 0};
            if (::poll(&ready, 1, -1) < 0 && errno != EINTR) return errno;
        } else if (errno != EINTR) {
            return errno;
        }
    }
    return 0;
}

}  // namespace

void prepare_standard_streams() {
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
        // The lowest free number is this one. Opened the wrong way round, every read or write of it fails.
        [[maybe_unused]] const int taken = ::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    }
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

void tell(std::string_view text) {
    end_line();
    write_all(STDERR_FILENO, text);
}

void note(std::string_view text) { write_all(STDOUT_FILENO, text); }

void print(std::string_view text) {
    const int error = write_all(STDOUT_FILENO, text);
    if (error != 0 && error != EPIPE)
        throw RunError(std::string("standard output: cannot write: ") + std::strerror(error));
}

void show_progress(std::string_view text) {
    pollfd ready{STDERR_FILENO, POLLOUT, 0};
    if (::poll(&ready, 1, 0) == 1) write_all(STDERR_FILENO, text);
}

void show_line(std::string_view text) {
    show_progress(text);
    line_is_open = true;
}

void end_line() {
    if (line_is_open.exchange(false)) show_progress("\n");
}

}  // namespace stokes
