// The OpenCL device that tests run on: the first CPU device, opened once a process.
#pragma once

#include <string>
#include <vector>

#include "host/device/kernel.hpp"

namespace stokes {

Device& test_device();

// A program for tests only: tests/kernel/NAME, with the product's include paths.
Program test_program(const std::string& name, const std::vector<std::string>& options = {});

}  // namespace stokes
