// OpenEXR files as other programs write them: their primaries, windows, channels and kinds.
#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <cmath>
#include <limits>

#include "host/core/error.hpp"
#include "host/image/colour.hpp"
#include "host/image/exr.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run_stokes.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

constexpr int width = 5, height = 3;

// ITU-R BT.2020-2, table 3, and the CIE XYZ as primaries of their own.
const Imf::Chromaticities rec2020({0.708f, 0.292f}, {0.170f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.3290f});
const Imf::Chromaticities tristimulus({1.0f, 0.0f}, {0.0f, 1.0f}, {0.0f, 0.0f}, {1.0f / 3.0f, 1.0f / 3.0f});

// By ITU-R BT.2087-0, table 1: linear Rec. 2020 of linear Rec. 709.
glm::dvec3 rec2020_of_rec709(const glm::dvec3& c) {
    return {0.6274 * c.r + 0.3293 * c.g + 0.0433 * c.b, 0.0691 * c.r + 0.9195 * c.g + 0.0114 * c.b,
            0.0164 * c.r + 0.0880 * c.g + 0.8956 * c.b};
}

// Rec. 709, another colour at each pixel.
glm::dvec3 colour(int x, int y) { return {1.0 + x, 10.0 - x + y, 2.0 + 3.0 * y}; }

struct Written {
    Imf::Header header{width, height};
    std::vector<std::string> names = {"R", "G", "B"};
    Imf::PixelType type = Imf::FLOAT;
    glm::dvec3 (*value)(int x, int y) = colour;
    int sampling = 1;  // of the last channel

    // Returns the pixels, which must live until the file has them.
    template <class T, class File>
    std::vector<std::vector<T>> give(File& file) const {
        std::vector<std::vector<T>> planes;
        Imf::FrameBuffer frame;
        for (std::size_t c = 0; c < names.size(); ++c) {
            std::vector<T>& plane = planes.emplace_back();
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    plane.push_back(static_cast<T>(static_cast<float>(value(x, y)[static_cast<int>(c % 3)])));
        }
        const Imath::V2i corner = header.dataWindow().min;
        for (std::size_t c = 0; c < names.size(); ++c) {
            const int step = c + 1 == names.size() ? sampling : 1;
            char* base = reinterpret_cast<char*>(planes[c].data() - corner.x - corner.y * width);
            frame.insert(names[c], Imf::Slice(type, base, sizeof(T), sizeof(T) * width, step, step));
        }
        file.setFrameBuffer(frame);
        return planes;
    }

    template <class T>
    void write_lines(const std::string& path) const {
        Imf::OutputFile file(path.c_str(), header);
        const auto planes = give<T>(file);
        file.writePixels(header.dataWindow().max.y - header.dataWindow().min.y + 1);
    }

    void write(const std::string& path) {
        for (const std::string& name : names) {
            const int step = name == names.back() ? sampling : 1;
            header.channels().insert(name, Imf::Channel(type, step, step));
        }
        if (header.hasTileDescription()) {
            Imf::TiledOutputFile file(path.c_str(), header);
            const auto planes = give<float>(file);
            file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
            return;
        }
        if (type == Imf::HALF) write_lines<half>(path);
        if (type == Imf::FLOAT) write_lines<float>(path);
        if (type == Imf::UINT) write_lines<unsigned int>(path);
    }
};

// Every pixel of the layer is the colour of its place, to this share of the largest value.
void check_colours(const std::vector<float>& rgb, double tolerance) {
    REQUIRE(rgb.size() == std::size_t{width * height * 3});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) {
                CAPTURE(x, y, c);
                const double found = rgb[static_cast<std::size_t>(3 * (y * width + x) + c)];
                CHECK(std::abs(found - colour(x, y)[c]) <= tolerance * 14.0);
            }
}

}  // namespace

