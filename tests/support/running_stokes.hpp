// The program while it runs, on a terminal of its own, so that it can be sent signals.
#pragma once

#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/paths.hpp"

namespace stokes {

class RunningStokes {
  public:
    // ignored: signals that are ignored when it begins. cache: the folder of the driver's compiled kernels; "": its
    // own.
    explicit RunningStokes(std::vector<std::string> words, const std::vector<int>& ignored = {},
                           const std::string& cache = "") {
        words.insert(words.begin(), stokes_program());
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        const winsize size{24, 80, 0, 0};
        child_ = ::forkpty(&terminal_, nullptr, nullptr, &size);
        if (child_ < 0) throw std::runtime_error("no terminal to be had");
        if (child_ == 0) {
            if (!cache.empty()) ::setenv("POCL_CACHE_DIR", cache.c_str(), 1);
            for (const int signal : ignored) std::signal(signal, SIG_IGN);
            ::execv(arguments[0], arguments.data());
            ::_exit(127);
        }
    }
    RunningStokes(const RunningStokes&) = delete;
    RunningStokes& operator=(const RunningStokes&) = delete;
    ~RunningStokes() {
        if (child_ > 0) {
            ::kill(child_, SIGKILL);
            ::waitpid(child_, nullptr, 0);
        }
        close_terminal();
    }

    // Reads until text has come; false when the program ends or two minutes pass before.
    bool wait_for(const std::string& text) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        while (shown_.find(text) == std::string::npos)
            if (std::chrono::steady_clock::now() > end || !read_some()) return false;
        return true;
    }
    // False when the terminal does not take it.
    bool press_ctrl_c() const { return ::write(terminal_, "\x03", 1) == 1; }
    void send(int signal) const { ::kill(child_, signal); }
    void close_terminal() {
        if (terminal_ >= 0) ::close(terminal_);
        terminal_ = -1;
    }
    // Exit code, or 128 + the signal that ended it.
    int end() {
        if (terminal_ >= 0) wait_for("no such text");
        int status = 0;
        ::waitpid(child_, &status, 0);
        child_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    const std::string& shown() const { return shown_; }

  private:
    bool read_some() {
        pollfd ready{terminal_, POLLIN, 0};
        char bytes[4096];
        if (::poll(&ready, 1, 1000) == 0) return true;
        const ssize_t count = ::read(terminal_, bytes, sizeof bytes);
        if (count > 0) shown_.append(bytes, static_cast<std::size_t>(count));
        return count > 0;
    }
    pid_t child_ = -1;
    int terminal_ = -1;
    std::string shown_;
};

}  // namespace stokes
