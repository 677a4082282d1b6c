#include <sys/mman.h>

#include <cstdlib>

#include "host/device/device.hpp"
#include "host/device/driver_call.hpp"

namespace stokes {

namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20;

// What the system allows, where that is little.
std::string memory_note() {
    const std::string limit = memory_limit_text();
    return limit.empty() ? limit : "; " + limit;
}

std::string mebibytes(std::uint64_t bytes) { return std::to_string((bytes + (1u << 20) - 1) >> 20) + " MiB"; }

}  // namespace

Allocation::Allocation(const Device& device, const std::string& name, std::size_t bytes)
    : owner_(std::make_shared<Owner>()) {
    owner_->device = device;
    owner_->name = name;
    Device::Shared& shared = *device.shared_;
    if (bytes > shared.memory_budget - std::min(shared.memory_in_use, shared.memory_budget))
        throw InputError("device memory: " + name + " needs " + mebibytes(bytes) + ", " +
                         mebibytes(shared.memory_in_use) + " of the budget of " + mebibytes(shared.memory_budget) +
                         " are in use; render fewer photons or pixels, or raise --max-memory");
    if (bytes > shared.description.largest_allocation_bytes)
        throw InputError("device memory: " + name + " needs " + mebibytes(bytes) + " in one piece, " +
                         shared.description.name + " gives at most " +
                         mebibytes(shared.description.largest_allocation_bytes));
    try {
        if (shared.description.cpu) {
            const std::size_t alignment = bytes >= huge_page ? huge_page : 4096;
            const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
            owner_->host = std::aligned_alloc(alignment, rounded);
            if (owner_->host == nullptr)
                throw RunError("out of memory for " + name + ", " + mebibytes(bytes) + memory_note());
            if (alignment == huge_page) ::madvise(owner_->host, rounded, MADV_HUGEPAGE);
            owner_->buffer = in_driver([&] {
                return cl::Buffer(device.context(), CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, owner_->host);
            });
        } else {
            owner_->buffer = in_driver([&] { return cl::Buffer(device.context(), CL_MEM_READ_WRITE, bytes); });
        }
    } catch (const cl::Error& error) {
        driver_failed("device memory: " + name + ", " + mebibytes(bytes), error);
    }
    owner_->bytes = bytes;
    shared.memory_in_use += bytes;
    ++shared.allocations;
}

// Kernels that are still under way may use the memory.
Allocation::Owner::~Owner() {
    if (bytes > 0) ::clFinish(device.queue()());
    buffer = cl::Buffer();
    std::free(host);
    if (bytes > 0) device.shared_->memory_in_use -= bytes;
}

void Allocation::write(const void* data, std::size_t bytes, std::size_t offset) const {
    const cl_int error = in_driver([&] {
        return ::clEnqueueWriteBuffer(owner_->device.queue()(), owner_->buffer(), CL_TRUE, offset, bytes, data, 0,
                                      nullptr, nullptr);
    });
    if (error != CL_SUCCESS)
        throw RunError("writing " + owner_->name + " failed, OpenCL error " + std::to_string(error));
}

void Allocation::read(void* data, std::size_t bytes, std::size_t offset) const {
    const cl_int error = in_driver([&] {
        return ::clEnqueueReadBuffer(owner_->device.queue()(), owner_->buffer(), CL_TRUE, offset, bytes, data, 0,
                                     nullptr, nullptr);
    });
    if (error != CL_SUCCESS)
        throw RunError("reading " + owner_->name + " failed, OpenCL error " + std::to_string(error));
    owner_->device.shared_->bytes_read += bytes;
}

void Allocation::copy_to(const Allocation& target, std::size_t bytes) const {
    const cl_int error = in_driver([&] {
        return ::clEnqueueCopyBuffer(owner_->device.queue()(), owner_->buffer(), target.owner_->buffer(), 0, 0, bytes,
                                     0, nullptr, nullptr);
    });
    if (error != CL_SUCCESS)
        throw RunError("copying " + owner_->name + " failed, OpenCL error " + std::to_string(error));
}

}  // namespace stokes
