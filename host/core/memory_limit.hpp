// What the system lets this process have of memory.
#pragma once

#include <string>

namespace stokes {

// Whether a limit on this process's memory (ulimit -v or -d) leaves little room above what it has used.
bool memory_is_short();

// "ulimit -v allows 390 MiB" where memory_is_short(), otherwise "".
std::string memory_limit_text();

// Ends the program at once, with "stokes: DOING: out of memory; .." and exit code 1. Nothing is unwound: a driver
// that ran out of memory may never give back its locks. Allocates nothing.
[[noreturn]] void end_for_lack_of_memory(const char* doing);

// Where an allocation fails in a driver's code or threads, or these die of it, ends the program as above. Elsewhere it
// leaves std::bad_alloc to be caught. To be called on the main thread.
void watch_memory();

// Takes the signals of a program that dies again: LLVM, in a driver, has put its own handlers in the way by then.
void renew_memory_watch();

// Where memory is limited, starts the driver in a process of its own, and ends the program as above when that fails: a
// driver that cannot make its threads, for one, aborts. Also where there is less than PoCL ever starts with.
// start: whether it finds a device; it throws when the driver fails.
void check_memory_for_driver(bool (*start)());

}  // namespace stokes
