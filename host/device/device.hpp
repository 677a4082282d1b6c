// A device with its queue, and typed buffers. host/device is the only room that says cl::.
#pragma once

#include <CL/opencl.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "host/core/error.hpp"
#include "host/core/words.hpp"

namespace stokes {

// Sixteen spectral values, laid out as the float16 of kernels.
struct alignas(64) Flux16 {
    float v[16];
};

struct DeviceDescription {
    std::string selector;  // "platform:device"
    std::string platform, name, version, driver;
    bool cpu = false, gpu = false, available = false;
    unsigned compute_units = 0;
    unsigned vector_floats = 1;  // in one of its own vectors
    std::uint64_t memory_bytes = 0, largest_allocation_bytes = 0;
};

// How a device's kernels trace rays; every shape finds the same hits.
// avx512, avx2, portable: a work-item tests all children of a node, or eight triangles, at once; the first two
// take masks by the processor's own instructions. scalar: one after the other, for devices whose work-items are lanes
// themselves.
enum class RayShape { avx512, avx2, portable, scalar };
template <>
inline const Words words_of<RayShape> = {"avx512", "avx2", "portable", "scalar"};

// Chooses the shape by what the device says of itself: whether it is a CPU, and the width of its vectors. x86: whether
// this program runs on such a processor, of which a CPU device is part.
RayShape choose_ray_shape(const DeviceDescription& device, bool x86);
RayShape choose_ray_shape(const DeviceDescription& device);

// All OpenCL devices, in the order of platforms and devices. RunError when there is no OpenCL driver at all.
std::vector<DeviceDescription> list_devices();

struct StageTime {
    double seconds = 0.0;
    std::uint64_t launches = 0;
};

// One opened device. Copies share the same queue. Launches and transfers run in order.
class Device {
  public:
    // selector: "" (first CPU, else first device), "platform:device" index, "cpu", "gpu", or part of a name
    // (case-insensitive). threads: CPU threads, 0 for all; only before the first open in a process.
    // InputError for a selector that matches nothing, RunError for driver failures.
    static Device open(const std::string& selector, int threads = 0);

    const DeviceDescription& description() const { return shared_->description; }
    const cl::Context& context() const { return shared_->context; }
    const cl::CommandQueue& queue() const { return shared_->queue; }

    // Waits for all launches.
    void finish() const;

    // The program of this text, which is built when it is first asked for. Errors: cl::Error.
    cl::Program program(const std::string& source, const std::string& flags) const;

    // Directory to read kernels from in place of the embedded text; empty: embedded.
    void set_kernel_directory(const std::string& directory) { shared_->kernel_directory = directory; }
    const std::string& kernel_directory() const { return shared_->kernel_directory; }

    // Work-items per work-group of every launch; results never depend on it.
    void set_local_size(std::size_t size) { shared_->local_size = size; }
    std::size_t local_size() const { return shared_->local_size; }

    // Sets how the device's ray kernels are built; choose_ray_shape() says it otherwise.
    void set_ray_shape(RayShape shape) { shared_->ray_shape = shape; }
    RayShape ray_shape() const { return shared_->ray_shape.value_or(choose_ray_shape(description())); }

    // Measured seconds per kernel name, gathered from the driver's profile when this is called or finish()
    // was.
    const std::map<std::string, StageTime>& stage_times() const;
    void reset_stage_times();
    void record(const std::string& kernel_name, const cl::Event& event) const;

    // Sets a question that every build and launch asks first, until it is set again or emptied. Once its answer is true
    // they throw Interrupted, so that a long set-up can be ended.
    void set_stop(std::function<bool()> stop) { shared_->stop = std::move(stop); }
    void check_stop() const {
        if (shared_->stop && shared_->stop()) throw Interrupted("interrupted");
    }

