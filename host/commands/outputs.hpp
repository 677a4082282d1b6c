// The files a command leaves behind.
#pragma once

#include <exception>
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

// InputError when a file of outputs is one that the program has read.
void check_keeps_inputs(const std::vector<std::string>& outputs);

struct OutputName {
    std::string flag, file, ending;  // "-o", "a.exr", ".exr"; an empty file stands for no output
};

// InputError when the name of a file ends as those of another format do, or is "-", which would become a file of that
// name; a warning for an ending that no format has. Letter case does not count, and a name without an ending is fine.
void check_endings(const std::vector<OutputName>& outputs);

// Steps of which one that fails does not keep the next from being taken.
class Attempts {
  public:
    // Whether the step went well. What it throws is kept, when it is the first, or reported on standard error.
    bool take(const std::function<void()>& step);
    // Throws the first error.
    void finish() const;

  private:
    std::exception_ptr first_;
};

struct Output {
    std::string file;  // empty: none
    std::function<void()> write;
};

// Writes every output there is and then, unless quiet, prints the names of those. One that fails does not keep the
// others from being written: the first error is thrown when all have had their turn, more are reported on standard
// error. What cannot be printed is no error.
void write_outputs(const std::vector<Output>& outputs, bool quiet);

}  // namespace stokes
