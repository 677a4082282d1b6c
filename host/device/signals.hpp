// Drivers compile with programs of their own, a linker for one, which the terminal's Ctrl-C would end as
// well.
#pragma once

#include <pthread.h>

#include <csignal>

namespace stokes {

// While it lives, SIGINT and SIGTERM wait; threads and programs that are started meanwhile never get them.
class SignalsHeldBack {
  public:
    SignalsHeldBack() {
        sigset_t signals;
        ::sigemptyset(&signals);
        ::sigaddset(&signals, SIGINT);
        ::sigaddset(&signals, SIGTERM);
        ::pthread_sigmask(SIG_BLOCK, &signals, &before_);
    }
    SignalsHeldBack(const SignalsHeldBack&) = delete;
    SignalsHeldBack& operator=(const SignalsHeldBack&) = delete;
    ~SignalsHeldBack() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

  private:
    sigset_t before_{};
};

}  // namespace stokes
