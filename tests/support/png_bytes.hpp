// PNG files of every kind, in memory.
#pragma once

#include <png.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace stokes {

struct PngKind {
    int color_type = PNG_COLOR_TYPE_GRAY;
    int bit_depth = 8;
    int interlace = PNG_INTERLACE_NONE;
    std::vector<png_color> palette = {};
    std::vector<png_byte> palette_alpha = {};
    double gamma = 0.0;  // of its gAMA; 0: none
};

// rows: each row's bytes as PNG packs them, high byte first.
inline std::string png_bytes(int width, const std::vector<std::string>& rows, const PngKind& kind = {}) {
    std::string bytes;
    png_structp png = png_create_write_struct(
        PNG_LIBPNG_VER_STRING, nullptr, [](png_structp, png_const_charp text) { throw std::runtime_error(text); },
        [](png_structp, png_const_charp) {});
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &bytes,
        [](png_structp at, png_bytep data, std::size_t count) {
            static_cast<std::string*>(png_get_io_ptr(at))->append(reinterpret_cast<char*>(data), count);
        },
        [](png_structp) {});
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(rows.size()), kind.bit_depth,
                 kind.color_type, kind.interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!kind.palette.empty()) png_set_PLTE(png, info, kind.palette.data(), static_cast<int>(kind.palette.size()));
    if (!kind.palette_alpha.empty())
        png_set_tRNS(png, info, kind.palette_alpha.data(), static_cast<int>(kind.palette_alpha.size()), nullptr);
    if (kind.gamma > 0.0) png_set_gAMA(png, info, kind.gamma);
    png_write_info(png, info);
    std::vector<png_bytep> pointers;
    for (const std::string& row : rows) pointers.push_back(reinterpret_cast<png_bytep>(const_cast<char*>(row.data())));
    png_write_image(png, pointers.data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

// A grey 8-bit PNG from text: '#' is black, '.' is white.
inline std::string drawn_png(const std::vector<std::string>& drawing) {
    std::vector<std::string> rows = drawing;
    for (std::string& row : rows)
        for (char& c : row) c = c == '#' ? '\0' : '\xff';
    return png_bytes(static_cast<int>(drawing.front().size()), rows);
}

}  // namespace stokes