    // Memory budget [bytes] for all buffers together; allocation above it is an InputError that names the
    // buffer.
    void set_memory_budget(std::uint64_t bytes) { shared_->memory_budget = bytes; }
    std::uint64_t memory_in_use() const { return shared_->memory_in_use; }
    // So far: how many buffers were made, and how much was read back from them [bytes].
    std::uint64_t allocations() const { return shared_->allocations; }
    std::uint64_t bytes_read() const { return shared_->bytes_read; }
    std::uint64_t memory_left() const {
        return shared_->memory_budget - std::min(shared_->memory_in_use, shared_->memory_budget);
    }

  private:
    friend class Allocation;
    struct Shared {
        DeviceDescription description;
        cl::Device device;
        cl::Context context;
        std::map<std::pair<std::string, std::string>, cl::Program> programs;  // by source and flags
        cl::CommandQueue queue;
        std::string kernel_directory;
        std::size_t local_size = 64;
        std::optional<RayShape> ray_shape;
        std::function<bool()> stop;
        std::uint64_t memory_budget = 0, memory_in_use = 0, allocations = 0, bytes_read = 0;
        std::map<std::string, StageTime> stage_times;
        std::vector<std::pair<std::string, cl::Event>> pending;
    };
    void collect() const;
    std::shared_ptr<Shared> shared_;
};

// Memory behind a buffer: host memory that a CPU device uses in place (huge pages), device memory elsewhere.
class Allocation {
  public:
    Allocation() = default;
    Allocation(const Device& device, const std::string& name, std::size_t bytes);
    bool allocated() const { return owner_ != nullptr; }
    const cl::Buffer& buffer() const { return owner_->buffer; }
    const Device& device() const { return owner_->device; }
    // The memory's owner, which keeps the memory alive.
    std::shared_ptr<const void> owner() const { return owner_; }
    void write(const void* data, std::size_t bytes, std::size_t offset) const;
    void read(void* data, std::size_t bytes, std::size_t offset) const;
    void copy_to(const Allocation& target, std::size_t bytes) const;

  private:
    struct Owner {
        Device device;
        std::string name;
        std::size_t bytes = 0;
        void* host = nullptr;
        cl::Buffer buffer;
        ~Owner();
    };
    std::shared_ptr<Owner> owner_;
};

// count elements of T on the device, contents undefined until written. Copies share the memory.
template <class T>
class Buffer {
    static_assert(std::is_trivially_copyable<T>::value, "device data is plain data");

  public:
    Buffer() = default;
    Buffer(const Device& device, const std::string& name, std::size_t count)
        : allocation_(device, name, std::max<std::size_t>(count, 1) * sizeof(T)), size_(count) {}
    Buffer(const Device& device, const std::string& name, const std::vector<T>& data)
        : Buffer(device, name, data.size()) {
        upload(data);
    }

    std::size_t size() const { return size_; }
    bool allocated() const { return allocation_.allocated(); }
    const cl::Buffer& cl_buffer() const { return allocation_.buffer(); }
    std::shared_ptr<const void> owner() const { return allocation_.owner(); }

    void upload(const T* data, std::size_t count, std::size_t offset = 0) const {
        check(count, offset);
        if (count > 0) allocation_.write(data, count * sizeof(T), offset * sizeof(T));
    }
    void upload(const std::vector<T>& data) const { upload(data.data(), data.size()); }
    // The first count elements, on the device; asynchronous.
    void copy_to(const Buffer<T>& target, std::size_t count) const {
        check(count, 0);
        target.check(count, 0);
        if (count > 0) allocation_.copy_to(target.allocation_, count * sizeof(T));
    }
    std::vector<T> download() const { return download(size_); }
    std::vector<T> download(std::size_t count, std::size_t offset = 0) const {
        check(count, offset);
        std::vector<T> result(count);
        if (count > 0) allocation_.read(result.data(), count * sizeof(T), offset * sizeof(T));
        return result;
    }

  private:
    void check(std::size_t count, std::size_t offset) const {
        if (offset > size_ || count > size_ - offset) throw RunError("transfer outside of a device buffer");
    }
    Allocation allocation_;
    std::size_t size_ = 0;
};

}  // namespace stokes
