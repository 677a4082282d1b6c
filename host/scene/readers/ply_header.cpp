#include "host/scene/readers/ply_header.hpp"

#include <fmt/format.h>

#include <map>

#include "host/core/error.hpp"

namespace stokes {
namespace {

class HeaderParser {
  public:
    HeaderParser(TextScanner& scanner, const std::string& file) : scanner_(scanner), file_(file) {}

    PlyHeader parse() {
        if (TextScanner first(scanner_.take_line()); first.token() != "ply" || !first.token().empty())
            fail(1, "expected \"ply\", the first line of a PLY file");
        while (!scanner_.at_end()) {
            const std::int64_t line = scanner_.line();
            TextScanner words(scanner_.take_line());
            const std::string_view keyword = words.token();
            if (keyword == "end_header") return finish(line);
            if (keyword == "comment" || keyword == "obj_info" || keyword.empty()) continue;
            if (keyword == "format") {
                read_format(line, words);
            } else if (keyword == "element") {
                read_element(line, words);
            } else if (keyword == "property") {
                read_property(line, words);
            } else {
                fail(line, fmt::format("unknown header word \"{}\"", printable(keyword)));
            }
        }
        fail(scanner_.line(), "the header has no end_header");
    }

  private:
    [[noreturn]] void fail(std::int64_t line, const std::string& what) const {
        throw InputError(fmt::format("{}:{}: {}", file_, line, what));
    }

    PlyHeader finish(std::int64_t line) {
        if (!has_format_) fail(line, "the header has no format line");
        for (const PlyElement& element : header_.elements) {
            if (element.count > 0 && element.properties.empty()) {
                fail(line, fmt::format("element {} has no properties", printable(element.name)));
            }
        }
        return std::move(header_);
    }

    void read_format(std::int64_t line, TextScanner& words) {
        const std::string_view name = words.token();
        if (name == "ascii") {
            header_.format = PlyFormat::ascii;
        } else if (name == "binary_little_endian") {
            header_.format = PlyFormat::little_endian;
        } else if (name == "binary_big_endian") {
            header_.format = PlyFormat::big_endian;
        } else {
            fail(line, fmt::format("expected format ascii, binary_little_endian or binary_big_endian, got \"{}\"",
                                   printable(name)));
        }
        const std::string_view version = words.token();
        if (version != "1.0") fail(line, fmt::format("expected version 1.0, got \"{}\"", printable(version)));
        has_format_ = true;
    }

    void read_element(std::int64_t line, TextScanner& words) {
        PlyElement element;
        element.name = words.token();
        const std::string_view count = words.token();
        element.count = parse_integer(count).value_or(-1);
        if (element.name.empty() || element.count < 0) {
            fail(line, fmt::format("expected an element's name and count, got \"{}\"", printable(count)));
        }
        header_.elements.push_back(std::move(element));
    }

    void read_property(std::int64_t line, TextScanner& words) {
        if (header_.elements.empty()) fail(line, "a property before any element");
        PlyProperty property;
        std::string_view type = words.token();
        if (type == "list") {
            property.is_list = true;
            property.count_type = read_type(line, words.token());
            if (property.count_type == PlyType::float32 || property.count_type == PlyType::float64) {
                fail(line, "expected an integer type for the length of a list");
            }
            type = words.token();
        }
        property.type = read_type(line, type);
        property.name = words.token();
        if (property.name.empty()) fail(line, "a property without a name");
        header_.elements.back().properties.push_back(std::move(property));
    }

    PlyType read_type(std::int64_t line, std::string_view name) const {
        static const std::map<std::string_view, PlyType> types = {
            {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
            {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
            {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
            {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
            {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
            {"float64", PlyType::float64}};
        const auto found = types.find(name);
        if (found == types.end()) fail(line, fmt::format("unknown property type \"{}\"", printable(name)));
        return found->second;
    }

    TextScanner& scanner_;
    const std::string& file_;
    PlyHeader header_;
    bool has_format_ = false;
};

}  // namespace

std::size_t ply_type_size(PlyType type) {
    switch (type) {
        case PlyType::int8:
        case PlyType::uint8:
            return 1;
        case PlyType::int16:
        case PlyType::uint16:
            return 2;
        case PlyType::int32:
        case PlyType::uint32:
        case PlyType::float32:
            return 4;
        case PlyType::float64:
            break;
    }
    return 8;
}

int PlyElement::property(const std::string& wanted) const {
    for (std::size_t i = 0; i < properties.size(); ++i) {
        if (properties[i].name == wanted) return static_cast<int>(i);
    }
    return -1;
}

std::size_t PlyElement::least_size(PlyFormat format) const {
    if (format == PlyFormat::ascii) return 2 * properties.size() - 1;
    std::size_t size = 0;
    for (const PlyProperty& p : properties) size += ply_type_size(p.is_list ? p.count_type : p.type);
    return size;
}

PlyHeader read_ply_header(TextScanner& scanner, const std::string& file) { return HeaderParser(scanner, file).parse(); }

}  // namespace stokes
