// What the OpenEXR library says of an error.
#pragma once

#include <exception>
#include <string>

namespace stokes {

// The one line that says why: OpenEXR puts a sentence with the file's name before it.
inline std::string exr_reason(const std::exception& error) {
    const std::string text = error.what();
    const std::size_t sentence = text.find("\". ");
    const std::size_t start = sentence == std::string::npos ? 0 : sentence + 3;
    return text.substr(start, text.find('\n', start) - start);
}

}  // namespace stokes
