#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <cmath>
#include <limits>
#include <string>

#include "host/core/error.hpp"
#include "host/image/exr.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;

namespace {

// Every value differs, so that a swapped axis, channel or layer shows.
FilmImage numbered_film(int width, int height) {
    FilmImage film(width, height);
    for (std::size_t k = 0; k < layer_count; ++k)
        for (std::size_t i = 0; i < film.xyz[k].size(); ++i)
            film.xyz[k][i] = static_cast<float>(std::sin(static_cast<double>(i + 1000 * k)) + 1.5);
    return film;
}

const Metadata sample_metadata = {{"stokes.scene", std::string("scenes/prisms.json")},
                                  {"stokes.passes", 64},
                                  {"stokes.photons", 1.0e12},
                                  {"stokes.alpha", 2.0 / 3.0}};

}  // namespace

TEST_CASE("what is written to an EXR file is read back bit for bit") {
    const TemporaryFolder folder;
    const FilmImage film = numbered_film(37, 21);
    write_exr(folder.file("a.exr"), film, sample_metadata);
    const ExrImage image = read_exr(folder.file("a.exr"));

    CHECK(image.width == 37);
    CHECK(image.height == 21);
    REQUIRE(image.layers.size() == 1 + layer_count);
    CHECK(image.layers.at("") == total_rgb(film));
    for (const LayerRow& row : layer_rows) CHECK(image.layers.at(row.name) == layer_rgb(film, row.layer));
    for (const auto& [name, value] : sample_metadata) CHECK(image.attributes.at(name) == value);
    CHECK(folder.names() == std::vector<std::string>{"a.exr"});
}

TEST_CASE("the layers add up to R, G, B") {
    const TemporaryFolder folder;
    write_exr(folder.file("a.exr"), numbered_film(16, 9), {});
    const ExrImage image = read_exr(folder.file("a.exr"));
    const std::vector<float>& total = image.layers.at("");
    for (std::size_t i = 0; i < total.size(); ++i) {
        double sum = 0.0;
        double magnitude = 0.0;
        for (const LayerRow& row : layer_rows) {
            const double value = image.layers.at(row.name)[i];
            sum += value;
            magnitude += std::abs(value);
        }
        CHECK(std::abs(total[i] - sum) <= magnitude * std::numeric_limits<float>::epsilon());
    }
}

// BT.709 primaries and white, as the attribute's own documentation defines them.
TEST_CASE("the header says Rec. 709, 1 cd/m^2 and ZIP") {
    const TemporaryFolder folder;
    write_exr(folder.file("a.exr"), numbered_film(4, 3), {});
    const Imf::InputFile file(folder.file("a.exr").c_str());
    REQUIRE(Imf::hasChromaticities(file.header()));
    const Imf::Chromaticities found = Imf::chromaticities(file.header());
    CHECK(found.red == Imath::V2f(0.64f, 0.33f));
    CHECK(found.green == Imath::V2f(0.30f, 0.60f));
    CHECK(found.blue == Imath::V2f(0.15f, 0.06f));
    CHECK(found.white == Imath::V2f(0.3127f, 0.3290f));
    CHECK(Imf::whiteLuminance(file.header()) == 1.0f);
    CHECK(file.header().compression() == Imf::ZIP_COMPRESSION);
    int channels = 0;
    for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it) {
        CHECK(it.channel().type == Imf::FLOAT);
        ++channels;
    }
    CHECK(channels == 15);
}

TEST_CASE("an EXR that cannot be written leaves nothing behind") {
    const TemporaryFolder folder;
    const FilmImage film = numbered_film(64, 64);
    CHECK_THROWS_WITH(write_exr(folder.file("missing/a.exr"), film, {}), Catch::Contains("missing/a.exr"));
    {
        const FullDisk full(1000);
        CHECK_THROWS_AS(write_exr(folder.file("a.exr"), film, {}), RunError);
    }
    CHECK_THROWS_AS(write_exr(folder.file("a.exr"), FilmImage(), {}), RunError);
    FilmImage incomplete(4, 4);
    incomplete.xyz[2].pop_back();
    CHECK_THROWS_WITH(write_exr(folder.file("a.exr"), incomplete, {}), Catch::Contains("multiple"));
    CHECK(folder.names().empty());
}

TEST_CASE("a truncated EXR is an input error wherever it ends") {
    const TemporaryFolder folder;
    write_exr(folder.file("whole.exr"), numbered_film(40, 40), sample_metadata);
    const std::string whole = file_content(folder.file("whole.exr"));
    const std::string path = folder.file("part.exr");
    for (std::size_t size = 0; size < whole.size(); size += size < 1500 ? 7 : 997) {
        put_file(path, whole.substr(0, size));
        CAPTURE(size);
        CHECK_THROWS_AS(read_exr(path), InputError);
    }
    put_file(path, whole.substr(0, whole.size() - 1));
    CHECK_THROWS_WITH(read_exr(path), Catch::Contains("part.exr: not a readable OpenEXR file: unexpected end of file"));
}

TEST_CASE("a corrupt EXR is read or refused, never anything else") {
    const TemporaryFolder folder;
    write_exr(folder.file("whole.exr"), numbered_film(20, 20), sample_metadata);
    const std::string whole = file_content(folder.file("whole.exr"));
    int refused = 0;
    for (std::size_t at = 0; at < whole.size(); at += 13) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
        put_file(folder.file("damaged.exr"), damaged);
        ExrImage image;
        try {
            image = read_exr(folder.file("damaged.exr"));
        } catch (const InputError&) {
            ++refused;
        }
        const auto values = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3;
        for (const auto& [name, rgb] : image.layers) CHECK(rgb.size() == values);
    }
    CHECK(refused > 20);
}

TEST_CASE("what is no EXR file is an input error that says so") {
    const TemporaryFolder folder;
    put_file(folder.file("text.exr"), "not a picture");
    CHECK_THROWS_WITH(read_exr(folder.file("none.exr")), Catch::Contains("none.exr: cannot read: No such file"));
    CHECK_THROWS_WITH(read_exr(folder.path()), Catch::Contains("cannot read: Is a directory"));
    CHECK_THROWS_AS(read_exr(folder.file("text.exr")), InputError);
}
