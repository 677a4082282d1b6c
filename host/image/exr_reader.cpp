// Reading OpenEXR files, of this program and of others.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/text_input.hpp"
#include "host/image/colour.hpp"
#include "host/image/exr.hpp"
#include "host/image/exr_errors.hpp"
#include "host/image/memory_stream.hpp"

namespace stokes {
namespace {

constexpr std::int64_t most_values = std::int64_t{1} << 31;  // of a file: 8 GiB of floats

// Flags in the second byte of a file's version: "OpenEXR File Layout", version field.
constexpr std::size_t flags_byte = 5;
constexpr unsigned deep_flag = 0x08, parts_flag = 0x10;

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

// The channels that a layer's three values are read from: R, G, B; X, Y, Z; or Y three times, which is grey.
using LayerChannels = std::map<std::string, std::array<std::string, 3>>;

bool is_any_of(const std::string& name, const std::string& letters) {
    return name.size() == 1 && letters.find(name) != std::string::npos;
}

std::string in_layer(const std::string& layer, char channel) {
    return layer.empty() ? std::string(1, channel) : layer + "." + channel;
}

void check_layer(const std::string& path, const Imf::ChannelList& channels, const std::string& layer) {
    for (const char channel : {'R', 'G', 'B'})
        if (channels.findChannel(in_layer(layer, channel)) == nullptr)
            throw InputError(fmt::format("{}: expected channels R, G, B in each layer that has one of them, got no {}",
                                         path, in_layer(layer, channel)));
}

std::string names_of(const Imf::ChannelList& channels) {
    std::string names;
    for (auto it = channels.begin(); it != channels.end(); ++it)
        names += fmt::format("{}{}", names.empty() ? "" : ", ", it.name());
    return names.empty() ? "none" : names;
}

// X, Y, Z and Y alone count without a layer only: layers by these names hold places and directions.
LayerChannels find_layers(const std::string& path, const Imf::ChannelList& channels) {
    LayerChannels layers;
    for (auto it = channels.begin(); it != channels.end(); ++it) {
        const std::string name = it.name();
        const std::size_t dot = name.rfind('.');
        const std::string last = dot == std::string::npos ? name : name.substr(dot + 1);
        const std::string layer = dot == std::string::npos ? "" : name.substr(0, dot);
        if (!is_any_of(last, "RGB")) continue;
        check_layer(path, channels, layer);
        layers[layer] = {in_layer(layer, 'R'), in_layer(layer, 'G'), in_layer(layer, 'B')};
    }
    const auto has = [&](const char* name) { return channels.findChannel(name) != nullptr; };
    if (layers.count("") == 0 && has("X") && has("Y") && has("Z"))
        layers[""] = {"X", "Y", "Z"};
    else if (layers.count("") == 0 && has("Y") && !has("X") && !has("Z") && !has("RY") && !has("BY"))
        layers[""] = {"Y", "Y", "Y"};
    if (layers.empty())
        throw InputError(
            fmt::format("{}: expected channels R, G, B, or X, Y, Z, or Y, got {}", path, names_of(channels)));
    return layers;
}

void check_sampling(const std::string& path, const Imf::ChannelList& channels, const LayerChannels& layers) {
    for (const auto& [layer, names] : layers)
        for (const std::string& name : names) {
            const Imf::Channel& channel = channels[name.c_str()];
            if (channel.xSampling != 1 || channel.ySampling != 1)
                throw InputError(fmt::format("{}: channel {}: expected a value for each pixel, got one for {} x {}",
                                             path, name, channel.xSampling, channel.ySampling));
        }
}

// By the file's own primaries and white; Rec. 709 where it names none, as the OpenEXR standard has it. Nothing is
// adapted to another white.
glm::dmat3 xyz_from_file(const std::string& path, const Imf::Header& header) {
    Imf::Chromaticities c;
    if (Imf::hasChromaticities(header)) c = Imf::chromaticities(header);
    const auto of = [](const Imath::V2f& v) { return glm::dvec2(v.x, v.y); };
    const std::optional<glm::dmat3> matrix = xyz_from_primaries({of(c.red), of(c.green), of(c.blue), of(c.white)});
    if (!matrix)
        throw InputError(
            fmt::format("{}: chromaticities: expected three primaries that mix their white, got red ({}, "
                        "{}), green ({}, {}), blue ({}, {}), white ({}, {})",
                        path, c.red.x, c.red.y, c.green.x, c.green.y, c.blue.x, c.blue.y, c.white.x, c.white.y));
    return *matrix;
}

bool is_rec709(const Imf::Header& header) {
    if (!Imf::hasChromaticities(header)) return true;
    const Imf::Chromaticities own = Imf::chromaticities(header), standard;
    return own.red == standard.red && own.green == standard.green && own.blue == standard.blue &&
           own.white == standard.white;
}

void transform(std::vector<float>& values, const glm::dmat3& matrix) {
    for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
        const glm::dvec3 v = matrix * glm::dvec3(values[i], values[i + 1], values[i + 2]);
        for (int c = 0; c < 3; ++c) values[i + static_cast<std::size_t>(c)] = static_cast<float>(v[c]);
    }
}

void to_rec709(const std::string& path, const Imf::Header& header, const LayerChannels& layers, ExrImage& image) {
    for (auto& [layer, values] : image.layers) {
        const std::string& first = layers.at(layer).front();
        if (first == "X")
            transform(values, rec709_from_xyz());
        else if (first != "Y" && !is_rec709(header))
            transform(values, rec709_from_xyz() * xyz_from_file(path, header));
    }
}

// Pictures of this program have a white of 1 cd/m^2, and those of most others none.
void warn_of_scale(const std::string& path, const Imf::Header& header) {
    if (Imf::hasWhiteLuminance(header) && Imf::whiteLuminance(header) != 1.0f)
        warn(fmt::format("{}: whiteLuminance, {} cd/m^2, is not applied: the values are taken as cd/m^2", path,
                         Imf::whiteLuminance(header)));
}

// What InputFile would read in part only, or not in a sentence.
void check_kind(const std::string& path, const std::string& bytes) {
    const unsigned flags = bytes.size() > flags_byte ? static_cast<unsigned char>(bytes[flags_byte]) : 0u;
    if ((flags & parts_flag) != 0) {
        MemoryReader stream(path.c_str(), bytes);
        const Imf::MultiPartInputFile file(stream);
        std::string names;
        for (int i = 0; i < file.parts(); ++i)
            names += fmt::format("{}{}", i == 0 ? "" : ", ", file.header(i).hasName() ? file.header(i).name() : "-");
        if (file.parts() != 1)
            throw InputError(fmt::format("{}: expected a file of one part, got {}: {}", path, file.parts(), names));
    }
    if ((flags & deep_flag) != 0)
        throw InputError(path + ": expected one value for each pixel, got deep pixels, which hold several");
}

void set_windows(ExrImage& image, const Imf::Header& header, std::size_t layers) {
    const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
    const std::int64_t width = std::int64_t{data.max.x} - data.min.x + 1;
    const std::int64_t height = std::int64_t{data.max.y} - data.min.y + 1;
    if (width > most_values || height > most_values ||
        width * height > most_values / (3 * static_cast<std::int64_t>(layers)))
        throw Iex::InputExc("picture too large");
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    image.frame.left = std::int64_t{data.min.x} - display.min.x;
    image.frame.top = std::int64_t{data.min.y} - display.min.y;
    image.frame.width = std::int64_t{display.max.x} - display.min.x + 1;
    image.frame.height = std::int64_t{display.max.y} - display.min.y + 1;
}

ExrImage decode(const std::string& path, const std::string& bytes) {
    check_kind(path, bytes);
    MemoryReader stream(path.c_str(), bytes);
    Imf::InputFile file(stream);
    if (!file.isComplete()) throw Iex::InputExc("scan lines are missing");
    const Imf::Header& header = file.header();
    const LayerChannels layers = find_layers(path, header.channels());
    check_sampling(path, header.channels(), layers);

    ExrImage image;
    image.attributes = attributes_of(header);
    set_windows(image, header, layers.size());
    const Imath::Box2i window = header.dataWindow();
    Imf::FrameBuffer frame;
    for (const auto& [layer, names] : layers) {
        std::vector<float>& values = image.layers[layer];
        values.assign(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3, 0.0f);
        const std::size_t pixel = 3 * sizeof(float);
        for (std::size_t c = 0; c < (names[0] == names[1] ? 1 : 3); ++c) {
            Imf::Slice target(Imf::FLOAT, reinterpret_cast<char*>(values.data() + c), pixel,
                              pixel * static_cast<std::size_t>(image.width));
            target.base -= window.min.x * static_cast<std::int64_t>(target.xStride) +
                           window.min.y * static_cast<std::int64_t>(target.yStride);
            frame.insert(names[c], target);
        }
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    for (const auto& [layer, names] : layers)
        if (names[0] == names[1])
            for (std::size_t i = 0; i < image.layers[layer].size(); i += 3)
                image.layers[layer][i + 1] = image.layers[layer][i + 2] = image.layers[layer][i];
    to_rec709(path, header, layers, image);
    warn_of_scale(path, header);
    return image;
}

}  // namespace

ExrImage read_exr(const std::string& path) {
    const std::string bytes = read_file(path);
    try {
        return decode(path, bytes);
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError(fmt::format("{}: not a readable OpenEXR file: {}", path, exr_reason(error)));
    }
}

}  // namespace stokes
