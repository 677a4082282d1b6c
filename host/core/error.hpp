// Errors as the command line reports them. main.cpp is the only place that turns them into exit codes.
#pragma once

#include <stdexcept>
#include <string>

namespace stokes {

// Bad input: a scene, table, mesh, image or command line that cannot be used. Exit code 2.
// The text is one line: file, line, key, what was expected.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Something failed while running: a device, a driver, a disk. Exit code 1.
struct RunError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The person at the terminal wants no more. Exit code 128 + the signal.
struct Interrupted : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace stokes
