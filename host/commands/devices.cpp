#include <fmt/core.h>

#include "host/commands/commands.hpp"
#include "host/core/console.hpp"
#include "host/device/device.hpp"

namespace stokes {

void add_devices_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("devices", "List the OpenCL devices");
    command->callback([] {
        for (const DeviceDescription& d : list_devices())
            print(fmt::format("{}  {}  {}  [{}, {} compute units, {:.1f} GiB, {}, rays {}]{}\n", d.selector,
                              d.cpu   ? "CPU"
                              : d.gpu ? "GPU"
                                      : "---",
                              d.name, d.platform, d.compute_units, static_cast<double>(d.memory_bytes) / (1 << 30),
                              d.version, word_of(choose_ray_shape(d)), d.available ? "" : "  not available"));
    });
}

}  // namespace stokes
