#include "host/core/text_encoding.hpp"

#include <cstddef>
#include <cstdint>

#include "host/core/error.hpp"

namespace stokes {

namespace {

void append_utf8(std::string& text, std::uint32_t code) {
    const auto put = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
    if (code < 0x80) {
        put(code);
    } else if (code < 0x800) {
        put(0xc0 | code >> 6);
        put(0x80 | (code & 0x3f));
    } else if (code < 0x10000) {
        put(0xe0 | code >> 12);
        put(0x80 | (code >> 6 & 0x3f));
        put(0x80 | (code & 0x3f));
    } else {
        put(0xf0 | code >> 18);
        put(0x80 | (code >> 12 & 0x3f));
        put(0x80 | (code >> 6 & 0x3f));
        put(0x80 | (code & 0x3f));
    }
}

std::string from_utf16(const std::string& bytes, bool low_byte_first) {
    const auto unit = [&](std::size_t i) {
        const auto a = static_cast<unsigned char>(bytes[i]), b = static_cast<unsigned char>(bytes[i + 1]);
        return static_cast<std::uint32_t>(low_byte_first ? a | b << 8 : a << 8 | b);
    };
    std::string text;
    for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
        std::uint32_t code = unit(i);
        if (code >= 0xd800 && code < 0xdc00 && i + 3 < bytes.size()) {
            i += 2;
            code = 0x10000 + ((code - 0xd800) << 10) + (unit(i) - 0xdc00);
        }
        append_utf8(text, code);
    }
    return text;
}

bool is_utf8(const std::string& bytes) {
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const auto lead = static_cast<unsigned char>(bytes[i]);
        if (lead < 0x80) continue;
        const int more = lead >= 0xc2 && lead < 0xe0   ? 1
                         : lead >= 0xe0 && lead < 0xf0 ? 2
                         : lead >= 0xf0 && lead < 0xf5 ? 3
                                                       : 0;
        if (more == 0) return false;
        for (int k = 0; k < more; ++k)
            if (++i >= bytes.size() || (static_cast<unsigned char>(bytes[i]) & 0xc0) != 0x80) return false;
    }
    return true;
}

std::string from_latin1(const std::string& bytes) {
    std::string text;
    for (const char c : bytes) append_utf8(text, static_cast<unsigned char>(c));
    return text;
}

std::string with_line_feeds(const std::string& text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\r')
            result += text[i];
        else if (i + 1 == text.size() || text[i + 1] != '\n')
            result += '\n';
    }
    return result;
}

}  // namespace

std::string plain_text(const std::string& bytes, const std::string& file) {
    const auto starts_with = [&](const char* mark, std::size_t size) {
        return bytes.compare(0, size, mark, size) == 0;
    };
    std::string text;
    if (starts_with("\xff\xfe", 2) || starts_with("\xfe\xff", 2))
        text = from_utf16(bytes, starts_with("\xff\xfe", 2));
    else if (starts_with("\xef\xbb\xbf", 3))
        text = bytes.substr(3);
    else
        text = bytes;
    if (text.find('\0') != std::string::npos)
        throw InputError(file + ": expected text, got a byte 0: a binary file, or UTF-16 without a byte order mark");
    return with_line_feeds(is_utf8(text) ? text : from_latin1(text));
}

}  // namespace stokes
