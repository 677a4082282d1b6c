#include <unistd.h>

#include "host/commands/outputs.hpp"
#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/core/text_input.hpp"
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

TEST_CASE("a name that belongs to another format is refused", "[outputs]") {
    const auto error_of = [](const OutputName& output) { return input_error([&] { check_endings({output}); }); };
    CHECK(error_of({"-o", "a/b.png", ".exr"}) ==
          "a/b.png: -o writes an OpenEXR picture; expected a name that ends in .exr");
    for (const OutputName& wrong : std::vector<OutputName>{{"--png", "x.jpg", ".png"},
                                                           {"--png", "x.JPEG", ".png"},
                                                           {"--png", "x.exr", ".png"},
                                                           {"-o", "x.hdr", ".exr"},
                                                           {"-o", "x.exr.gz", ".exr"},
                                                           {"--stats", "x.csv", ".json"},
                                                           {"--csv", "x.json", ".csv"},
                                                           {"--csv", "x.txt", ".csv"},
                                                           {"-o", "g.json", ".json.gz"}}) {
        CAPTURE(wrong.file);
        CHECK_THAT(error_of(wrong), Contains(wrong.file + ": ") && Contains("ends in " + wrong.ending));
    }
    CHECK_THAT(error_of({"--stats", "-", ".json"}), Contains("--stats: expected the name of a file"));
    for (const OutputName& right : std::vector<OutputName>{{"-o", "x.exr", ".exr"},
                                                           {"-o", "x.EXR", ".exr"},
                                                           {"-o", "x.png/y", ".exr"},
                                                           {"-o", "plain", ".exr"},
                                                           {"-o", "", ".exr"},
                                                           {"-o", "g.json.gz", ".json.gz"},
                                                           {"--png", "2024.11.28.png", ".png"}}) {
        CAPTURE(right.file);
        CHECK_NOTHROW(check_endings({right}));
    }
}

TEST_CASE("no output replaces a file that was read", "[outputs]") {
    const TemporaryFolder folder;
    put_file(folder.file("lamp.csv"), "x");
    read_file(folder.path() + "/./lamp.csv");
    CHECK_THAT(input_error([&] {
                   check_keeps_inputs({folder.file("b.csv"), folder.file("lamp.csv")});
               }),
               Contains("lamp.csv: this output would replace a file that is read"));
    CHECK_NOTHROW(check_keeps_inputs({folder.file("b.csv"), ""}));
}
