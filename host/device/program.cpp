#include "host/device/device.hpp"
#include "host/device/signals.hpp"

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
    const std::string source = expand_kernel_source(name, text, device_.kernel_directory());
    const SignalsHeldBack held_back;
    try {
        program_ = device_.program(source, flags);
    } catch (const cl::BuildError& error) {
        std::string log;
        for (const auto& entry : error.getBuildLog()) log += entry.second;
        throw RunError("kernels/" + name + " does not compile on " + device_.description().name + ":\n" + log);
    } catch (const cl::Error& error) {
        throw RunError("kernels/" + name + ": " + error.what() + " failed with OpenCL error " +
                       std::to_string(error.err()));
    }
}

Kernel Program::kernel(const std::string& name) const {
    try {
        return Kernel(device_, cl::Kernel(program_, name.c_str()), name);
    } catch (const cl::Error& error) {
        throw RunError("kernels/" + file_ + " has no kernel " + name + " (OpenCL error " + std::to_string(error.err()) +
                       ")");
    }
}

Kernel::Kernel(Device device, cl::Kernel kernel, std::string name)
    : device_(std::move(device)), kernel_(std::move(kernel)), name_(std::move(name)) {}

void Kernel::set_bytes(cl_uint index, std::size_t bytes, const void* data) {
    const cl_int error = ::clSetKernelArg(kernel_(), index, bytes, data);
    if (error != CL_SUCCESS)
        throw RunError("kernel " + name_ + ": argument " + std::to_string(index) + " refused, OpenCL error " +
                       std::to_string(error));
}

void Kernel::enqueue(std::size_t work_items) {
    const std::size_t local = device_.local_size();
    const std::size_t global = (work_items + local - 1) / local * local;
    device_.check_stop();
    const SignalsHeldBack held_back;  // a first launch compiles
    try {
        cl::Event event;
        device_.queue().enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(global), cl::NDRange(local), nullptr,
                                             &event);
        device_.record(name_, event);
    } catch (const cl::Error& error) {
        throw RunError("kernel " + name_ + " could not be launched, OpenCL error " + std::to_string(error.err()));
    }
}

}  // namespace stokes
