// Text files as other programs write them.
#pragma once

#include <string>

namespace stokes {

// The same text as UTF-8 without a byte order mark, every line end (CR LF, CR alone) a line feed. UTF-16 is known by
// its byte order mark; what is no UTF-8 is taken for Latin-1. InputError "FILE: ..." where it is no text.
std::string plain_text(const std::string& bytes, const std::string& file);

}  // namespace stokes
