#include <sys/stat.h>
#include <unistd.h>

#include <string>

#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;

TEST_CASE("a file is written whole and replaces what was there") {
    const TemporaryFolder folder;
    const std::string path = folder.file("out.txt");
    const std::string large(3000000, 'x');
    write_file_atomically(path, large);
    CHECK(file_content(path) == large);
    write_file_atomically(path, "short");
    CHECK(file_content(path) == "short");
    CHECK(folder.names() == std::vector<std::string>{"out.txt"});
}

TEST_CASE("a full disk leaves the old file and no temporary") {
    const TemporaryFolder folder;
    const std::string path = folder.file("out.txt");
    put_file(path, "before");
    {
        const FullDisk full(1000);
        CHECK_THROWS_AS(write_file_atomically(path, std::string(5000, 'x')), RunError);
    }
    CHECK(file_content(path) == "before");
    CHECK(folder.names() == std::vector<std::string>{"out.txt"});
}

TEST_CASE("a folder that is missing or is a file is a run-time error that names the path") {
    const TemporaryFolder folder;
    put_file(folder.file("plain"), "");
    CHECK_THROWS_WITH(write_file_atomically(folder.file("missing/out.txt"), "x"),
                      Catch::Contains("missing/out.txt: cannot write: No such file or directory"));
    CHECK_THROWS_WITH(write_file_atomically(folder.file("plain/out.txt"), "x"),
                      Catch::Contains("plain/out.txt: cannot write: Not a directory"));
    CHECK(folder.names() == std::vector<std::string>{"plain"});
}

TEST_CASE("devices, pipes and folders are not replaced by files") {
    const TemporaryFolder folder;
    const std::string pipe = folder.file("pipe");
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    CHECK_THROWS_WITH(write_file_atomically(pipe, "x"), Catch::Contains("not a regular file"));
    CHECK_THROWS_WITH(write_file_atomically(folder.path(), "x"), Catch::Contains("not a regular file"));
    CHECK(folder.names() == std::vector<std::string>{"pipe"});
}

TEST_CASE("a symbolic link stays one and its target changes") {
    const TemporaryFolder folder;
    put_file(folder.file("target"), "before");
    REQUIRE(::symlink(folder.file("target").c_str(), folder.file("link").c_str()) == 0);
    write_file_atomically(folder.file("link"), "after");
    CHECK(std::filesystem::is_symlink(folder.file("link")));
    CHECK(file_content(folder.file("target")) == "after");
    CHECK(folder.names() == std::vector<std::string>{"link", "target"});
}

TEST_CASE("whether a file can be written is found without writing it") {
    const TemporaryFolder folder;
    put_file(folder.file("old"), "before");
    CHECK_NOTHROW(check_can_be_written(folder.file("old")));
    CHECK_NOTHROW(check_can_be_written(folder.file("new")));
    CHECK_THROWS_AS(check_can_be_written(folder.file("missing/out.txt")), RunError);
    CHECK_THROWS_WITH(check_can_be_written("/dev/null"), "/dev/null: cannot write: not a regular file");
    CHECK(file_content(folder.file("old")) == "before");
    CHECK(folder.names() == std::vector<std::string>{"old"});
}