// The coefficients of BT.2087 have four digits.
TEST_CASE("pixels are read by the primaries that their file names", "[exr_reader]") {
    const TemporaryFolder folder;
    Written wide;
    wide.value = [](int x, int y) { return rec2020_of_rec709(colour(x, y)); };
    Imf::addChromaticities(wide.header, rec2020);
    wide.write(folder.file("wide.exr"));
    check_colours(read_exr(folder.file("wide.exr")).layers.at(""), 1e-4);

    Written xyz;
    xyz.value = [](int x, int y) { return xyz_of_rec709(colour(x, y)); };
    Imf::addChromaticities(xyz.header, tristimulus);
    xyz.write(folder.file("xyz.exr"));
    check_colours(read_exr(folder.file("xyz.exr")).layers.at(""), 1e-6);

    Written named = xyz;
    named.header = Imf::Header(width, height);
    named.names = {"X", "Y", "Z"};
    named.write(folder.file("named.exr"));
    check_colours(read_exr(folder.file("named.exr")).layers.at(""), 1e-6);
}

TEST_CASE("primaries that mix no white are refused", "[exr_reader]") {
    const TemporaryFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Imf::Chromaticities& bad :
         {Imf::Chromaticities({0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}),
          Imf::Chromaticities({0.6f, 0.3f}, {0.4f, 0.3f}, {0.2f, 0.3f}, {0.3f, 0.3f}),
          Imf::Chromaticities({0.64f, 0.33f}, {0.3f, 0.6f}, {0.15f, 0.06f}, {0.3f, 0.0f}),
          Imf::Chromaticities({nan, 0.33f}, {0.3f, 0.6f}, {0.15f, 0.06f}, {0.3127f, 0.329f})}) {
        Written picture;
        Imf::addChromaticities(picture.header, bad);
        picture.write(folder.file("a.exr"));
        CHECK_THROWS_WITH(read_exr(folder.file("a.exr")), Contains("a.exr: chromaticities: expected three primaries"));
    }
}

TEST_CASE("half, float and integer channels, scan lines and tiles are read alike", "[exr_reader]") {
    const TemporaryFolder folder;
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT}) {
        Written picture;
        picture.type = type;
        picture.write(folder.file("a.exr"));
        check_colours(read_exr(folder.file("a.exr")).layers.at(""), 0.0);  // small whole numbers
    }
    Written tiles;
    tiles.header.setTileDescription(Imf::TileDescription(2, 2));
    tiles.write(folder.file("a.exr"));
    check_colours(read_exr(folder.file("a.exr")).layers.at(""), 0.0);
}

TEST_CASE("a picture of luminance alone is grey, and layers keep their names", "[exr_reader]") {
    const TemporaryFolder folder;
    Written grey;
    grey.names = {"Y"};
    grey.value = [](int x, int y) { return glm::dvec3(colour(x, y).g); };
    grey.write(folder.file("grey.exr"));
    const std::vector<float> rgb = read_exr(folder.file("grey.exr")).layers.at("");
    for (std::size_t i = 0; i < rgb.size(); i += 3) CHECK((rgb[i] == rgb[i + 1] && rgb[i] == rgb[i + 2]));
    CHECK(static_cast<double>(rgb[3]) == colour(1, 0).g);

    Written layers;
    layers.names = {"R", "G", "B", "left.glow.R", "left.glow.G", "left.glow.B", "N.X", "N.Y", "N.Z", "A"};
    layers.write(folder.file("layers.exr"));
    const RgbLayers found = read_exr(folder.file("layers.exr")).layers;
    REQUIRE(found.size() == 2);
    check_colours(found.at(""), 0.0);
    check_colours(found.at("left.glow"), 0.0);
}

TEST_CASE("channels that make no picture are refused by name", "[exr_reader]") {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.exr");
    const auto refused = [&](std::vector<std::string> names, int sampling, const std::string& why) {
        Written picture;
        picture.names = std::move(names);
        picture.sampling = sampling;
        if (sampling > 1) picture.header = Imf::Header(2 * sampling, sampling);
        picture.write(path);
        CHECK_THROWS_WITH(read_exr(path), Contains("a.exr: ") && Contains(why));
    };
    refused({"Z"}, 1, "expected channels R, G, B, or X, Y, Z, or Y, got Z");
    refused({"r", "g", "b"}, 1, "got b, g, r");
    refused({"R", "G"}, 1, "got no B");
    refused({"R", "G", "B", "spot.R", "spot.G"}, 1, "got no spot.B");
    refused({"R", "G", "B"}, 2, "channel B: expected a value for each pixel, got one for 2 x 2");
    refused({"Y", "RY", "BY"}, 1, "got BY, RY, Y");
}

