#include "host/core/text_input.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <new>
#include <set>
#include <system_error>
#include <vector>

#include "host/core/error.hpp"

namespace stokes {
namespace {

std::mutex read_mutex;
std::set<std::string> read_so_far;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

// std::from_chars takes no leading plus sign, which files do contain.
std::string_view without_plus(std::string_view token) {
    if (token.size() > 1 && token[0] == '+' && token[1] != '-' && token[1] != '+') token.remove_prefix(1);
    return token;
}

template <typename T>
std::optional<T> parse_whole(std::string_view token) {
    token = without_plus(token);
    T value{};
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (error != std::errc() || end != token.data() + token.size()) return std::nullopt;
    return value;
}

// Bytes of the UTF-8 character at the start of a text that is not empty; 0 where there is none or a control character.
std::size_t character_size(std::string_view text) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    const unsigned first = byte(0);
    if (first < 0x80) return first < 32 || first == 127 ? 0 : 1;
    const std::size_t size = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
    for (std::size_t i = 1; i < size; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    const bool too_long = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
    const bool no_character = (first == 0xed && byte(1) >= 0xa0) || (first == 0xf4 && byte(1) >= 0x90);
    const bool control = first == 0xc2 && byte(1) < 0xa0;
    return too_long || no_character || control ? 0 : size;
}

std::string room_for(std::uintmax_t size, const std::string& path) {
    std::string text;
    try {
        if (size > text.max_size()) throw std::bad_alloc();
        text.resize(static_cast<std::size_t>(size));
    } catch (const std::bad_alloc&) {
        throw InputError(path + ": cannot read: too large for the memory, " + std::to_string(size >> 20) + " MiB");
    }
    return text;
}

}  // namespace

std::string read_file(const std::string& path) {
    {
        const std::lock_guard<std::mutex> lock(read_mutex);
        read_so_far.insert(path);
    }
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    if (error || !std::filesystem::is_regular_file(path)) {
        throw InputError(path + ": cannot read: " + (error ? error.message() : "not a regular file"));
    }
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file) throw InputError(path + ": cannot read: " + std::strerror(errno));
    std::string text = room_for(size, path);
    const std::size_t got = std::fread(text.data(), 1, text.size(), file.get());
    if (std::ferror(file.get())) throw InputError(path + ": cannot read: " + std::strerror(errno));
    text.resize(got);
    return text;
}

std::set<std::string> files_read() {
    const std::lock_guard<std::mutex> lock(read_mutex);
    return read_so_far;
}

std::optional<double> parse_double(std::string_view token) { return parse_whole<double>(token); }

std::optional<std::int64_t> parse_integer(std::string_view token) { return parse_whole<std::int64_t>(token); }

std::string printable(std::string_view text) {
    constexpr int longest = 40;
    std::string result;
    for (int characters = 0; !text.empty(); ++characters) {
        if (characters == longest) return result + "...";
        const std::size_t size = character_size(text);
        result += size == 0 ? "?" : text.substr(0, size);
        text.remove_prefix(std::max<std::size_t>(size, 1));
    }
    return result;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
    constexpr std::size_t longest = 64;
    a = a.substr(0, longest);
    b = b.substr(0, longest);
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const bool same =
                std::tolower(static_cast<unsigned char>(a[i])) == std::tolower(static_cast<unsigned char>(b[j]));
            const std::size_t replaced = diagonal + (same ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row[b.size()];
}

std::string_view TextScanner::token() {
    std::size_t begin = 0;
    while (begin < rest_.size() && is_blank(rest_[begin])) ++begin;
    std::size_t end = begin;
    while (end < rest_.size() && !is_blank(rest_[end]) && rest_[end] != '\n') ++end;
    const std::string_view found = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return found;
}

std::string_view TextScanner::token_across_lines() {
    std::string_view found = token();
    while (found.empty() && !rest_.empty()) {
        rest_.remove_prefix(1);
        ++line_;
        found = token();
    }
    return found;
}

std::string_view TextScanner::take_line() {
    const std::size_t end = rest_.find('\n');
    std::string_view found = rest_.substr(0, end);
    if (end == std::string_view::npos) {
        rest_ = {};
    } else {
        rest_.remove_prefix(end + 1);
        ++line_;
    }
    if (!found.empty() && found.back() == '\r') found.remove_suffix(1);
    return found;
}

}  // namespace stokes
