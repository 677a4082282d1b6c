#include "tests/bench/timing.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace stokes::bench {

namespace {

double seconds(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

double process_cpu_s() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double quantile(const std::vector<double>& sorted, double q) {
    const double at = q * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

std::vector<double> column(const std::vector<Timing>& timings, double Timing::*member) {
    std::vector<double> values;
    for (const Timing& t : timings) values.push_back(t.*member);
    return values;
}

Spread ratio_of(const std::vector<Timing>& slow, const std::vector<Timing>& fast, double Timing::*member) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < slow.size(); ++i) ratios.push_back(slow[i].*member / fast[i].*member);
    return spread_of(ratios);
}

}  // namespace

Timing time_of(const std::function<void()>& work) {
    const double cpu = process_cpu_s();
    const auto start = std::chrono::steady_clock::now();
    work();
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return {wall, process_cpu_s() - cpu};
}

Spread spread_of(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75)};
}

void Contest::add(const std::string& name, std::function<void()> work, std::function<void()> reset) {
    entries_.push_back({name, std::move(work), std::move(reset), {}});
}

void Contest::run(int rounds) {
    for (int round = -1; round < rounds; ++round) {
        for (std::size_t k = 0; k < entries_.size(); ++k) {
            Entry& entry = entries_[round % 2 == 0 ? k : entries_.size() - 1 - k];
            if (entry.reset) entry.reset();
            const Timing timing = time_of(entry.work);
            if (round >= 0) entry.timings.push_back(timing);
        }
    }
}

const Contest::Entry* Contest::find(const std::string& name) const {
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.name == name; });
    return found == entries_.end() ? nullptr : &*found;
}

const Contest::Entry& Contest::at(const std::string& name) const {
    const Entry* entry = find(name);
    if (entry == nullptr) throw std::out_of_range("no contestant " + name);
    return *entry;
}

Spread Contest::wall_s(const std::string& name) const { return spread_of(column(at(name).timings, &Timing::wall_s)); }
Spread Contest::cpu_s(const std::string& name) const { return spread_of(column(at(name).timings, &Timing::cpu_s)); }

Spread Contest::cpu_ratio(const std::string& slow, const std::string& fast) const {
    return ratio_of(at(slow).timings, at(fast).timings, &Timing::cpu_s);
}

Spread Contest::wall_ratio(const std::string& slow, const std::string& fast) const {
    return ratio_of(at(slow).timings, at(fast).timings, &Timing::wall_s);
}

Team::Team(unsigned threads) {
    for (unsigned i = 0; i < std::max(threads, 1u); ++i) threads_.emplace_back([this] { attend(); });
}

Team::~Team() {
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        leaving_ = true;
    }
    called_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void Team::each(std::size_t count, const std::function<void(std::size_t)>& work) {
    std::unique_lock<std::mutex> lock(mutex_);
    work_ = &work;
    count_ = count;
    next_ = 0;
    busy_ = threads_.size();
    ++round_;
    called_.notify_all();
    done_.wait(lock, [this] { return busy_ == 0; });
}

void Team::blocks(std::size_t count, std::size_t block, const std::function<void(std::size_t, std::size_t)>& work) {
    each((count + block - 1) / block, [&](std::size_t i) { work(i * block, std::min((i + 1) * block, count)); });
}

void Team::attend() {
    std::size_t seen = 0;
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;) {
        called_.wait(lock, [&] { return leaving_ || round_ != seen; });
        if (leaving_) return;
        seen = round_;
        const std::function<void(std::size_t)>& work = *work_;
        const std::size_t count = count_;
        lock.unlock();
        for (std::size_t i = next_++; i < count; i = next_++) work(i);
        lock.lock();
        if (--busy_ == 0) done_.notify_one();
    }
}

}  // namespace stokes::bench
