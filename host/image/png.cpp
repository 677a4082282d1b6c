#include "host/image/png.hpp"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <vector>

#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"

namespace stokes {
namespace {

// libpng reports errors by longjmp: what must be destroyed lives here, outside the frames it skips.
struct Encoding {
    std::string bytes;
    std::string error;
};

void append(png_structp png, png_bytep data, std::size_t count) {
    auto* encoding = static_cast<Encoding*>(png_get_io_ptr(png));
    bool failed = false;
    try {
        encoding->bytes.append(reinterpret_cast<const char*>(data), count);
    } catch (const std::exception&) {
        failed = true;
    }
    if (failed) png_error(png, "out of memory");
}

void flush_nothing(png_structp) {}

void on_error(png_structp png, png_const_charp message) {
    static_cast<Encoding*>(png_get_error_ptr(png))->error = message;
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

// False, with encoding.error set, when libpng gives up.
bool encode(const Rgb8& image, const std::vector<png_text>& text, Encoding& encoding) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &encoding, on_error, on_warning);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    if (info == nullptr) {
        png_destroy_write_struct(&png, nullptr);
        encoding.error = "out of memory";
        return false;
    }
    if (setjmp(png_jmpbuf(png)) != 0) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_write_fn(png, &encoding, append, flush_nothing);
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_text(png, info, text.data(), static_cast<int>(text.size()));
    png_write_info(png, info);
    for (int y = 0; y < image.height; ++y)
        png_write_row(png, image.rgb.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) * 3);
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return true;
}

}  // namespace

void write_png(const std::string& path, const Rgb8& image, const std::map<std::string, std::string>& text) {
    if (image.rgb.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3)
        throw RunError(fmt::format("{}: cannot write: {} x {} pixels with {} values", path, image.width, image.height,
                                   image.rgb.size()));
    std::vector<png_text> chunks;
    for (const auto& [key, value] : text) {
        png_text chunk{};
        chunk.compression = PNG_TEXT_COMPRESSION_NONE;
        chunk.key = const_cast<char*>(key.c_str());  // png_set_text copies and does not write
        chunk.text = const_cast<char*>(value.c_str());
        chunk.text_length = value.size();
        chunks.push_back(chunk);
    }
    Encoding encoding;
    if (!encode(image, chunks, encoding)) throw RunError(fmt::format("{}: cannot write: {}", path, encoding.error));
    write_file_atomically(path, encoding.bytes);
}

}  // namespace stokes
