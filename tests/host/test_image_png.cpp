#include <png.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "host/core/error.hpp"
#include "host/image/png.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;

namespace {

Rgb8 noise_image(int width, int height) {
    Rgb8 image{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width * height * 3))};
    std::minstd_rand noise;
    for (std::uint8_t& byte : image.rgb) byte = static_cast<std::uint8_t>(noise() >> 8);
    return image;
}

// libpng's own simplified reader, asked for sRGB bytes.
Rgb8 read_png(const std::string& path) {
    png_image reader{};
    reader.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_file(&reader, path.c_str()) != 0);
    reader.format = PNG_FORMAT_RGB;
    Rgb8 image{static_cast<int>(reader.width), static_cast<int>(reader.height), {}};
    image.rgb.resize(PNG_IMAGE_SIZE(reader));
    REQUIRE(png_image_finish_read(&reader, nullptr, image.rgb.data(), 0, nullptr) != 0);
    return image;
}

// Chunk types in the order of the file (PNG specification, section 5.3).
std::vector<std::string> chunk_types(const std::string& file) {
    std::vector<std::string> types;
    for (std::size_t at = 8; at + 8 <= file.size();) {
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i) length = length * 256 + static_cast<unsigned char>(file[at + i]);
        types.push_back(file.substr(at + 4, 4));
        at += length + 12;
    }
    return types;
}

bool contains(const std::vector<std::string>& list, const std::string& item) {
    return std::find(list.begin(), list.end(), item) != list.end();
}

}  // namespace

TEST_CASE("a PNG is read back as it was written") {
    const TemporaryFolder folder;
    const Rgb8 image = noise_image(33, 17);
    write_png(folder.file("a.png"), image, {{"Software", "stokes"}, {"Source", "scenes/prisms.json"}});
    const Rgb8 read = read_png(folder.file("a.png"));
    CHECK(read.width == 33);
    CHECK(read.height == 17);
    CHECK(read.rgb == image.rgb);
    CHECK(folder.names() == std::vector<std::string>{"a.png"});
}

TEST_CASE("a PNG is marked as sRGB and carries its text") {
    const TemporaryFolder folder;
    write_png(folder.file("a.png"), noise_image(5, 5), {{"Software", "stokes"}});
    const std::string file = file_content(folder.file("a.png"));
    const std::vector<std::string> types = chunk_types(file);
    CHECK(types.front() == "IHDR");
    CHECK(types.back() == "IEND");
    CHECK(contains(types, "sRGB"));
    CHECK(contains(types, "gAMA"));
    CHECK(file.find(std::string("Software") + '\0' + "stokes") != std::string::npos);
}

TEST_CASE("a PNG that cannot be written leaves nothing behind") {
    const TemporaryFolder folder;
    CHECK_THROWS_WITH(write_png(folder.file("missing/a.png"), noise_image(5, 5)),
                      Catch::Contains("missing/a.png: cannot write"));
    {
        const FullDisk full(1000);
        CHECK_THROWS_AS(write_png(folder.file("a.png"), noise_image(64, 64)), RunError);
    }
    CHECK_THROWS_WITH(write_png(folder.file("a.png"), Rgb8{}), Catch::Contains("a.png: cannot write: "));
    CHECK_THROWS_WITH(write_png(folder.file("a.png"), Rgb8{2, 2, {0, 0, 0}}), Catch::Contains("2 x 2 pixels"));
    CHECK(folder.names().empty());
}

TEST_CASE("a full disk leaves the previous PNG") {
    const TemporaryFolder folder;
    write_png(folder.file("a.png"), noise_image(5, 5));
    {
        const FullDisk full(1000);
        CHECK_THROWS_AS(write_png(folder.file("a.png"), noise_image(64, 64)), RunError);
    }
    CHECK(read_png(folder.file("a.png")).rgb == noise_image(5, 5).rgb);
}
