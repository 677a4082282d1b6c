// The program as a person runs it.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace stokes {

struct Outcome {
    int code;  // exit code, or 128 + the signal
    std::string out, err;
};

// environment: assignments such as "HOME=/nowhere", before the program's name.
inline Outcome run_stokes(const std::string& arguments, const std::string& environment = "") {
    const TemporaryFolder folder;
    const std::string command = environment + " " + stokes_program() + " " + arguments + " > " + folder.file("out") +
                                " 2> " + folder.file("err") + " < /dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), file_content(folder.file("out")),
            file_content(folder.file("err"))};
}

inline const std::string sphere_scene = source_path("scenes/sphere.json");
inline const std::string small_render = " --passes 2 --photons 4000 --size 24x16 ";

}  // namespace stokes
