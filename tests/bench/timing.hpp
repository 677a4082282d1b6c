// Stopwatches, contests between programs that do the same work, and the threads of those that are C++.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace stokes::bench {

// Of one run [s]. The processor time is that of the whole process, all threads and the kernel included: it hardly
// changes when other processes take the cores for a while.
struct Timing {
    double wall_s = 0.0, cpu_s = 0.0;
};

Timing time_of(const std::function<void()>& work);

// Median and quartiles, interpolated between the sorted values. All 0 for no values.
struct Spread {
    double median = 0.0, low = 0.0, high = 0.0;
};

Spread spread_of(std::vector<double> values);

// Two or more ways to do the same, run in turns: first all of them once, untimed, then round after round, every other
// round in the opposite order. A ratio is taken within each round before the median is, so that whatever slows the
// machine for a while slows both sides of it.
class Contest {
  public:
    // reset: run before each run of work, outside of the time.
    void add(const std::string& name, std::function<void()> work, std::function<void()> reset = {});
    void run(int rounds);

    bool has(const std::string& name) const { return find(name) != nullptr; }
    Spread wall_s(const std::string& name) const;
    Spread cpu_s(const std::string& name) const;
    // Time of slow / time of fast: how many times as fast as `slow` the program `fast` is.
    Spread cpu_ratio(const std::string& slow, const std::string& fast) const;
    Spread wall_ratio(const std::string& slow, const std::string& fast) const;

  private:
    struct Entry {
        std::string name;
        std::function<void()> work, reset;
        std::vector<Timing> timings;
    };
    const Entry* find(const std::string& name) const;
    const Entry& at(const std::string& name) const;
    std::vector<Entry> entries_;
};

// Threads that wait for work, as those of an OpenCL driver do.
class Team {
  public:
    explicit Team(unsigned threads);
    Team(const Team&) = delete;
    Team& operator=(const Team&) = delete;
    ~Team();

    unsigned size() const { return static_cast<unsigned>(threads_.size()); }
    // Calls work(0) .. work(count - 1), each by the next thread that is free, and waits for them.
    void each(std::size_t count, const std::function<void(std::size_t)>& work);
    // Calls work(begin, end) for blocks of `block` of the items 0 .. count - 1.
    void blocks(std::size_t count, std::size_t block, const std::function<void(std::size_t, std::size_t)>& work);

  private:
    void attend();
    std::mutex mutex_;
    std::condition_variable called_, done_;
    const std::function<void(std::size_t)>* work_ = nullptr;
    std::size_t count_ = 0, round_ = 0, busy_ = 0;
    std::atomic<std::size_t> next_{0};
    bool leaving_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace stokes::bench
