#include "host/commands/progress.hpp"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace stokes {

namespace {

std::string clock_text(double seconds) {
    const auto s = static_cast<long>(std::lround(seconds));
    if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
    return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::string bar(double share) {
    constexpr int width = 24;
    const int full = static_cast<int>(share * width);
    return std::string(static_cast<std::size_t>(full), '#') + std::string(static_cast<std::size_t>(width - full), '.');
}

std::size_t terminal_columns() {
    winsize size{};
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

Progress::Progress(std::uint32_t passes, bool quiet)
    : passes_(passes), quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1), last_(start_) {}

double Progress::elapsed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void Progress::update(std::uint32_t passes_done, std::uint64_t photons) {
    const auto now = Clock::now();
    const bool last = passes_done == passes_;
    const double since = std::chrono::duration<double>(now - last_).count();
    if (quiet_ || (!last && since < (terminal_ ? 0.1 : 5.0))) return;
    last_ = now;
    const double elapsed = elapsed_s();
    const double share = static_cast<double>(passes_done) / passes_;
    const double remaining = passes_done > 0 ? elapsed * (1.0 - share) / share : 0.0;
    std::string line =
        fmt::format("pass {}/{}  {:.2f} M photons/s  elapsed {}  remaining {}", passes_done, passes_,
                    static_cast<double>(photons) / std::max(elapsed, 1e-9) * 1e-6, clock_text(elapsed), clock_text(remaining));
    if (terminal_) {
        line = "[" + bar(share) + "] " + line;
        line.resize(std::min(line.size(), terminal_columns() - 1));
        std::fprintf(stderr, "\r\033[K%s", line.c_str());
        shown_ = true;
    } else {
        std::fprintf(stderr, "%s\n", line.c_str());
    }
    std::fflush(stderr);
}

void Progress::finish() {
    if (shown_) std::fputc('\n', stderr);
    shown_ = false;
}

}  // namespace stokes
