#include "tests/support/catch.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

// Exit code of bash, with $STOKES for the program.
int run_bash(const std::string& script) {
    const std::string command = "STOKES=" + stokes_program() + " bash -c '" + script + "'";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool is_exr(const std::string& path) { return file_content(path).substr(0, 4) == "\x76\x2f\x31\x01"; }

bool is_png(const std::string& path) { return file_content(path).substr(0, 8) == "\x89PNG\r\n\x1a\n"; }

}  // namespace

// The scene drops deposits in this render, so that there is something to say at its end.
TEST_CASE("a render is written when its words cannot be", "[command line]") {
    for (const std::string streams :
         {"2>/dev/full", "2>&-", ">/dev/full 2>&1", ">&- 2>&-", "<&- >&- 2>&-", "2>&1 | true; exit ${PIPESTATUS[0]}",
          "2>&1 | head -c 1; exit ${PIPESTATUS[0]}"}) {
        const TemporaryFolder folder;
        CAPTURE(streams);
        CHECK(run_bash("$STOKES render " + sphere_scene + small_render + "-o " + folder.file("a.exr") + " --png " +
                       folder.file("a.png") + " " + streams) == 0);
        REQUIRE(folder.names() == std::vector<std::string>{"a.exr", "a.png"});
        CHECK(is_exr(folder.file("a.exr")));
        CHECK(is_png(folder.file("a.png")));
    }
}

TEST_CASE("files are written, and what should have been printed is an error", "[command line]") {
    const TemporaryFolder folder;
    const std::string json = folder.file("a.json"), exr = folder.file("a.exr"), map = folder.file("map.png");
    CHECK(run_bash("$STOKES probe --sigma-s 1 --sigma-a 0.1 --photons 20000 --json " + json + " >/dev/full 2>&-") == 1);
    CHECK_THAT(file_content(json), Contains("\"reflectance\""));
    REQUIRE(run_bash("$STOKES render " + sphere_scene + small_render + "--quiet -o " + exr) == 0);
    CHECK(run_bash("$STOKES compare " + exr + " " + exr + " --diff " + map + " >/dev/full 2>&-") == 1);
    CHECK(is_png(map));
}

TEST_CASE("what is printed is printed whole, or the exit code is 1", "[command line]") {
    const TemporaryFolder folder;
    for (const std::string command : {"schema", "schema --table", "devices", "--help", "render --help", "--version"}) {
        CAPTURE(command);
        CHECK(run_bash("$STOKES " + command + " >/dev/full 2>" + folder.file("err")) == 1);
        CHECK_THAT(file_content(folder.file("err")), Contains("stokes: standard output: cannot write: "));
        CHECK(run_bash("$STOKES " + command + " >&- 2>&1") == 1);
        CHECK(run_bash("$STOKES " + command + " | true; exit ${PIPESTATUS[0]}") == 0);  // who reads wants no more
    }
}

TEST_CASE("an error keeps its exit code where nobody can read it", "[command line]") {
    for (const std::string stream : {"2>/dev/full", "2>&-", "2>&1 | true; exit ${PIPESTATUS[0]}"}) {
        CAPTURE(stream);
        CHECK(run_bash("$STOKES render nowhere.json --png x.png " + stream) == 2);
    }
}
