// The files a command leaves behind.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace stokes {

// What the render would find out only at its end: InputError when a file of outputs cannot be written (no
// folder, no permission, no regular file), when two are the same file, or when one is the scene. Names that
// are empty stand for no output, and for no scene.
void check_outputs(const std::vector<std::string>& outputs, const std::string& scene);

// InputError when a file of outputs is the input, which `what` names ("the scene"). Empty names as above.
void check_keeps(const std::vector<std::string>& outputs, const std::string& input, const std::string& what);

struct Output {
    std::string file;  // empty: none
    std::function<void()> write;
};

// Writes every output there is and, unless quiet, prints its name. One that fails does not keep the others
// from being written: the first error is thrown when all have had their turn, more are reported on standard
// error.
void write_outputs(const std::vector<Output>& outputs, bool quiet);

}  // namespace stokes
