#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <string>
#include <thread>

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

TEST_CASE("files of other programs are left alone, whatever their names") {
    const TemporaryFolder folder;
    put_file(folder.file("out.txt.tmp"), "notes");
    write_file_atomically(folder.file("out.txt"), "x");
    CHECK_NOTHROW(check_can_be_written(folder.file("out.txt")));
    CHECK(file_content(folder.file("out.txt.tmp")) == "notes");
    CHECK(folder.names() == std::vector<std::string>{"out.txt", "out.txt.tmp"});
}

// Each writer's content is of one letter, so that a mixture would be seen.
TEST_CASE("writers of the same file do not get into each other's way") {
    const TemporaryFolder folder;
    const std::string path = folder.file("out.txt");
    std::vector<std::thread> writers;
    for (const char letter : {'a', 'b', 'c', 'd'})
        writers.emplace_back([&path, letter] {
            for (int i = 0; i < 5; ++i) write_file_atomically(path, std::string(200000, letter));
        });
    for (std::thread& writer : writers) writer.join();
    const std::string left = file_content(path);
    CHECK(left == std::string(200000, left.at(0)));
    CHECK(folder.names() == std::vector<std::string>{"out.txt"});
}

TEST_CASE("a new file has the permissions of the umask, a replaced one keeps its own") {
    const TemporaryFolder folder;
    const auto mode_of = [&](const std::string& name) {
        struct stat found {};
        REQUIRE(::stat(folder.file(name).c_str(), &found) == 0);
        return found.st_mode & 07777;
    };
    const mode_t before = ::umask(027);
    write_file_atomically(folder.file("new"), "x");
    put_file(folder.file("old"), "before");
    REQUIRE(::chmod(folder.file("old").c_str(), 0604) == 0);
    write_file_atomically(folder.file("old"), "after");
    ::umask(before);
    CHECK(mode_of("new") == 0640);
    CHECK(mode_of("old") == 0604);
    CHECK(file_content(folder.file("old")) == "after");
}

TEST_CASE("a symbolic link that leads to nothing yet is written through, one without an end is refused") {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.file("deep/down"));
    REQUIRE(::symlink("deep/down", folder.file("short").c_str()) == 0);
    REQUIRE(::symlink("../new", folder.file("deep/down/link").c_str()) == 0);
    write_file_atomically(folder.file("short/link"), "x");  // by way of deep/down, so ".." is deep
    CHECK(file_content(folder.file("deep/new")) == "x");
    CHECK(std::filesystem::is_symlink(folder.file("deep/down/link")));
    write_file_atomically(folder.file("short/../second"), "y");
    CHECK(file_content(folder.file("deep/second")) == "y");
    REQUIRE(::symlink("loop", folder.file("loop").c_str()) == 0);
    CHECK_THROWS_WITH(write_file_atomically(folder.file("loop"), "x"), Catch::Contains(std::strerror(ELOOP)));
}

TEST_CASE("names of any bytes and of the greatest length are written") {
    const TemporaryFolder folder;
    const std::string longest(255, 'x');  // NAME_MAX
    for (const std::string& name : {longest, std::string("\xc3\xa9 \xc3\xbc.exr"), std::string("two\nlines")}) {
        write_file_atomically(folder.file(name), "x");
        CHECK(file_content(folder.file(name)) == "x");
    }
    CHECK(folder.names().size() == 3);
}
