#include "host/core/foreign_call.hpp"

#include <atomic>

namespace stokes {
namespace {

std::atomic<int> calls{0};
thread_local int calls_here = 0;

}  // namespace

ForeignCall::ForeignCall() {
    ++calls;
    ++calls_here;
}

ForeignCall::~ForeignCall() {
    --calls_here;
    --calls;
}

bool ForeignCall::on_this_thread() { return calls_here > 0; }
bool ForeignCall::on_any_thread() { return calls > 0; }

}  // namespace stokes
