#include "host/device/device.hpp"

#include <stdlib.h>

#include <algorithm>
#include <cctype>

#include "host/device/driver_call.hpp"
#include "host/device/pocl.hpp"

namespace stokes {

namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

std::string trimmed(std::string text) {
    while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
    return text;
}

struct Found {
    DeviceDescription description;
    cl::Device device;
};

DeviceDescription describe(const cl::Platform& platform, const cl::Device& device, std::size_t p, std::size_t d) {
    DeviceDescription result;
    result.selector = std::to_string(p) + ":" + std::to_string(d);
    result.platform = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
    result.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    result.version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
    result.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
    const cl_device_type type = device.getInfo<CL_DEVICE_TYPE>();
    result.cpu = (type & CL_DEVICE_TYPE_CPU) != 0;
    result.gpu = (type & CL_DEVICE_TYPE_GPU) != 0;
    result.available = device.getInfo<CL_DEVICE_AVAILABLE>() != 0;
    result.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    result.vector_floats = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
    result.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    result.largest_allocation_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    return result;
}

// Empty where there is no driver.
std::vector<Found> ask_for_devices() {
    std::vector<Found> result;
    try {
        std::vector<cl::Platform> platforms;
        in_driver([&] { return cl::Platform::get(&platforms); });
        for (std::size_t p = 0; p < platforms.size(); ++p) {
            std::vector<cl::Device> devices;
            try {
                in_driver([&] { return platforms[p].getDevices(CL_DEVICE_TYPE_ALL, &devices); });
            } catch (const cl::Error& error) {
                if (error.err() != CL_DEVICE_NOT_FOUND) throw;
            }
            for (std::size_t d = 0; d < devices.size(); ++d)
                result.push_back({describe(platforms[p], devices[d], p, d), devices[d]});
        }
    } catch (const cl::Error& error) {
        if (error.err() != -1001) driver_failed("OpenCL", error);
    }
    return result;
}

std::vector<Found> find_devices() {
    check_pocl_devices();
    prepare_pocl_cache();
    check_memory_for_driver([] { return !ask_for_devices().empty(); });
    std::vector<Found> found = ask_for_devices();
    if (found.empty())
        throw RunError("no OpenCL device was found; install a driver, for the CPU the package pocl-opencl-icd");
    return found;
}

const Found& choose(const std::vector<Found>& found, const std::string& selector) {
    const std::string wanted = lower(selector);
    const auto is = [&](const Found& f) {
        const DeviceDescription& d = f.description;
        if (!d.available) return false;
        if (wanted.empty() || wanted == "cpu") return d.cpu;
        if (wanted == "gpu") return d.gpu;
        return d.selector == wanted || lower(d.platform + " " + d.name).find(wanted) != std::string::npos;
    };
    const auto match = std::find_if(found.begin(), found.end(), is);
    if (match != found.end()) return *match;
    if (wanted.empty()) return found.front();
    std::string known;
    for (const Found& f : found)
        known += (known.empty() ? "" : ", ") + f.description.selector + " " + f.description.name;
    throw InputError("--device: no device matches \"" + selector + "\"; there are: " + known);
}

}  // namespace

RayShape choose_ray_shape(const DeviceDescription& device, bool x86) {
    if (!device.cpu || device.gpu || device.vector_floats < 2) return RayShape::scalar;
    if (!x86 || device.vector_floats < 8) return RayShape::portable;
    return device.vector_floats < 16 ? RayShape::avx2 : RayShape::avx512;
}

RayShape choose_ray_shape(const DeviceDescription& device) {
#if defined(__x86_64__) || defined(__i386__)
    return choose_ray_shape(device, true);
#else
    return choose_ray_shape(device, false);
#endif
}

std::vector<DeviceDescription> list_devices() {
    std::vector<DeviceDescription> result;
    for (const Found& found : find_devices()) result.push_back(found.description);
    return result;
}

Device Device::open(const std::string& selector, int threads) {
    if (threads > 0) ::setenv("POCL_MAX_PTHREAD_COUNT", std::to_string(threads).c_str(), 1);
    const std::vector<Found> found = find_devices();
    const Found& chosen = choose(found, selector);
    Device result;
    result.shared_ = std::make_shared<Shared>();
    Shared& shared = *result.shared_;
    shared.description = chosen.description;
    shared.device = chosen.device;
    try {
        shared.context = in_driver([&] { return cl::Context(chosen.device); });
        shared.queue =
            in_driver([&] { return cl::CommandQueue(shared.context, chosen.device, CL_QUEUE_PROFILING_ENABLE); });
    } catch (const cl::Error& error) {
        driver_failed(shared.description.name, error);
    }
    shared.memory_budget = shared.description.memory_bytes / 4 * 3;
    return result;
}

void Device::finish() const {
    try {
        in_driver([&] { return shared_->queue.finish(); });
    } catch (const cl::Error& error) {
        driver_failed(shared_->description.name + ": a kernel failed", error);
    }
    collect();
}

cl::Program Device::program(const std::string& source, const std::string& flags) const {
    const std::pair<std::string, std::string> key(source, flags);
    const auto known = shared_->programs.find(key);
    if (known != shared_->programs.end()) return known->second;
    renew_memory_watch();
    const cl::Program program = in_driver([&] { return cl::Program(shared_->context, source); });
    in_driver([&] { return program.build(flags.c_str()); });
    return shared_->programs.emplace(key, program).first->second;
}

void Device::record(const std::string& kernel_name, const cl::Event& event) const {
    shared_->pending.emplace_back(kernel_name, event);
}

void Device::collect() const {
    for (const auto& [name, event] : shared_->pending) {
        StageTime& time = shared_->stage_times[name];
        const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
        const auto end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
        time.seconds += end > start ? static_cast<double>(end - start) * 1e-9 : 0.0;
        ++time.launches;
    }
    shared_->pending.clear();
}

const std::map<std::string, StageTime>& Device::stage_times() const {
    finish();
    return shared_->stage_times;
}

void Device::reset_stage_times() {
    finish();
    shared_->stage_times.clear();
}

}  // namespace stokes
