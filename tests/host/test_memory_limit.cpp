#include "tests/support/catch.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

// The driver compiles in this memory, finds none, and may wait for its own locks then. `timeout` ends it with exit code
// 124 where it does.
TEST_CASE("little memory is an error that says so", "[command line]") {
    for (const char* limit : {"-v 200000", "-v 300000", "-v 400000", "-v 450000", "-v 500000", "-d 60000"}) {
        const TemporaryFolder cache, folder;
        const std::string out = folder.file("a.exr"), err = folder.file("err");
        const std::string command = std::string("bash -c 'ulimit ") + limit + "; POCL_CACHE_DIR=" + cache.path() +
                                    " exec timeout 200 " + stokes_program() + " render " + sphere_scene + small_render +
                                    "--quiet -o " + out + " 2>" + err + "'";
        const int status = std::system(command.c_str());
        CAPTURE(limit, file_content(err));
        REQUIRE(WIFEXITED(status));
        CHECK(WEXITSTATUS(status) == 1);
        CHECK_THAT(file_content(err), Contains("out of memory; ulimit " + std::string(limit, 2)));
        CHECK(folder.names() == std::vector<std::string>{"err"});
    }
}
