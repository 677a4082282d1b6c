// Calls of the OpenCL driver.
#pragma once

#include <CL/opencl.hpp>
#include <new>
#include <string>

#include "host/core/foreign_call.hpp"
#include "host/core/memory_limit.hpp"

namespace stokes {

// What one call of the driver gives. The call must make nothing that the driver has to take back when it fails: where
// the driver runs out of memory, the program ends without asking it for anything more.
template <class Call>
auto in_driver(const Call& call) {
    const ForeignCall foreign;
    try {
        return call();
    } catch (const std::bad_alloc&) {
        end_for_lack_of_memory("the OpenCL driver");
    }
}

// RunError "DOING: clCall failed with OpenCL error N". Where memory is short, that is taken for the cause, and the
// program ends as above.
[[noreturn]] void driver_failed(const std::string& doing, const cl::Error& error);

}  // namespace stokes
