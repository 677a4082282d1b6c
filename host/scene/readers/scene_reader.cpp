#include "host/scene/readers/scene_reader.hpp"

#include <filesystem>
#include <new>

#include "host/core/error.hpp"
#include "host/core/json_cursor.hpp"
#include "host/core/text_input.hpp"
#include "host/scene/readers/camera_reader.hpp"
#include "host/scene/readers/light_reader.hpp"
#include "host/scene/readers/material_reader.hpp"
#include "host/scene/readers/placement.hpp"
#include "host/scene/readers/shape_reader.hpp"
#include "host/scene/readers/spectrum_reader.hpp"
#include "host/scene/settings/object.hpp"
#include "host/scene/settings/settings_reader.hpp"

namespace stokes {

Scene read_scene(const std::string& path, const FlagValues& flags) {
    const std::string text = read_file(path);
    try {
        return parse_scene(text, path, flags);
    } catch (const std::bad_alloc&) {
        throw InputError(path + ": this scene is too large for the memory");
    }
}

Scene parse_scene(std::string_view text, const std::string& path, const FlagValues& flags) {
    const JsonValue tree = parse_json(text, path);
    const JsonCursor root(tree, path);
    root.expect_object();
    root.at("format").choice({"stokes-scene"});
    root.at("version").integer(1, 1);
    ObjectReader(root, "scene");

    Scene scene;
    scene.file = path;
    read_settings(root, flags, scene);
    scene.camera = read_camera(root.at("camera"));

    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    SpectrumReader spectra(folder);
    if (const auto found = root.find("spectra")) spectra.define(*found);
    if (const auto media = root.find("media")) scene.media = read_media(*media, spectra);
    if (const auto found = root.find("fluorophores")) scene.fluorophores = read_fluorophores(*found, spectra);
    scene.materials = read_materials(root.at("materials"), spectra, scene);
    Placement placement;
    if (const auto shapes = root.find("shapes")) read_shapes(*shapes, folder, scene, placement);
    read_lights(root.at("lights"), spectra, scene, placement);
    placement.settle(root, scene);
    read_emitter_spectra(root.at("lights"), spectra, scene);
    scene.unused_spectra = spectra.unused();
    if (scene.shapes.empty()) root.fail("nothing to see: no shapes, and no light with a surface");
    return scene;
}

}  // namespace stokes
