#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;

namespace {

std::size_t occurrences(const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
    return count;
}

// The text of the error that building this file gives; empty when it builds.
std::string build_error(const Device& device, const std::string& file) {
    try {
        Program(device, file);
        return "";
    } catch (const std::runtime_error& error) {
        return error.what();
    }
}

// A device that reads its kernels from a folder of this test, with lib and shared below it.
struct KernelFolder {
    KernelFolder() : device(test_device()) {
        std::filesystem::create_directories(folder.file("lib"));
        std::filesystem::create_directories(folder.file("shared"));
        device.set_kernel_directory(folder.path());
    }
    ~KernelFolder() { device.set_kernel_directory(""); }
    void put(const std::string& file, const std::string& text) const { put_file(folder.file(file), text); }

    TemporaryFolder folder;
    Device device;
};

const char* const empty_kernel = "__kernel void nothing(__global float* x) { x[0] = 1.0f; }\n";

}  // namespace

TEST_CASE("every file is included once, where it is first asked for", "[kernel_source]") {
    const KernelFolder kernels;
    kernels.put("shared/unit.h", "// unit\n");
    kernels.put("shared/pair.h", "#include \"unit.h\"\n// pair\n");  // a sibling, by its bare name
    kernels.put("lib/twice.clh", "#include \"shared/pair.h\"\n#include \"shared/unit.h\"\n// twice\n");
    const std::string text = expand_kernel_source(
        "top.cl", "#include \"lib/twice.clh\"\n  #include \"shared/unit.h\"\n// top\n", kernels.folder.path());
    for (const char* word : {"// unit\n", "// pair\n", "// twice\n", "// top\n"}) CHECK(occurrences(text, word) == 1);
    CHECK(text.find("// unit") < text.find("// pair"));
    CHECK(text.find("// pair") < text.find("// twice"));
    CHECK(text.find("// twice") < text.find("// top"));
    CHECK(text.find("#include") == std::string::npos);
}

TEST_CASE("a file that includes itself ends", "[kernel_source]") {
    const KernelFolder kernels;
    kernels.put("lib/a.clh", "#include \"lib/b.clh\"\n// a\n");
    kernels.put("lib/b.clh", "#include \"lib/a.clh\"\n// b\n");
    const std::string text = expand_kernel_source("top.cl", "#include \"lib/a.clh\"\n", kernels.folder.path());
    CHECK(occurrences(text, "// a\n") == 1);
    CHECK(occurrences(text, "// b\n") == 1);
}

TEST_CASE("an error is reported with the file and the line it stands in", "[kernel_source]") {
    const KernelFolder kernels;
    kernels.put("lib/fine.clh", "inline float fine(float x) { return x; }\n\n\n");
    kernels.put("lib/wrong.clh",
                "// one\n#include \"lib/fine.clh\"\n// three\nfloat wrong() { return no_such_name; }\n");
    kernels.put("user.cl", std::string("#include \"lib/wrong.clh\"\n") + empty_kernel);
    CHECK_THAT(build_error(kernels.device, "user.cl"), Catch::Contains("kernels/user.cl does not compile") &&
                                                           Catch::Contains("kernels/lib/wrong.clh:4:") &&
                                                           Catch::Contains("no_such_name"));

    kernels.put("late.cl", "// one\n#include \"lib/fine.clh\"\n#include \"lib/fine.clh\"\n" +
                               std::string(empty_kernel) + "float five() { return missing_five; }\n");
    CHECK_THAT(build_error(kernels.device, "late.cl"),
               Catch::Contains("kernels/late.cl:5:") && Catch::Contains("missing_five"));
}

TEST_CASE("an include or a kernel that is not there is an error that names it", "[kernel_source]") {
    const KernelFolder kernels;
    kernels.put("user.cl", std::string("#include \"lib/absent.clh\"\n") + empty_kernel);
    CHECK_THAT(build_error(kernels.device, "user.cl"), Catch::Contains("lib/absent.clh"));
    CHECK_THAT(build_error(kernels.device, "absent.cl"), Catch::Contains("absent.cl"));
    kernels.put("fine.cl", empty_kernel);
    CHECK_THROWS_AS(Program(kernels.device, "fine.cl").kernel("something"), RunError);
    CHECK_NOTHROW(Program(kernels.device, "fine.cl").kernel("nothing"));
}

TEST_CASE("kernels travel in the program", "[kernel_source]") {
    CHECK_THAT(read_kernel_file("lib/rng.clh", ""), Catch::Contains("philox4x32"));
    CHECK_THROWS_AS(read_kernel_file("lib/absent.clh", ""), RunError);
    const std::string text = expand_kernel_source("emit_photons.cl", read_kernel_file("emit_photons.cl", ""), "");
    CHECK(occurrences(text, "typedef struct Ray {") == 1);
    CHECK(text.find("#include \"") == std::string::npos);
}
