// Programs and their kernels. A launch takes arguments by name, in groups, and binds those that the kernel declares.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "host/device/device.hpp"

namespace stokes {

// An argument as a kernel declares it: __global const Ray* rays has the name "rays", the type "Ray" and is a pointer.
struct KernelArgument {
    std::string name, type;
    bool pointer = false;
    std::uint64_t hash = 0;  // of the name
};

// The arguments of a kernel in the text of its program, macros of kernels/shared/arguments.h replaced. The text is read
// in place of asking the driver: not every driver knows the names, and PoCL changes some. RunError where there is no
// such kernel.
std::vector<KernelArgument> kernel_arguments(const std::string& source, const std::string& kernel);

// Names of the kernels in a program's text, in their order.
std::vector<std::string> kernel_names(const std::string& source);

// FNV-1a.
constexpr std::uint64_t name_hash(std::string_view name) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return hash;
}

// How OpenCL C spells a type of the host: "Ray", "uint", "float16".
template <class T>
std::string_view device_type_name() {
    if (std::is_same<T, Flux16>::value) return "float16";
    if (std::is_same<T, float>::value) return "float";
    if (std::is_same<T, std::int32_t>::value) return "int";
    if (std::is_same<T, std::uint32_t>::value) return "uint";
    if (std::is_same<T, std::uint64_t>::value) return "ulong";
    if (std::is_same<T, std::uint8_t>::value) return "uchar";
    const std::string_view text = __PRETTY_FUNCTION__;  // ".. [with T = stokes::Name; std::..]"
    const std::size_t start = text.find("T = ") + 4;
    const std::string_view full = text.substr(start, text.find_first_of(";]", start) - start);
    return full.substr(full.rfind(':') + 1);
}

// Arguments by name: buffers, whose memory they keep, or scalars and structs by value. Groups of them are made where
// the buffers are owned.
class Arguments {
  public:
    Arguments() = default;
    template <class T>
    Arguments(const char* name, const T& value) {
        add(name, value);
    }

    // type: how kernels spell the elements where it differs from T's own name.
    template <class T>
    Arguments& add(const char* name, const Buffer<T>& buffer, std::string_view type = device_type_name<T>()) {
        const cl_mem memory = buffer.allocated() ? buffer.cl_buffer()() : nullptr;
        put(name, type, true, &memory, sizeof memory);
        values_.back().owner = buffer.owner();
        return *this;
    }
    template <class T>
    Arguments& add(const char* name, const T& value, std::string_view type = device_type_name<T>()) {
        static_assert(std::is_trivially_copyable<T>::value, "kernel arguments are plain data");
        static_assert(!std::is_same<T, bool>::value && !std::is_same<T, double>::value && sizeof(T) % 4 == 0,
                      "kernel arguments are 32-bit words");
        static_assert(sizeof(T) <= sizeof(Value::bytes), "larger structs travel in buffers");
        return put(name, type, false, &value, sizeof value);
    }
    Arguments& add(const Arguments& group) {
        values_.insert(values_.end(), group.values_.begin(), group.values_.end());
        return *this;
    }

    struct Value {
        std::string_view name, type;
        std::uint64_t hash;
        bool pointer;
        std::size_t size;
        alignas(16) std::array<unsigned char, 96> bytes;
        std::shared_ptr<const void> owner;  // of a buffer; none where it was never made
    };
    const std::vector<Value>& values() const { return values_; }

  private:
    Arguments& put(const char* name, std::string_view type, bool pointer, const void* data, std::size_t size) {
        Value value{name, type, name_hash(name), pointer, size, {}, {}};
        std::memcpy(value.bytes.data(), data, size);
        values_.push_back(std::move(value));
        return *this;
    }
    std::vector<Value> values_;
};

class Kernel {
  public:
    Kernel() = default;
    Kernel(Device device, cl::Kernel kernel, std::string name, std::vector<KernelArgument> arguments);

    // Runs work_items work-items. Each argument is bound by name from the one group that has it; what the kernel does
    // not declare is left out. The global size is rounded up to the local size: kernels guard with their own count.
    // Asynchronous. RunError, which names kernel and argument, for an argument that no group or more than one has, or
    // of another type.
    template <class... Groups>
    void launch(std::size_t work_items, const Groups&... groups) const {
        const std::array<const Arguments*, sizeof...(Groups)> all{&groups...};
        run(work_items, all.data(), all.size());
    }

    const std::string& name() const { return name_; }
    const std::vector<KernelArgument>& arguments() const { return arguments_; }

  private:
    void run(std::size_t work_items, const Arguments* const* groups, std::size_t count) const;
    void bind(std::size_t index, const Arguments* const* groups, std::size_t count) const;
    void enqueue(std::size_t work_items) const;

    Device device_;
    cl::Kernel kernel_;
    std::string name_;
    std::vector<KernelArgument> arguments_;
};

class Program {
  public:
    // file: below kernels/, for example "trace_rays.cl". options: extra compiler options such as "-DWIDTH=8".
    // RunError with the compiler's log when it does not build.
    Program(const Device& device, const std::string& file, const std::vector<std::string>& options = {});
    static Program from_source(const Device& device, const std::string& name, const std::string& text,
                               const std::vector<std::string>& options = {});
    Kernel kernel(const std::string& name) const;

  private:
    explicit Program(const Device& device) : device_(device) {}
    void build(const std::string& name, const std::string& text, const std::vector<std::string>& options);
    Device device_;
    cl::Program program_;
    std::string file_, source_;
};

// Text of a kernel file with its #include "..." lines replaced by the files' text (each once), #line kept.
// directory: where kernels are read from, empty for the embedded ones. RunError for a file that is not there.
std::string expand_kernel_source(const std::string& name, const std::string& text, const std::string& directory);
std::string read_kernel_file(const std::string& file, const std::string& directory);

}  // namespace stokes
