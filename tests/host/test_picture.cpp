#include <cmath>
#include <random>

#include "host/scene/readers/picture.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/png_bytes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

// IEC 61966-2-1.
double from_srgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

std::string bytes_of(const std::vector<int>& values) { return {values.begin(), values.end()}; }

}  // namespace

TEST_CASE("Luminance is linear: sRGB decoded, then weighted by the primaries' own") {
    const Picture grey = parse_png(png_bytes(4, {bytes_of({0, 10, 128, 255})}), "g.png");
    REQUIRE((grey.width == 4 && grey.height == 1 && grey.opacity.empty()));
    CHECK(grey.luminance[0] == 0.0f);
    CHECK(grey.luminance[1] == Approx(10.0 / 255 / 12.92));
    CHECK(grey.luminance[2] == Approx(from_srgb(128.0 / 255)).epsilon(1e-6));
    CHECK(grey.luminance[3] == 1.0f);

    const Picture colour = parse_png(
        png_bytes(4, {bytes_of({255, 0, 0, 0, 255, 0, 0, 0, 255, 90, 180, 30})}, {PNG_COLOR_TYPE_RGB}), "c.png");
    CHECK(colour.luminance[0] == Approx(0.2126));
    CHECK(colour.luminance[1] == Approx(0.7152));
    CHECK(colour.luminance[2] == Approx(0.0722));
    CHECK(colour.luminance[3] ==
          Approx(0.2126 * from_srgb(90.0 / 255) + 0.7152 * from_srgb(180.0 / 255) + 0.0722 * from_srgb(30.0 / 255)));

    const Picture fine = parse_png(png_bytes(1, {bytes_of({0x80, 0x40})}, {PNG_COLOR_TYPE_GRAY, 16}), "f.png");
    CHECK(fine.luminance[0] == Approx(from_srgb(0x8040 / 65535.0)).epsilon(1e-6));
}

TEST_CASE("Opacity is read from alpha channels and palettes, and shows the background") {
    const Picture grey = parse_png(png_bytes(2, {bytes_of({255, 51, 0, 255})}, {PNG_COLOR_TYPE_GRAY_ALPHA}), "a.png");
    CHECK(grey.opacity[0] == Approx(0.2));
    CHECK(grey.opacity[1] == 1.0f);
    CHECK(grey.luminance_over(0.0f, 0) == Approx(0.2));
    CHECK(grey.luminance_over(0.5f, 0) == Approx(0.6));
    CHECK(grey.luminance_over(1.0f, 1) == 0.0f);

    PngKind kind{PNG_COLOR_TYPE_PALETTE, 1};
    kind.palette = {{0, 0, 0}, {0, 255, 0}};
    kind.palette_alpha = {0, 255};
    const Picture palette = parse_png(png_bytes(2, {bytes_of({0x40})}, kind), "p.png");
    CHECK((palette.opacity[0] == 0.0f && palette.opacity[1] == 1.0f));
    CHECK(palette.luminance[1] == Approx(0.7152));
}

TEST_CASE("Rows come from the top down, of packed and of interlaced files too") {
    const Picture packed =
        parse_png(png_bytes(3, {bytes_of({0xa0}), bytes_of({0x40})}, {PNG_COLOR_TYPE_GRAY, 1}), "1.png");
    CHECK(packed.luminance == std::vector<float>{1, 0, 1, 0, 1, 0});

    std::mt19937 random(5);
    std::vector<std::string> rows(13, std::string(11, ' '));
    for (std::string& row : rows)
        for (char& c : row) c = static_cast<char>(random() & 0xff);
    CHECK(parse_png(png_bytes(11, rows, {PNG_COLOR_TYPE_GRAY, 8, PNG_INTERLACE_ADAM7}), "i.png").luminance ==
          parse_png(png_bytes(11, rows), "n.png").luminance);
}

TEST_CASE("Files that are no sound PNG are refused in one line") {
    CHECK(input_error([] { parse_png("not a picture", "x.png"); }) == "x.png: not a PNG file");
    CHECK(input_error([] { parse_png("", "x.png"); }) == "x.png: not a PNG file");
    CHECK_THAT(input_error([] { read_picture("no/such.png"); }), StartsWith("no/such.png: cannot read"));
    const std::string sound = png_bytes(5, {"abcde", "fghij"});
    for (std::size_t size = 8; size < sound.size(); ++size)
        CHECK_THAT(input_error([&] { parse_png(sound.substr(0, size), "x.png"); }),
                   StartsWith("x.png: not a sound PNG file: "));
    std::string damaged = sound;
    damaged[damaged.size() - 20] ^= 1;
    CHECK_THAT(input_error([&] { parse_png(damaged, "x.png"); }), StartsWith("x.png: not a sound PNG file: "));
}

TEST_CASE("Bytes changed at random are read or refused, never more") {
    const std::string sound = png_bytes(7, {"abcdefgabcdefgabcdefg", "gfedcbagfedcbagfedcba"}, {PNG_COLOR_TYPE_RGB});
    std::mt19937 random(6);
    int refused = 0;
    for (int i = 0; i < 2000; ++i) {
        std::string bytes = sound;
        for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
        refused += input_error([&] { parse_png(bytes, "x.png"); }).empty() ? 0 : 1;
    }
    CHECK(refused > 1000);
}

TEST_CASE("A picture that is too large is refused before it is read") {
    std::string large = png_bytes(1, {"a"});
    large[18] = '\x20', large[19] = '\x01';  // the width: 8193
    CHECK(input_error([&] { parse_png(large, "x.png"); }) ==
          "x.png: expected a picture of at most 8192 x 8192 pixels, got 8193 x 1");
    CHECK_NOTHROW(parse_png(png_bytes(8192, {std::string(1024, 'a')}, {PNG_COLOR_TYPE_GRAY, 1}), "x.png"));
}
