#include "host/commands/progress.hpp"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "host/core/console.hpp"

namespace stokes {

namespace {

std::string clock_text(double seconds) {
    const auto s = static_cast<long>(std::lround(seconds));
    if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
    return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::string bar(double share, std::size_t width) {
    const auto full = std::min(static_cast<std::size_t>(share * static_cast<double>(width)), width);
    return "[" + std::string(full, '#') + std::string(width - full, '.') + "] ";
}

std::size_t terminal_columns() {
    winsize size{};
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string progress_line(const ProgressState& state, std::size_t columns, bool with_bar) {
    constexpr std::size_t shortest_bar = 4, longest_bar = 24, frame = 3;
    const double share = static_cast<double>(state.passes_done) / state.passes;
    const double remaining_s = share > 0.0 ? state.elapsed_s * (1.0 - share) / share : 0.0;
    const double rate = static_cast<double>(state.photons) / std::max(state.elapsed_s, 1e-9) * 1e-6;
    const std::string pass = fmt::format("pass {}/{}  ", state.passes_done, state.passes);
    const std::string elapsed = fmt::format("elapsed {}  ", clock_text(state.elapsed_s));
    const std::string remaining = "remaining " + clock_text(remaining_s);

    const std::string whole = pass + fmt::format("{:.2f} M photons/s  ", rate) + elapsed + remaining;
    if (with_bar && whole.size() + frame + shortest_bar <= columns)
        return bar(share, std::min(longest_bar, columns - whole.size() - frame)) + whole;
    for (const std::string& line : {whole, pass + elapsed + remaining, pass + remaining})
        if (line.size() <= columns) return line;
    return remaining.substr(0, columns);
}

void print_share(double share) {
    static int printed = -1;
    const bool terminal = ::isatty(STDERR_FILENO) == 1;
    const int percent = static_cast<int>(100.0 * share) / (terminal ? 1 : 10) * (terminal ? 1 : 10);
    if (percent == printed) return;
    printed = percent;
    const std::string text = fmt::format("{:3d} %", percent);
    if (terminal)
        show_line("\r" + text);
    else
        show_progress(text + "\n");
    if (percent == 100) end_line();
}

Progress::Progress(std::uint32_t passes, bool quiet)
    : passes_(passes), quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1), last_(start_) {}

double Progress::elapsed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

double Progress::processor_s() const { return static_cast<double>(std::clock() - processor_start_) / CLOCKS_PER_SEC; }

void Progress::preparing() {
    if (!quiet_) show("preparing (compiling kernels ...)");
}

void Progress::start() {
    last_ = start_ = Clock::now();
    processor_start_ = std::clock();
}

void Progress::update(std::uint32_t passes_done, std::uint64_t photons) {
    const auto now = Clock::now();
    const bool last = passes_done == passes_;
    const double since = std::chrono::duration<double>(now - last_).count();
    if (quiet_ || (!last && since < (terminal_ ? 0.1 : 5.0))) return;
    last_ = now;
    // The last column stays free: some terminals begin a new line after it. A file has all the room.
    const std::size_t columns = terminal_ ? terminal_columns() - 1 : std::string::npos;
    show(progress_line({passes_done, passes_, photons, elapsed_s()}, columns, terminal_));
}

void Progress::show(const std::string& line) {
    if (terminal_)
        show_line("\r\033[K" + line);
    else
        show_progress(line + "\n");
}

void Progress::finish() { end_line(); }

}  // namespace stokes
