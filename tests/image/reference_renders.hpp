// The renders that test_references compares with their references, and the references' files.
#pragma once

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/core/json_tree.hpp"
#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace stokes {

// A shipped scene in 16 x 12 blocks of pixels, in sixteen neighbouring wavelengths and under lamps that are
// flat over them: all passes have the same wavelengths, so that what is left of the noise is that of photons
// and of camera rays. Beams are half as wide, so that more of their photons are seen. Every render has the
// same passes, so that the blur of their radii is the same in a test and in its reference; direct light by rays has
// none.
struct ReferenceSetting {
    std::string name, scene_file;
    int lambda_min_nm;  // to lambda_min_nm + 15
    std::int64_t photons_per_pass;
    double radius_mm;
    Direct direct = Direct::photons;
};

// The dots' emission peaks at 545, 585 and 655 nm: their light is excited and seen on its short side.
inline const std::vector<ReferenceSetting> reference_settings = {
    {"sphere", "sphere.json", 575, 24000, 8.0},
    {"prisms_545", "prisms.json", 535, 24000, 14.0},
    {"prisms_585", "prisms.json", 575, 24000, 14.0},
    {"prisms_655", "prisms.json", 643, 24000, 14.0},
    {"sphere_rays", "sphere.json", 575, 24000, 8.0, Direct::rays}};
inline constexpr std::uint32_t reference_passes = 64;   // of a render
inline constexpr std::uint32_t reference_renders = 24;  // their mean is the reference
inline constexpr std::uint32_t first_reference_seed = 1000;
inline constexpr int reference_columns = 16, reference_rows = 12, block_edge = 3;  // blocks, pixels
// Values of a layer: X, Y, Z of each block's mean, and of the picture's mean after them.
inline constexpr std::size_t reference_values = (std::size_t{reference_columns} * reference_rows + 1) * 3;

inline Scene reference_scene(const ReferenceSetting& setting, std::uint32_t seed) {
    Scene scene = read_scene(source_path("scenes/" + setting.scene_file));
    for (Light& light : scene.lights) {
        light.flux = Spectrum::constant(1.0);
        if (DiskBeam* beam = std::get_if<DiskBeam>(&light.kind)) {
            beam->half_u_mm *= 0.5;
            beam->half_v_mm *= 0.5;
        }
    }
    scene.film = {reference_columns * block_edge, reference_rows * block_edge, {}};
    scene.render.lambda_min_nm = setting.lambda_min_nm;
    scene.render.lambda_max_nm = setting.lambda_min_nm + 15;
    scene.render.photons_per_pass = setting.photons_per_pass;
    scene.render.radius_mm = setting.radius_mm;
    scene.render.alpha = 2.0 / 3.0;
    scene.render.seed = seed;
    scene.render.direct = setting.direct;
    return scene;
}

using LayerSamples = std::array<std::vector<Sample>, layer_count>;  // [layer][reference_values]

inline std::vector<double> reference_values_of(const FilmImage& image, std::size_t layer) {
    std::vector<double> values(reference_values, 0.0);
    const double block_pixels = block_edge * block_edge;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (std::size_t k = 0; k < 3; ++k) {
                const int block = y / block_edge * reference_columns + x / block_edge;
                const double v = image.xyz[layer][static_cast<std::size_t>(y * image.width + x) * 3 + k];
                values[static_cast<std::size_t>(block) * 3 + k] += v / block_pixels;
                values[reference_values - 3 + k] += v / static_cast<double>(image.pixels());
            }
    return values;
}

inline void add_values(LayerSamples& samples, const FilmImage& image) {
    for (std::size_t c = 0; c < layer_count; ++c) {
        const std::vector<double> values = reference_values_of(image, c);
        samples[c].resize(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) samples[c][i].add(values[i]);
    }
}

struct Reference {
    std::array<std::vector<double>, layer_count> mean,
        standard_error;  // [layer][reference_values], cd/m^2
    double renders = 0.0;
};

inline std::string reference_path(const ReferenceSetting& setting) {
    return source_path("tests/image/references/" + setting.name + ".json");
}

inline std::string json_numbers(const std::vector<double>& values) {
    std::string text;
    for (std::size_t i = 0; i < values.size(); ++i)
        text += fmt::format("{}{:.5g}", i == 0 ? "" : i % 15 == 0 ? ",\n      " : ", ", values[i]);
    return "[" + text + "]";
}

inline void write_reference(const ReferenceSetting& s, const LayerSamples& samples) {
    std::string layers;
    for (std::size_t c = 0; c < layer_count; ++c) {
        std::vector<double> mean, error;
        for (const Sample& sample : samples[c]) {
            mean.push_back(sample.mean());
            error.push_back(sample.standard_error());
        }
        layers += fmt::format("{}\n    \"{}\": {{\n      \"xyz\": {},\n      \"standard_error\": {}}}",
                              c == 0 ? "" : ",", layer_rows[c].name, json_numbers(mean), json_numbers(error));
    }
    write_file_atomically(
        reference_path(s),
        fmt::format("{{\"format\": \"stokes-reference\", \"version\": 1,\n  \"comment\": \"Written by "
                    "scripts/make_references: means of independent renders of the same passes, XYZ [cd/m^2] of each "
                    "block, top row first, then of the picture's mean.\",\n"
                    "  \"scene\": \"{}\", \"width\": {}, \"height\": {},\n"
                    "  \"lambda_min_nm\": {}, \"lambda_max_nm\": {}, \"lamp_W_nm\": 1,\n"
                    "  \"photons_per_pass\": {}, \"radius_mm\": {}, \"alpha\": {},\n"
                    "  \"passes\": {}, \"renders\": {}, \"first_seed\": {},\n  \"layers\": {{{}\n  }}\n}}\n",
                    s.scene_file, reference_columns * block_edge, reference_rows * block_edge, s.lambda_min_nm,
                    s.lambda_min_nm + 15, s.photons_per_pass, s.radius_mm, 2.0 / 3.0, reference_passes,
                    reference_renders, first_reference_seed, layers));
}

inline const JsonValue& member(const JsonValue& object, const std::string& key) {
    for (std::size_t i = 0; i < object.keys.size(); ++i)
        if (object.keys[i].name == key) return object.items[i];
    throw InputError("reference: expected the key " + key);
}

// InputError where the file is none, or was made with other settings.
inline Reference read_reference(const ReferenceSetting& s) {
    const std::string path = reference_path(s);
    const JsonValue root = parse_json(file_content(path), path);
    const std::vector<std::pair<std::string, double>> settings = {
        {"width", reference_columns * block_edge},
        {"height", reference_rows * block_edge},
        {"lambda_min_nm", s.lambda_min_nm},
        {"photons_per_pass", static_cast<double>(s.photons_per_pass)},
        {"radius_mm", s.radius_mm},
        {"passes", reference_passes}};
    for (const auto& [key, value] : settings)
        if (member(root, key).number != value)
            throw InputError(path + ": made with another " + key + "; scripts/make_references makes it anew");
    Reference reference;
    reference.renders = member(root, "renders").number;
    for (std::size_t c = 0; c < layer_count; ++c) {
        const JsonValue& layer = member(member(root, "layers"), layer_rows[c].name);
        for (const JsonValue& v : member(layer, "xyz").items) reference.mean[c].push_back(v.number);
        for (const JsonValue& v : member(layer, "standard_error").items)
            reference.standard_error[c].push_back(v.number);
        if (reference.mean[c].size() != reference_values || reference.standard_error[c].size() != reference_values)
            throw InputError(path + ": expected " + std::to_string(reference_values) + " values a layer");
    }
    return reference;
}

}  // namespace stokes
