// What a function says when its input is bad.
#pragma once

#include <string>

#include "host/core/error.hpp"

namespace stokes {

// The text of the InputError that the call throws; "" when it throws none. A text of several lines, which no
// InputError may have, is marked.
template <typename Call>
std::string input_error(Call&& call) {
    try {
        call();
    } catch (const InputError& error) {
        const std::string text = error.what();
        return text.find('\n') == std::string::npos ? text : "SEVERAL LINES: " + text;
    }
    return "";
}

}  // namespace stokes
