#include "host/core/signals.hpp"

#include <pthread.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <ctime>

#include "host/core/atomic_file.hpp"
#include "host/core/console.hpp"
#include "host/core/foreign_call.hpp"
#include "host/core/memory_limit.hpp"

namespace stokes {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array<int, 4> watched = {SIGINT, SIGTERM, SIGHUP, SIGXCPU};
constexpr auto patience_with_driver = std::chrono::seconds(1), patience_with_set_up = std::chrono::seconds(3);
// `timeout` sends its signal to the program and to its group: the second is the same one.
constexpr auto echo = std::chrono::milliseconds(300);

std::atomic<int> caught{0};
std::atomic<AtStake> stake{AtStake::nothing};
sigset_t waited_for, ignored;

[[noreturn]] void end_by(int signal) {
    remove_temporaries();
    if (stake != AtStake::nothing) ::_exit(128 + signal);
    std::signal(signal, SIG_DFL);
    sigset_t one;
    ::sigemptyset(&one);
    ::sigaddset(&one, signal);
    ::pthread_sigmask(SIG_UNBLOCK, &one, nullptr);
    ::raise(signal);
    ::_exit(128 + signal);
}

// 0 when none comes for so long.
int next_signal(std::chrono::milliseconds wait) {
    const timespec time{static_cast<std::time_t>(wait.count() / 1000),
                        static_cast<long>(wait.count() % 1000 * 1000000)};
    const int signal = ::sigtimedwait(&waited_for, nullptr, &time);
    return signal < 0 || ::sigismember(&ignored, signal) == 1 ? 0 : signal;
}

// Ends the program when the first signal's time is up.
void end_when_due(Clock::time_point first_at) {
    const Clock::duration since = Clock::now() - first_at;
    if (stake == AtStake::nothing && (since > patience_with_driver || !ForeignCall::on_any_thread())) end_by(caught);
    if (stake != AtStake::set_up || since < patience_with_set_up) return;
    end_line();
    show_progress(interrupted_in_set_up);  // a pager that nobody pages does not hold it up
    end_by(caught);
}

// Whether a call into a driver has stood still for ten looks, a second apart: no thread of the process has worked.
// A driver that ran out of memory may wait for a lock that nobody will give back.
class StandstillWatch {
  public:
    bool look() {
        const std::clock_t used = std::clock();
        const bool works = !ForeignCall::on_any_thread() || used - last_ > CLOCKS_PER_SEC / 100;
        last_ = used;
        looks_ = works ? 0 : looks_ + 1;
        return looks_ >= 10;
    }

  private:
    std::clock_t last_ = 0;
    int looks_ = 0;
};

void watch_for_standstill() {
    static StandstillWatch standstill;
    if (memory_is_short() && standstill.look()) end_for_lack_of_memory("the OpenCL driver stands still");
}

void* watch(void*) {
    Clock::time_point first_at;
    for (;;) {
        const int signal = next_signal(std::chrono::milliseconds(caught == 0 ? 1000 : 20));
        if (signal != 0 && caught == 0) {
            first_at = Clock::now();
            caught = signal;
        } else if ((signal == SIGINT || signal == SIGTERM) && Clock::now() - first_at > echo) {
            end_by(signal);
        }
        if (caught != 0)
            end_when_due(first_at);
        else if (signal == 0)
            watch_for_standstill();
    }
}

}  // namespace

void watch_signals() {
    ::sigemptyset(&waited_for);
    ::sigemptyset(&ignored);
    for (const int signal : watched) {
        struct sigaction now {};
        ::sigaddset(&waited_for, signal);  // an ignored one as well: LLVM, in a driver, would put a handler in its way
        if (::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN) ::sigaddset(&ignored, signal);
    }
    sigset_t before;
    ::pthread_sigmask(SIG_BLOCK, &waited_for, &before);
    pthread_attr_t attributes;
    ::pthread_attr_init(&attributes);
    ::pthread_attr_setstacksize(&attributes, 128 << 10);  // address space may be short
    pthread_t thread;
    const int failed = ::pthread_create(&thread, &attributes, watch, nullptr);
    ::pthread_attr_destroy(&attributes);
    if (failed != 0) ::pthread_sigmask(SIG_SETMASK, &before, nullptr);  // signals end the program by themselves
}

int caught_signal() { return caught; }

void set_at_stake(AtStake at_stake) { stake = at_stake; }

}  // namespace stokes
