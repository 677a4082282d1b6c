#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "host/core/embedded.hpp"
#include "host/render/photon_pass.hpp"
#include "host/render/transport/conserving_transport.hpp"
#include "host/render/transport/paper_transport.hpp"
#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/paths.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

using Names = std::set<std::string>;

// Files of entry kernels.
std::vector<std::string> kernel_files() {
    std::vector<std::string> files;
    for (const auto& [name, text] : embedded_files())
        if (name.compare(0, 8, "kernels/") == 0 && name.size() > 3 && name.compare(name.size() - 3, 3, ".cl") == 0)
            files.push_back(name.substr(8));
    return files;
}

std::string source_of(const std::string& file) { return expand_kernel_source(file, read_kernel_file(file, ""), ""); }

// Groups of kernels/shared/arguments.h and their names, read by a kernel that takes one group alone.
std::map<std::string, Names> groups() {
    std::map<std::string, Names> result;
    const std::string header = read_kernel_file("shared/arguments.h", "");
    std::istringstream lines(header);
    for (std::string line; std::getline(lines, line);) {
        if (line.compare(0, 8, "#define ") != 0) continue;
        std::istringstream words(line.substr(8));
        std::string name;
        words >> name;
        if (name.find("_ARGUMENTS") == std::string::npos || name == "STOKES_SHARED_ARGUMENTS_H") continue;
        for (const KernelArgument& argument :
             kernel_arguments(header + "\n__kernel void one(" + name + ") {}\n", "one"))
            result[name].insert(argument.name);
    }
    return result;
}

Names names_of(const Arguments& arguments) {
    Names names;
    for (const Arguments::Value& value : arguments.values()) names.emplace(value.name);
    return names;
}

Kernel copying() {
    return Program::from_source(test_device(), "copy.cl",
                                "__kernel void copy(uint n, __global const float* from, __global float* to) {\n"
                                "    const uint i = (uint)get_global_id(0);\n"
                                "    if (i < n) to[i] = from[i];\n}\n")
        .kernel("copy");
}

std::string failure(const Arguments& arguments) {
    try {
        copying().launch(1, arguments);
    } catch (const RunError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("a launch binds its arguments by name, in any order", "[arguments][tiny]") {
    const Buffer<float> from(test_device(), "from", std::vector<float>{1.0f, 2.0f, 3.0f});
    const Buffer<float> to(test_device(), "to", std::vector<float>(3, 0.0f));
    copying().launch(3, Arguments("to", to).add("unused", 7u), Arguments("from", from).add("n", 2u));
    CHECK(to.download() == std::vector<float>{1.0f, 2.0f, 0.0f});
}

TEST_CASE("a wrong or missing argument is an error that names it", "[arguments]") {
    const Buffer<float> buffer(test_device(), "floats", 3);
    const Buffer<std::uint32_t> other(test_device(), "words", 3);
    const Arguments sound = Arguments("n", 3u).add("from", buffer);
    CHECK(failure(sound) == "kernel copy: its argument to (float*) is bound by no group");
    CHECK(failure(Arguments("to", other).add(sound)) == "kernel copy: its argument to (float*) got uint*");
    CHECK(failure(Arguments("to", 1.0f).add(sound)) == "kernel copy: its argument to (float*) got float");
    CHECK(failure(Arguments("to", Buffer<float>()).add(sound)) ==
          "kernel copy: its argument to (float*) has no buffer yet");
    CHECK(failure(Arguments("to", buffer).add("to", buffer).add(sound)) ==
          "kernel copy: its argument to (float*) is bound twice");
    CHECK(failure(Arguments("to", buffer).add("from", buffer).add("n", 3.0f)) ==
          "kernel copy: its argument n (uint) got float");
    CHECK(failure(Arguments("to", buffer).add(sound)).empty());
}

// What the host reads in the programs' texts against what the driver knows of the compiled kernels.
TEST_CASE("the arguments of every kernel are those that the driver sees", "[arguments]") {
    std::ostringstream table;
    for (const std::string& file : kernel_files()) {
        const std::string source = source_of(file);
        const cl::Program program = test_device().program(source, "-cl-std=CL1.2 -cl-kernel-arg-info");
        for (const std::string& name : kernel_names(source)) {
            cl::Kernel kernel(program, name.c_str());
            const std::vector<KernelArgument> arguments = kernel_arguments(source, name);
            CAPTURE(file, name);
            REQUIRE(kernel.getInfo<CL_KERNEL_NUM_ARGS>() == arguments.size());
            table << name << '\n';
            for (cl_uint i = 0; i < arguments.size(); ++i) {
                const KernelArgument& a = arguments[i];
                std::string type = kernel.getArgInfo<CL_KERNEL_ARG_TYPE_NAME>(i);
                while (!type.empty() && (type.back() == '\0' || type.back() == ' ')) type.pop_back();
                CAPTURE(i, a.name);
                CHECK(type == a.type + (a.pointer ? "*" : ""));
                // PoCL 3.1 names an argument that is called like a built-in function, round, otherwise.
                std::string driver_name = kernel.getArgInfo<CL_KERNEL_ARG_NAME>(i);
                while (!driver_name.empty() && driver_name.back() == '\0') driver_name.pop_back();
                if (a.name != "round") CHECK(driver_name == a.name);
                table << "    " << a.name << "  " << type << '\n';
            }
        }
    }
    INFO(table.str());
    CHECK(table.str().find("gather_radiance\n    count  uint\n") != std::string::npos);
}

// A picture's photons and what its camera reads.
TEST_CASE("every group of arguments is bound by its owner", "[arguments]") {
    const Scene scene = read_scene(source_path("tests/image/kinds.json"));
    const DeviceScene on_device(test_device(), scene);
    const PhotonPass pass(test_device(), scene, on_device, 64, 64);
    const PhotonPaths paths(test_device(), 16);
    const SpatialHash hash(test_device(), "map", 16);
    Names bound = names_of(pass.arguments());
    for (const Arguments& more : {paths.arguments(), pass.maps()[0].arguments(), hash.arguments()})
        for (const std::string& name : names_of(more)) CHECK(bound.insert(name).second);
    const Names tables = names_of(ConservingTransport(test_device(), scene, on_device).tables());
    CHECK(names_of(PaperTransport(test_device(), scene).tables()) == tables);
    for (const std::string& name : tables) CHECK(bound.insert(name).second);
    for (const auto& [group, names] : groups()) {
        CAPTURE(group);
        CHECK(!names.empty());
        for (const std::string& name : names) CHECK(bound.count(name) == 1);
    }
}
