#include "host/core/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace stokes {
namespace {

constexpr const char* replacement = "\xEF\xBF\xBD";

std::uint8_t byte(char c) { return static_cast<std::uint8_t>(c); }

// Bytes of the UTF-8 character that text begins with; 0 where it begins with none (RFC 3629: no overlong
// forms, no surrogates, nothing above U+10FFFF).
std::size_t character_length(std::string_view text) {
    const std::uint8_t first = byte(text[0]);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xC2 && first < 0xE0   ? 2
                               : first >= 0xE0 && first < 0xF0 ? 3
                               : first >= 0xF0 && first < 0xF5 ? 4
                                                               : 0;
    if (length == 0 || text.size() < length) return 0;
    const std::uint8_t low = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
    const std::uint8_t high = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
    if (byte(text[1]) < low || byte(text[1]) > high) return 0;
    const bool whole = std::all_of(text.begin() + 2, text.begin() + static_cast<std::ptrdiff_t>(length),
                                   [](char c) { return (byte(c) & 0xC0) == 0x80; });
    return whole ? length : 0;
}

}  // namespace

std::string json_quoted(std::string_view text) {
    std::string result = "\"";
    while (!text.empty()) {
        const std::size_t length = character_length(text);
        if (length == 0)
            result += replacement;
        else if (text[0] == '"' || text[0] == '\\')
            result += {'\\', text[0]};
        else if (byte(text[0]) < 0x20)
            result += fmt::format("\\u{:04x}", byte(text[0]));
        else
            result += text.substr(0, length);
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return result + '"';
}

}  // namespace stokes
