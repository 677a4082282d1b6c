#include "host/device/driver_call.hpp"

#include "host/core/error.hpp"

namespace stokes {

void driver_failed(const std::string& doing, const cl::Error& error) {
    const std::string what = doing + ": " + error.what() + " failed with OpenCL error " + std::to_string(error.err());
    if (memory_is_short()) end_for_lack_of_memory(what.c_str());
    const bool memory = error.err() == CL_OUT_OF_HOST_MEMORY || error.err() == CL_MEM_OBJECT_ALLOCATION_FAILURE;
    throw RunError(what + (memory ? ", out of memory" : ""));
}

}  // namespace stokes
