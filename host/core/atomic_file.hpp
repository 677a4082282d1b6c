// Output files that are either complete or not there.
#pragma once

#include <string>
#include <string_view>

namespace stokes {

// Writes content to a new file of a name that nothing else has, in the same folder, flushes it to the disk and renames
// it to path, so that path never holds half a file and keeps what it held when writing fails. A file that was there
// gives its permissions. A symbolic link is written through, also one that leads to nothing yet.
// Throws RunError with path and reason, the new file removed; also when path is there and is no regular file, or one
// that may not be written.
void write_file_atomically(const std::string& path, std::string_view content);

// Throws RunError, as write_file_atomically(path, ...) would, where the new file cannot be made; leaves no file.
void check_can_be_written(const std::string& path);

// Removes the files that are being written, for a program that ends at once. Any thread may call it.
void remove_temporaries();

}  // namespace stokes
