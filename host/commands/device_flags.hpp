// The options that choose a device, of every command that runs kernels.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "host/device/device.hpp"

namespace stokes {

struct DeviceFlags {
    std::string device;
    std::string ray_kernel = "auto";
    int threads = 0;
};

// flags has to live until the command line is parsed.
void add_device_flags(CLI::App& command, DeviceFlags& flags);

// InputError and RunError as Device::open.
Device open_device(const DeviceFlags& flags);

}  // namespace stokes
