// Pictures that scenes name, for masks and textures.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stokes {

inline constexpr int largest_picture = 8192;  // pixels, in width and in height

struct Picture {
    int width = 0;                 // pixels
    int height = 0;                // pixels
    std::vector<float> luminance;  // linear, in [0, 1], of each pixel's own colour; rows from the top down
    std::vector<float> opacity;    // in [0, 1]; empty: all 1

    // Over a background of this luminance.
    float luminance_over(float background, std::size_t pixel) const {
        if (opacity.empty()) return luminance[pixel];
        return luminance[pixel] * opacity[pixel] + background * (1.0f - opacity[pixel]);
    }
};

// A PNG of any colour type, bit depth and interlacing. Samples are taken as sRGB (IEC 61966-2-1), whatever
// colour space the file states; luminance is 0.2126 R + 0.7152 G + 0.0722 B of the linear values. file: for
// messages. Throws InputError "FILE: REASON": not a PNG, damaged or cut off, wider or higher than
// largest_picture.
Picture parse_png(std::string_view bytes, const std::string& file);

// Throws InputError also when the file cannot be read, std::bad_alloc when it does not fit into memory.
Picture read_picture(const std::string& path);

}  // namespace stokes
