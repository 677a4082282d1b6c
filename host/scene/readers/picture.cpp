#include "host/scene/readers/picture.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <new>

#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/srgb.hpp"
#include "host/core/text_input.hpp"

namespace stokes {
namespace {

constexpr std::size_t most_chunk_bytes = std::size_t{8} << 20;

// What gAMA holds in files of sRGB, and how far from it another value may be that means the same.
constexpr double srgb_file_gamma = 1.0 / 2.2, same_gamma = 0.05;

// libpng reports errors by longjmp: what must be destroyed lives here, outside the frames it skips.
struct Decoding {
    std::string_view rest;
    std::string error;
    int width = 0, height = 0, channels = 0, bit_depth = 0;
    std::vector<png_byte> samples;  // rows from the top down; 16-bit samples in the order of PNG, high byte first
    std::vector<png_bytep> rows;
    bool out_of_memory = false;
    double file_gamma = srgb_file_gamma;  // exponent of its samples over light, where it says that and nothing better
};

void take(png_structp png, png_bytep data, std::size_t count) {
    auto* decoding = static_cast<Decoding*>(png_get_io_ptr(png));
    if (count > decoding->rest.size()) png_error(png, "the file ends too early");
    std::memcpy(data, decoding->rest.data(), count);
    decoding->rest.remove_prefix(count);
}

void on_error(png_structp png, png_const_charp message) {
    static_cast<Decoding*>(png_get_error_ptr(png))->error = message;
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

bool make_room(Decoding& decoding, std::size_t row_bytes) {
    try {
        decoding.samples.resize(row_bytes * static_cast<std::size_t>(decoding.height));
        decoding.rows.resize(static_cast<std::size_t>(decoding.height));
    } catch (const std::exception&) {
        decoding.out_of_memory = true;
        return false;
    }
    for (std::size_t y = 0; y < decoding.rows.size(); ++y) decoding.rows[y] = decoding.samples.data() + y * row_bytes;
    return true;
}

// Grey or RGB, with or without alpha, of 8 or 16 bits. False, with decoding.error set, when libpng gives up.
bool decode(Decoding& decoding) {
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &decoding, on_error, on_warning);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    if (info == nullptr) {
        png_destroy_read_struct(&png, nullptr, nullptr);
        decoding.out_of_memory = true;
        return false;
    }
    if (setjmp(png_jmpbuf(png)) != 0) {
        png_destroy_read_struct(&png, &info, nullptr);
        return false;
    }
    png_set_read_fn(png, &decoding, take);
    png_set_user_limits(png, largest_picture, largest_picture);
    png_set_chunk_malloc_max(png, most_chunk_bytes);
    png_read_info(png, info);
    if (png_get_valid(png, info, PNG_INFO_sRGB) == 0 && png_get_valid(png, info, PNG_INFO_iCCP) == 0)
        png_get_gAMA(png, info, &decoding.file_gamma);
    png_set_expand(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    decoding.width = static_cast<int>(png_get_image_width(png, info));
    decoding.height = static_cast<int>(png_get_image_height(png, info));
    decoding.channels = png_get_channels(png, info);
    decoding.bit_depth = png_get_bit_depth(png, info);
    const bool room = make_room(decoding, png_get_rowbytes(png, info));
    if (room) {
        png_read_image(png, decoding.rows.data());
        png_read_end(png, nullptr);
    }
    png_destroy_read_struct(&png, &info, nullptr);
    return room;
}

// Linear values of all samples of this many bits, IEC 61966-2-1.
std::vector<float> srgb_curve(int bit_depth) {
    std::vector<float> linear(std::size_t{1} << bit_depth);
    for (std::size_t i = 0; i < linear.size(); ++i)
        linear[i] = static_cast<float>(srgb_decode(static_cast<double>(i) / static_cast<double>(linear.size() - 1)));
    return linear;
}

// libpng's own words for pictures beyond its limits do not say what they are.
void check_size(std::string_view bytes, const std::string& file) {
    constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);
    if (bytes.substr(0, 8) != signature) throw InputError(file + ": not a PNG file");
    if (bytes.size() < 24 || bytes.substr(12, 4) != "IHDR") return;
    const auto number = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
        return value;
    };
    const std::uint32_t width = number(16), height = number(20);
    if (width <= largest_picture && height <= largest_picture) return;
    throw InputError(fmt::format("{}: expected a picture of at most {} x {} pixels, got {} x {}", file, largest_picture,
                                 largest_picture, width, height));
}

}  // namespace

Picture parse_png(std::string_view bytes, const std::string& file) {
    check_size(bytes, file);
    Decoding decoding;
    decoding.rest = bytes;
    if (!decode(decoding)) {
        if (decoding.out_of_memory) throw std::bad_alloc();
        throw InputError(fmt::format("{}: not a sound PNG file: {}", file, printable(decoding.error)));
    }
    if (std::abs(decoding.file_gamma - srgb_file_gamma) > same_gamma)
        warn(fmt::format("{}: its gamma (gAMA {:g}) is not applied: the picture is taken as sRGB", file,
                         decoding.file_gamma));
    const std::vector<float> linear = srgb_curve(decoding.bit_depth);
    const auto channels = static_cast<std::size_t>(decoding.channels);
    const bool colour = channels >= 3, has_alpha = channels % 2 == 0;
    const bool wide = decoding.bit_depth == 16;
    const png_byte* samples = decoding.samples.data();
    const auto sample = [&](std::size_t i) -> std::size_t {
        return wide ? std::size_t{samples[2 * i]} << 8 | samples[2 * i + 1] : samples[i];
    };
    Picture picture;
    picture.width = decoding.width;
    picture.height = decoding.height;
    const std::size_t pixels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    picture.luminance.resize(pixels);
    if (has_alpha) picture.opacity.resize(pixels);
    for (std::size_t p = 0; p < pixels; ++p) {
        const std::size_t i = p * channels;
        picture.luminance[p] = colour ? std::min(1.0f, 0.2126f * linear[sample(i)] + 0.7152f * linear[sample(i + 1)] +
                                                           0.0722f * linear[sample(i + 2)])
                                      : linear[sample(i)];
        if (has_alpha)
            picture.opacity[p] = static_cast<float>(sample(i + channels - 1)) / static_cast<float>(linear.size() - 1);
    }
    return picture;
}

Picture read_picture(const std::string& path) {
    for (const char* tile : {"<UDIM>", "<udim>", "%(UDIM)", "<UVTILE>", "<uvtile>"})
        if (path.find(tile) != std::string::npos)
            throw InputError(path + ": expected one PNG file, got a name for UDIM tiles, which are not read");
    return parse_png(read_file(path), path);
}

}  // namespace stokes
