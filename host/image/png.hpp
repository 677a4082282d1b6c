// PNG files.
#pragma once

#include <map>
#include <string>

#include "host/image/develop.hpp"

namespace stokes {

// Writes 8-bit RGB, marked as sRGB, with text as tEXt chunks (keyword of 1 to 79 Latin-1 characters -> text).
// Atomic, as write_file_atomically. Throws RunError with path and reason.
void write_png(const std::string& path, const Rgb8& image, const std::map<std::string, std::string>& text = {});

}  // namespace stokes
