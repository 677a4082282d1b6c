// Calls into code that is not ours: drivers, and the compilers within them.
#pragma once

namespace stokes {

// While it lives, this thread is in such a call. A signal that ends the program waits some seconds for its end, and an
// allocation that fails in it ends the program: an exception would pass through code that keeps its locks.
class ForeignCall {
  public:
    ForeignCall();
    ForeignCall(const ForeignCall&) = delete;
    ForeignCall& operator=(const ForeignCall&) = delete;
    ~ForeignCall();

    static bool on_this_thread();
    static bool on_any_thread();
};

}  // namespace stokes
