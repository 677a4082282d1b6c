#include "host/image/exr.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <array>
#include <cstdint>

#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/core/text_input.hpp"
#include "host/image/memory_stream.hpp"

namespace stokes {
namespace {

constexpr std::array<const char*, 3> channel_names = {"R", "G", "B"};
constexpr std::int64_t most_values = std::int64_t{1} << 31;  // of a file read: 8 GiB of floats

std::string channel_name(const std::string& layer, const char* channel) {
    return layer.empty() ? channel : layer + "." + channel;
}

Imf::Slice slice(std::vector<float>& rgb, int width, std::size_t channel) {
    const std::size_t pixel = 3 * sizeof(float);
    return {Imf::FLOAT, reinterpret_cast<char*>(rgb.data() + channel), pixel, pixel * static_cast<std::size_t>(width)};
}

// The one line that says why: OpenEXR puts a sentence with the file's name before it.
std::string reason_of(const std::exception& error) {
    const std::string text = error.what();
    const std::size_t sentence = text.find("\". ");
    const std::size_t start = sentence == std::string::npos ? 0 : sentence + 3;
    return text.substr(start, text.find('\n', start) - start);
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

Metadata attributes_of(const Imf::Header& header) {
    Metadata attributes;
    for (auto it = header.begin(); it != header.end(); ++it) {
        const Imf::Attribute& attribute = it.attribute();
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute))
            attributes[it.name()] = text->value();
        if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&attribute))
            attributes[it.name()] = whole->value();
        if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&attribute))
            attributes[it.name()] = static_cast<double>(single->value());
        if (const auto* real = dynamic_cast<const Imf::DoubleAttribute*>(&attribute))
            attributes[it.name()] = real->value();
    }
    return attributes;
}

// The layers that have at least one of R, G, B at full resolution, still without pixels.
RgbLayers find_layers(const Imf::Header& header) {
    RgbLayers layers;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        const std::string name = it.name();
        const std::size_t dot = name.rfind('.');
        const std::string last = dot == std::string::npos ? name : name.substr(dot + 1);
        const bool colour = last == "R" || last == "G" || last == "B";
        if (colour && it.channel().xSampling == 1 && it.channel().ySampling == 1)
            layers[dot == std::string::npos ? "" : name.substr(0, dot)];
    }
    return layers;
}

ExrImage decode(const std::string& path, const std::string& bytes) {
    MemoryReader stream(path.c_str(), bytes);
    Imf::InputFile file(stream);
    if (!file.isComplete()) throw Iex::InputExc("scan lines are missing");
    const Imath::Box2i window = file.header().dataWindow();

    ExrImage image;
    image.layers = find_layers(file.header());
    image.attributes = attributes_of(file.header());
    if (image.layers.empty()) throw Iex::InputExc("no channels R, G, B");
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    const auto layers = static_cast<std::int64_t>(image.layers.size());
    if (width > most_values || height > most_values || width * height > most_values / (3 * layers))
        throw Iex::InputExc("picture too large");
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);

    Imf::FrameBuffer frame;
    for (auto& [layer, rgb] : image.layers) {
        rgb.assign(static_cast<std::size_t>(width * height * 3), 0.0f);
        for (std::size_t c = 0; c < 3; ++c) {
            Imf::Slice target = slice(rgb, image.width, c);
            target.base -= window.min.x * static_cast<std::int64_t>(target.xStride) +
                           window.min.y * static_cast<std::int64_t>(target.yStride);
            frame.insert(channel_name(layer, channel_names[c]), target);
        }
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    return image;
}

}  // namespace

void write_exr(const std::string& path, const FilmImage& film, const Metadata& metadata) {
    std::string bytes;
    try {
        bytes = encode(path, film, metadata);
    } catch (const RunError&) {
        throw;
    } catch (const std::exception& error) {
        throw RunError(fmt::format("{}: cannot write: {}", path, reason_of(error)));
    }
    write_file_atomically(path, bytes);
}

ExrImage read_exr(const std::string& path) {
    const std::string bytes = read_file(path);
    try {
        return decode(path, bytes);
    } catch (const std::exception& error) {
        throw InputError(fmt::format("{}: not a readable OpenEXR file: {}", path, reason_of(error)));
    }
}

}  // namespace stokes
