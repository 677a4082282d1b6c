// The values of a PLY file's body, one after another.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <string>
#include <string_view>

#include "host/core/text_input.hpp"
#include "host/scene/readers/ply_header.hpp"

namespace stokes {

// What a file may end in, also a binary one from an editor.
inline constexpr std::string_view blanks(" \t\r\n\v\f\0\x1a", 8);

// Values of an ascii body, one token each.
class AsciiSource {
  public:
    explicit AsciiSource(const TextScanner& body) : scanner_(body) {}

    std::size_t bytes_left() const { return scanner_.rest().size(); }
    bool has_more() const { return scanner_.rest().find_first_not_of(blanks) != std::string_view::npos; }
    std::string place(const std::string& file, const std::string& record) const {
        return fmt::format("{}:{}: {}", file, scanner_.line(), record);
    }
    // False: no such value here.
    bool take(PlyType type, double& value) {
        token_ = scanner_.token_across_lines();
        if (type == PlyType::float32 || type == PlyType::float64) {
            const auto number = parse_double(token_);
            value = number.value_or(0.0);
            return number.has_value();
        }
        const auto number = parse_integer(token_);
        value = static_cast<double>(number.value_or(0));
        return number.has_value();
    }
    std::string got() const { return token_.empty() ? "the end of the file" : '"' + printable(token_) + '"'; }

  private:
    TextScanner scanner_;
    std::string_view token_;
};

// Values of a binary body. A double holds each of the types exactly.
class BinarySource {
  public:
    BinarySource(const TextScanner& body, bool big_endian) : rest_(body.rest()), big_endian_(big_endian) {}

    std::size_t bytes_left() const { return rest_.size(); }
    bool has_more() const { return rest_.find_first_not_of(blanks) != std::string_view::npos; }
    std::string place(const std::string& file, const std::string& record) const { return file + ": " + record; }
    bool take(PlyType type, double& value) {
        switch (type) {
            case PlyType::int8:
                return take_as<std::int8_t>(value);
            case PlyType::uint8:
                return take_as<std::uint8_t>(value);
            case PlyType::int16:
                return take_as<std::int16_t>(value);
            case PlyType::uint16:
                return take_as<std::uint16_t>(value);
            case PlyType::int32:
                return take_as<std::int32_t>(value);
            case PlyType::uint32:
                return take_as<std::uint32_t>(value);
            case PlyType::float32:
                return take_as<float>(value);
            case PlyType::float64:
                break;
        }
        return take_as<double>(value);
    }
    std::string got() const { return "the end of the file"; }

  private:
    template <typename T>
    bool take_as(double& value) {
        if (rest_.size() < sizeof(T)) return false;
        char bytes[sizeof(T)];
        std::memcpy(bytes, rest_.data(), sizeof bytes);
        if (big_endian_) std::reverse(std::begin(bytes), std::end(bytes));
        T typed;
        std::memcpy(&typed, bytes, sizeof bytes);
        rest_.remove_prefix(sizeof bytes);
        value = static_cast<double>(typed);
        return true;
    }

    std::string_view rest_;
    bool big_endian_;
};

}  // namespace stokes
