// How far a render has come, for the person who waits.
#pragma once

#include <chrono>
#include <cstdint>

namespace stokes {

// On a terminal one line that is rewritten; elsewhere a plain line every few seconds. Writes to standard error.
class Progress {
  public:
    Progress(std::uint32_t passes, bool quiet);
    void update(std::uint32_t passes_done, std::uint64_t photons);
    void finish();  // ends the line
    double elapsed_s() const;

  private:
    using Clock = std::chrono::steady_clock;
    std::uint32_t passes_;
    bool quiet_, terminal_, shown_ = false;
    Clock::time_point start_ = Clock::now(), last_;
};

}  // namespace stokes
