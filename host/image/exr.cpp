#include "host/image/exr.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <array>

#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/image/exr_errors.hpp"
#include "host/image/memory_stream.hpp"

namespace stokes {
namespace {

constexpr std::array<const char*, 3> channel_names = {"R", "G", "B"};

std::string channel_name(const std::string& layer, const char* channel) {
    return layer.empty() ? channel : layer + "." + channel;
}

Imf::Slice slice(std::vector<float>& rgb, int width, std::size_t channel) {
    const std::size_t pixel = 3 * sizeof(float);
    return {Imf::FLOAT, reinterpret_cast<char*>(rgb.data() + channel), pixel, pixel * static_cast<std::size_t>(width)};
}

void add_metadata(Imf::Header& header, const Metadata& metadata) {
    for (const auto& [name, value] : metadata) {
        if (const auto* text = std::get_if<std::string>(&value)) header.insert(name, Imf::StringAttribute(*text));
        if (const auto* whole = std::get_if<int>(&value)) header.insert(name, Imf::IntAttribute(*whole));
        if (const auto* real = std::get_if<double>(&value)) header.insert(name, Imf::DoubleAttribute(*real));
    }
}

std::string encode(const std::string& path, const FilmImage& film, const Metadata& metadata) {
    Imf::Header header(film.width, film.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::addChromaticities(header, Imf::Chromaticities());  // the defaults are Rec. 709 and D65
    Imf::addWhiteLuminance(header, 1.0f);
    add_metadata(header, metadata);

    RgbLayers layers = film_layers(film);
    Imf::FrameBuffer frame;
    for (auto& [layer, rgb] : layers) {
        for (std::size_t c = 0; c < 3; ++c) {
            const std::string name = channel_name(layer, channel_names[c]);
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            frame.insert(name, slice(rgb, film.width, c));
        }
    }
    MemoryWriter stream(path.c_str());
    {
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writePixels(film.height);
    }  // the end of the file object completes its table of scan lines
    return std::move(stream.bytes);
}

}  // namespace

void write_exr(const std::string& path, const FilmImage& film, const Metadata& metadata) {
    std::string bytes;
    try {
        bytes = encode(path, film, metadata);
    } catch (const RunError&) {
        throw;
    } catch (const std::exception& error) {
        throw RunError(fmt::format("{}: cannot write: {}", path, exr_reason(error)));
    }
    write_file_atomically(path, bytes);
}

}  // namespace stokes
