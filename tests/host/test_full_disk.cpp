#include "tests/support/catch.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

// No file may grow beyond 2 MB, as on a disk that has no more room; the system sends SIGXFSZ besides. The picture of
// 512 x 512 pixels and 15 channels is larger, its PNG and figures are not.
TEST_CASE("a full disk keeps the file that was there, and the other outputs are written", "[command line]") {
    const TemporaryFolder folder;
    put_file(folder.file("a.exr"), "before");
    const std::string command = "bash -c 'ulimit -f 2000; exec " + stokes_program() + " render " + sphere_scene +
                                " --size 512x512 --passes 1 --photons 200000 --quiet -o " + folder.file("a.exr") +
                                " --png " + folder.file("a.png") + " --stats " + folder.file("a.json") + " 2>" +
                                folder.file("err") + "'";
    const int status = std::system(command.c_str());
    const std::string error = file_content(folder.file("err"));
    CAPTURE(error);
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 1);
    CHECK(error == "stokes: " + folder.file("a.exr") + ": cannot write: File too large\n");
    CHECK(file_content(folder.file("a.exr")) == "before");
    CHECK(folder.names() == std::vector<std::string>{"a.exr", "a.json", "a.png", "err"});
}

TEST_CASE("a folder for compiled kernels without room is replaced, or said to be full", "[command line]") {
    const TemporaryFolder folder, cache, other;
    const std::string command = "bash -c 'ulimit -f 500; POCL_CACHE_DIR=" + cache.path() + " TMPDIR=" + other.path() +
                                " exec " + stokes_program() + " devices 2>" + folder.file("err") + "'";
    const int status = std::system(command.c_str());
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 1);
    CHECK_THAT(file_content(folder.file("err")), Contains("compiled kernels cannot be kept here: File too large"));
    CHECK(cache.names().empty());
}
