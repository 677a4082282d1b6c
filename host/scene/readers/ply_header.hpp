// The header of a PLY file: which elements and properties follow, and in what form.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/core/text_input.hpp"

namespace stokes {

enum class PlyFormat { ascii, little_endian, big_endian };

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

// Bytes of a value in a binary file.
std::size_t ply_type_size(PlyType type);

struct PlyProperty {
    std::string name;
    bool is_list = false;
    PlyType count_type = PlyType::uint8;  // of a list
    PlyType type = PlyType::float32;
};

struct PlyElement {
    std::string name;
    std::int64_t count = 0;
    std::vector<PlyProperty> properties;

    int property(const std::string& name) const;  // its index, or -1
    // Fewest bytes that one record takes in a file of this format.
    std::size_t least_size(PlyFormat format) const;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
};

// Leaves the scanner at the first byte after the header. Throws InputError "FILE:LINE: ...".
PlyHeader read_ply_header(TextScanner& scanner, const std::string& file);

}  // namespace stokes
