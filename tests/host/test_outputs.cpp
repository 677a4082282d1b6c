#include <unistd.h>

#include "host/commands/outputs.hpp"
#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

TEST_CASE("outputs that can be written pass, and leave nothing", "[outputs]") {
    const TemporaryFolder folder;
    put_file(folder.file("old.png"), "old");
    CHECK_NOTHROW(check_outputs({folder.file("a.exr"), folder.file("old.png"), ""}, "scene.json"));
    CHECK_NOTHROW(check_outputs({"", "", ""}, "scene.json"));
    CHECK(folder.names() == std::vector<std::string>{"old.png"});
    CHECK(file_content(folder.file("old.png")) == "old");
}

TEST_CASE("outputs that cannot be written are found before the render", "[outputs]") {
    const TemporaryFolder folder;
    const auto error_of = [](const std::string& file) { return input_error([&] { check_outputs({file}, "s.json"); }); };
    CHECK(error_of("/dev/null") == "/dev/null: cannot write: not a regular file");
    CHECK_THAT(error_of("/proc/stokes.png"), Contains("/proc/stokes.png: cannot write: "));
    CHECK(error_of(folder.path()) == folder.path() + ": cannot write: not a regular file");
    CHECK_THAT(error_of(folder.file("none/a.png")), Contains("none/a.png: cannot write: No such file or directory"));
    CHECK_THAT(error_of(folder.file(std::string(300, 'x'))), Contains("name too long"));
}

TEST_CASE("no output replaces another or the scene", "[outputs]") {
    const TemporaryFolder folder;
    const std::string scene = folder.file("s.json"), link = folder.file("link.json");
    put_file(scene, "{}");
    REQUIRE(::symlink(scene.c_str(), link.c_str()) == 0);
    const std::string a = folder.file("a.png"), again = folder.path() + "/./a.png";
    CHECK_THAT(input_error([&] { check_outputs({a, a}, scene); }), Contains("expected another file for each output"));
    CHECK_THAT(input_error([&] { check_outputs({a, "", again}, scene); }), Contains("another file for each output"));
    CHECK_THAT(input_error([&] {
                   check_outputs({"", scene}, scene);
               }),
               Contains("this output would replace the scene"));
    CHECK_THAT(input_error([&] { check_outputs({link}, scene); }), Contains("this output would replace the scene"));
}

TEST_CASE("one output that fails does not lose the others", "[outputs]") {
    const TemporaryFolder folder;
    const auto writer = [&](const std::string& name) -> Output {
        return {folder.file(name), [file = folder.file(name)] { write_file_atomically(file, "x"); }};
    };
    CHECK_THROWS_WITH(
        write_outputs({writer("none/a"), writer("b"), {"", [] { FAIL("no output"); }}, writer("none/c"), writer("d")},
                      true),
        Contains("none/a: cannot write"));
    CHECK(folder.names() == std::vector<std::string>{"b", "d"});
}
