// The OpenCL device that tests run on: the first CPU device, opened once a process.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "host/device/kernel.hpp"

namespace stokes {

Device& test_device();

// Whether the elements are the same bit for bit.
template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

// A program for tests only: tests/kernel/NAME, with the product's include paths.
Program test_program(const std::string& name, const std::vector<std::string>& options = {});

}  // namespace stokes
