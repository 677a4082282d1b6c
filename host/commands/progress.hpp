// How far a render has come, for the person who waits.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <string>

namespace stokes {

struct ProgressState {
    std::uint32_t passes_done = 0, passes = 1;
    std::uint64_t photons = 0;
    double elapsed_s = 0.0;
};

// One line of at most this many characters, after a bar where one is wanted: with little room first the bar
// is shorter, then it and the rate, the elapsed time and the count of passes are left out, in this order; the
// remaining time is always there.
std::string progress_line(const ProgressState& state, std::size_t columns, bool with_bar);

// The share of a work that is done, in [0, 1], on standard error: on a terminal one line that is rewritten, else a line
// for every tenth.
void print_share(double share);

// On a terminal one line that is rewritten; elsewhere plain lines, one every few seconds. Writes to standard
// error.
class Progress {
  public:
    Progress(std::uint32_t passes, bool quiet);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress() { finish(); }
    void preparing();  // what comes before the first pass
    void start();      // of the first pass: time counts from here
    void update(std::uint32_t passes_done, std::uint64_t photons);
    void finish();  // ends the line
    double elapsed_s() const;
    double processor_s() const;  // of all threads of the process, meanwhile
    // What takes this time is no part of the passes: elapsed_s() and processor_s() leave it out.
    template <class Work>
    void pause(const Work& work) {
        const auto begin = Clock::now();
        const std::clock_t processor_begin = std::clock();
        work();
        start_ += Clock::now() - begin;
        processor_start_ += std::clock() - processor_begin;
    }

  private:
    using Clock = std::chrono::steady_clock;
    void show(const std::string& line);
    std::uint32_t passes_;
    bool quiet_, terminal_;
    Clock::time_point start_ = Clock::now(), last_;
    std::clock_t processor_start_ = std::clock();
};

}  // namespace stokes
