// Standard output and standard error. What a program was asked to print is its product, and losing it is an error.
// Everything else is words: a line that cannot be shown never stops the work.
#pragma once

#include <string>
#include <string_view>

namespace stokes {

// To be called before anything is opened. Where standard input, output or error is closed, it is taken by something
// that fails, so that no file that is opened later gets its number and, with it, messages. A broken pipe and a file
// that may not grow become errors of the write in place of signals.
void prepare_standard_streams();

// Words on standard error, at once; what fails is ignored. A progress line that is still open is ended before.
void tell(std::string_view text);

// Words on standard output, as tell().
void note(std::string_view text);

// The product, on standard output. RunError when it cannot be written. A reader who has closed the pipe wants no more:
// that is no error.
void print(std::string_view text);

// How far the work has come, on standard error; left out where nobody reads, so that a pager holds up no work.
void show_progress(std::string_view text);

// The same for a line without an end, which is rewritten; tell() and end_line() end it.
void show_line(std::string_view text);
void end_line();

}  // namespace stokes
