// The OpenCL device that tests run on: the first CPU device, opened once a process.
#pragma once

#include "host/device/device.hpp"

namespace stokes {

Device& test_device();

}  // namespace stokes
