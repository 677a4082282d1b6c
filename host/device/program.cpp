#include "host/device/driver_call.hpp"
#include "host/device/kernel.hpp"

namespace stokes {

Program::Program(const Device& device, const std::string& file, const std::vector<std::string>& options)
    : device_(device) {
    build(file, read_kernel_file(file, device.kernel_directory()), options);
}

Program Program::from_source(const Device& device, const std::string& name, const std::string& text,
                             const std::vector<std::string>& options) {
    Program program(device);
    program.build(name, text, options);
    return program;
}

void Program::build(const std::string& name, const std::string& text, const std::vector<std::string>& options) {
    file_ = name;
    device_.check_stop();
    std::string flags = "-cl-std=CL1.2";
    for (const std::string& option : options) flags += " " + option;
    source_ = expand_kernel_source(name, text, device_.kernel_directory());
    try {
        program_ = device_.program(source_, flags);
    } catch (const cl::BuildError& error) {
        std::string log;
        for (const auto& entry : error.getBuildLog()) log += entry.second;
        if (memory_is_short() && log.find("error: ") == std::string::npos)
            end_for_lack_of_memory(("kernels/" + name + " does not compile").c_str());
        throw RunError("kernels/" + name + " does not compile on " + device_.description().name + ":\n" + log);
    } catch (const cl::Error& error) {
        driver_failed("kernels/" + name, error);
    }
}

Kernel Program::kernel(const std::string& name) const {
    try {
        const cl::Kernel kernel = in_driver([&] { return cl::Kernel(program_, name.c_str()); });
        return Kernel(device_, kernel, name, kernel_arguments(source_, name));
    } catch (const cl::Error& error) {
        if (memory_is_short()) driver_failed("kernels/" + file_ + ", kernel " + name, error);
        throw RunError("kernels/" + file_ + " has no kernel " + name + " (OpenCL error " + std::to_string(error.err()) +
                       ")");
    }
}

Kernel::Kernel(Device device, cl::Kernel kernel, std::string name, std::vector<KernelArgument> arguments)
    : device_(std::move(device)),
      kernel_(std::move(kernel)),
      name_(std::move(name)),
      arguments_(std::move(arguments)) {}

void Kernel::bind(std::size_t index, const Arguments* const* groups, std::size_t count) const {
    const KernelArgument& wanted = arguments_[index];
    const auto fail = [&](const std::string& what) {
        throw RunError("kernel " + name_ + ": its argument " + wanted.name + " (" + wanted.type +
                       (wanted.pointer ? "*" : "") + ") " + what);
    };
    const Arguments::Value* found = nullptr;
    for (std::size_t g = 0; g < count; ++g)
        for (const Arguments::Value& value : groups[g]->values()) {
            if (value.hash != wanted.hash || value.name != wanted.name) continue;
            if (found != nullptr) fail("is bound twice");
            found = &value;
        }
    if (found == nullptr) fail("is bound by no group");
    if (found->pointer != wanted.pointer || found->type != wanted.type)
        fail("got " + std::string(found->type) + (found->pointer ? "*" : ""));
    if (found->pointer && !found->owner) fail("has no buffer yet");
    const cl_int error = ::clSetKernelArg(kernel_(), static_cast<cl_uint>(index), found->size,
                                          static_cast<const void*>(found->bytes.data()));
    if (error != CL_SUCCESS) fail("was refused, OpenCL error " + std::to_string(error));
}

void Kernel::run(std::size_t work_items, const Arguments* const* groups, std::size_t count) const {
    if (work_items == 0) return;
    for (std::size_t i = 0; i < arguments_.size(); ++i) bind(i, groups, count);
    enqueue(work_items);
}

void Kernel::enqueue(std::size_t work_items) const {
    const std::size_t local = device_.local_size();
    const std::size_t global = (work_items + local - 1) / local * local;
    device_.check_stop();
    try {
        cl::Event event;
        in_driver([&] {
            return device_.queue().enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(global), cl::NDRange(local),
                                                        nullptr, &event);
        });
        device_.record(name_, event);
    } catch (const cl::Error& error) {
        driver_failed("kernel " + name_ + " could not be launched", error);
    }
}

}  // namespace stokes
