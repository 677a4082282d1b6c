// Text compressed by gzip, in memory.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace stokes {

// The same text gives the same bytes: neither name nor time is stored.
std::string compress_gzip(std::string_view text);

// Throws InputError "NAME: ..." when the content is not one whole gzip member, or holds more than limit
// bytes.
std::string decompress_gzip(std::string_view content, const std::string& name, std::size_t limit);

}  // namespace stokes
