#include "host/commands/device_flags.hpp"

#include "host/commands/number_in.hpp"

namespace stokes {

void add_device_flags(CLI::App& command, DeviceFlags& flags) {
    command.add_option("--device", flags.device, "platform:device, part of a name, cpu or gpu");
    command.add_option("--threads", flags.threads, "CPU threads; default: all")->check(CLI::Range(1, 4096));
    std::vector<std::string> words = words_of<RayShape>;
    words.insert(words.begin(), "auto");
    command
        .add_option("--ray-kernel", flags.ray_kernel,
                    "How rays are traced: avx512, avx2, portable, scalar; default: auto, by the device. The picture is "
                    "the same")
        ->type_name("WORD")
        ->check(one_of_words(words));
}

Device open_device(const DeviceFlags& flags) {
    Device device = Device::open(flags.device, flags.threads);
    if (flags.ray_kernel != "auto") device.set_ray_shape(*value_of_word<RayShape>(flags.ray_kernel));
    return device;
}

}  // namespace stokes
