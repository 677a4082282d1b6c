#include <nlohmann/json.hpp>

#include "tests/support/catch.hpp"
#include "tests/support/run_stokes.hpp"
#include "tests/support/running_stokes.hpp"

using namespace stokes;

namespace {

std::vector<std::string> long_render(const TemporaryFolder& folder, const std::string& passes = "100000000") {
    return {"render", sphere_scene, "--passes",           passes,    "--photons",          "4000", "--size",
            "24x16",  "--png",      folder.file("a.png"), "--stats", folder.file("a.json")};
}

const std::vector<std::string> both = {"a.json", "a.png"};

int passes_in(const TemporaryFolder& folder) {
    return nlohmann::json::parse(file_content(folder.file("a.json")))["passes"];
}

}  // namespace

TEST_CASE("a signal that asks a render to end leaves the passes there are", "[command line]") {
    for (const int signal : {SIGHUP, SIGTERM, SIGINT, SIGXCPU}) {
        const TemporaryFolder folder;
        RunningStokes render(long_render(folder));
        REQUIRE(render.wait_for("remaining "));
        render.send(signal);
        CAPTURE(signal, render.shown());
        CHECK(render.end() == 128 + signal);
        REQUIRE(folder.names() == both);
        CHECK(passes_in(folder) >= 1);
        CHECK(passes_in(folder) < 100000000);
    }
}

// A shell that gets SIGHUP sends it on, and the system sends it as well; `timeout` signals the program and its group.
TEST_CASE("the same signal twice in a row counts once", "[command line]") {
    for (const int signal : {SIGHUP, SIGTERM}) {
        const TemporaryFolder folder;
        RunningStokes render(long_render(folder));
        REQUIRE(render.wait_for("remaining "));
        for (int i = 0; i < 3; ++i) render.send(signal);
        CHECK(render.end() == 128 + signal);
        CHECK(folder.names() == both);
    }
}

TEST_CASE("a render whose terminal is closed leaves the passes there are", "[command line]") {
    const TemporaryFolder folder;
    RunningStokes render(long_render(folder));
    REQUIRE(render.wait_for("remaining "));
    render.close_terminal();
    CHECK(render.end() == 128 + SIGHUP);
    REQUIRE(folder.names() == both);
    CHECK(passes_in(folder) >= 1);
}

TEST_CASE("a signal that was ignored when the program began stays ignored", "[command line]") {
    const std::vector<int> ignored = {SIGINT, SIGHUP, SIGTERM};
    const TemporaryFolder folder;
    RunningStokes render(long_render(folder, "400"), ignored);
    REQUIRE(render.wait_for("remaining "));
    for (const int signal : ignored) render.send(signal);
    CHECK(render.end() == 0);
    REQUIRE(folder.names() == both);
    CHECK(passes_in(folder) == 400);
}

TEST_CASE("a signal ends a command that has nothing to keep, and leaves no file", "[command line]") {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const TemporaryFolder folder;
        RunningStokes probe({"probe", "--sigma-s", "1", "--sigma-a", "0.01", "--photons", "1000000000000", "--lambda",
                             "500", "--matrix", folder.file("a.csv")});
        ::usleep(100000 * static_cast<unsigned>(signal % 7));  // wherever it finds the program
        probe.send(signal);
        CHECK(probe.end() == 128 + signal);
        CHECK(folder.names().empty());
    }
}
