// Text for JSON files.
#pragma once

#include <string>
#include <string_view>

namespace stokes {

// text as a JSON string with its quotation marks; bytes that are not UTF-8 become U+FFFD, so that the file is
// valid whatever a path or a driver's name holds.
std::string json_quoted(std::string_view text);

}  // namespace stokes
