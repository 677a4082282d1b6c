#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/catch.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;

TEST_CASE("a folder for compiled kernels that is not there yet is made", "[device]") {
    const TemporaryFolder folder;
    for (const std::string name : {"XDG_CACHE_HOME", "POCL_CACHE_DIR"}) {
        const TemporaryFolder temporary;
        const std::string cache = folder.file(name + "/deep/cache");
        const Outcome outcome =
            run_stokes("devices", "env -u POCL_CACHE_DIR " + name + "=" + cache + " TMPDIR=" + temporary.path());
        CAPTURE(name, outcome.err);
        CHECK(outcome.code == 0);
        CHECK(outcome.err.empty());
        CHECK(std::filesystem::is_directory(cache));
        CHECK(temporary.names().empty());
    }
}

TEST_CASE("where it cannot be made, every run uses one folder of the user's own", "[device]") {
    const TemporaryFolder folder, temporary;
    put_file(folder.file("plain"), "");
    const std::string environment =
        "env -u POCL_CACHE_DIR XDG_CACHE_HOME=" + folder.file("plain/cache") + " TMPDIR=" + temporary.path();
    for (int run = 0; run < 2; ++run) {
        const Outcome outcome = run_stokes("devices", environment);
        CHECK(outcome.code == 0);
        CHECK(outcome.err.find("cannot be written; they are kept in " + temporary.path()) != std::string::npos);
    }
    const std::string own = "stokes-pocl-" + std::to_string(::getuid());
    REQUIRE(temporary.names() == std::vector<std::string>{own});
    struct stat found {};
    REQUIRE(::stat(temporary.file(own).c_str(), &found) == 0);
    CHECK((found.st_mode & 0777) == 0700);
    CHECK(found.st_uid == ::getuid());

    REQUIRE(::chmod(temporary.file(own).c_str(), 0777) == 0);  // anyone could have put kernels there
    const Outcome outcome = run_stokes("devices", environment);
    CHECK(outcome.code == 1);
    CHECK(outcome.err.find("no folder of your own for compiled kernels") != std::string::npos);
}