TEST_CASE("files of several parts and of deep pixels are refused in words", "[exr_reader]") {
    const TemporaryFolder folder;
    {
        std::vector<Imf::Header> headers(2, Imf::Header(width, height));
        for (std::size_t i = 0; i < headers.size(); ++i) {
            headers[i].setName(i == 0 ? "left" : "right");
            headers[i].setType(Imf::SCANLINEIMAGE);
            for (const char* name : {"R", "G", "B"}) headers[i].channels().insert(name, Imf::Channel(Imf::FLOAT));
        }
        Imf::MultiPartOutputFile file(folder.file("parts.exr").c_str(), headers.data(), 2);
        std::vector<float> plane(width * height, 1.0f);
        for (int i = 0; i < 2; ++i) {
            Imf::OutputPart part(file, i);
            Imf::FrameBuffer frame;
            for (const char* name : {"R", "G", "B"})
                frame.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(plane.data()), sizeof(float),
                                              sizeof(float) * width));
            part.setFrameBuffer(frame);
            part.writePixels(height);
        }
    }
    CHECK_THROWS_WITH(read_exr(folder.file("parts.exr")),
                      Contains("parts.exr: expected a file of one part, got 2: left, right"));
    {
        Imf::Header header(width, height);
        header.setType(Imf::DEEPSCANLINE);
        header.compression() = Imf::ZIPS_COMPRESSION;
        header.channels().insert("R", Imf::Channel(Imf::FLOAT));
        Imf::DeepScanLineOutputFile file(folder.file("deep.exr").c_str(), header);
        std::vector<unsigned int> counts(width * height, 0);
        std::vector<float*> pixels(width * height, nullptr);
        Imf::DeepFrameBuffer frame;
        frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned int),
                                                sizeof(unsigned int) * width));
        frame.insert("R", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data()), sizeof(float*),
                                         sizeof(float*) * width, sizeof(float)));
        file.setFrameBuffer(frame);
        file.writePixels(height);
    }
    CHECK_THROWS_WITH(read_exr(folder.file("deep.exr")), Contains("deep.exr: expected one value for each pixel"));
}

TEST_CASE("compare refuses pictures that show other pixels", "[exr_reader]") {
    const TemporaryFolder folder;
    const auto write = [&](const char* name, const Imath::Box2i& display, const Imath::Box2i& data) {
        Written picture;
        picture.header = Imf::Header(display, data);
        picture.write(folder.file(name));
    };
    const Imath::V2i last(width - 1, height - 1), by(4, -7), wide(20, 20);
    write("whole.exr", {{0, 0}, last}, {{0, 0}, last});
    write("moved.exr", {by, by + last}, {by, by + last});  // as a whole: the same picture
    write("shifted.exr", {{0, 0}, wide}, {{4, 4}, Imath::V2i(4, 4) + last});
    write("part.exr", {{0, 0}, wide}, {{0, 0}, last});
    const auto compare = [&](const std::string& a, const std::string& b) {
        return run_stokes("compare " + folder.file(a) + " " + folder.file(b) + " --tolerance 0");
    };
    CHECK(compare("whole.exr", "moved.exr").code == 0);
    CHECK(compare("shifted.exr", "shifted.exr").code == 0);
    for (const char* other : {"shifted.exr", "part.exr"}) {
        const Outcome refused = compare("whole.exr", other);
        CHECK(refused.code == 2);
        CHECK_THAT(refused.err, Contains("expected pictures of the same window") && Contains("of 21 x 21"));
    }
    CHECK(compare("shifted.exr", "part.exr").code == 2);
}

TEST_CASE("a white luminance is said to be left out", "[exr_reader]") {
    const TemporaryFolder folder;
    Written picture;
    Imf::addWhiteLuminance(picture.header, 100.0f);
    picture.write(folder.file("a.exr"));
    const Outcome run = run_stokes("compare " + folder.file("a.exr") + " " + folder.file("a.exr"));
    CHECK(run.code == 0);
    CHECK_THAT(run.err, Contains("a.exr: whiteLuminance, 100 cd/m^2, is not applied"));
}
