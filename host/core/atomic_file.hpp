// Output files that are either complete or not there.
#pragma once

#include <string>
#include <string_view>

namespace stokes {

// Writes content to PATH.tmp in the same folder, flushes it to the disk and renames it to path, so that path
// never holds half a file and keeps what it held when writing fails. A symbolic link is written through.
// Throws RunError with path and reason, the temporary removed; also when path is there but is no regular
// file.
void write_file_atomically(const std::string& path, std::string_view content);

// Throws RunError, as write_file_atomically(path, ...) would, where PATH.tmp cannot be made; leaves no file.
void check_can_be_written(const std::string& path);

}  // namespace stokes
