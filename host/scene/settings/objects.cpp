#include "host/scene/settings/objects.hpp"

#include <nlohmann/json.hpp>

#include "host/scene/scene.hpp"
#include "host/scene/settings/settings.hpp"

namespace stokes {
namespace {

// The settings whose keys are in this object.
std::vector<Key> setting_keys(const std::string& object) {
    std::vector<Key> keys;
    for (const Setting& setting : settings()) {
        if (setting.object != object) continue;
        Key key{setting.key, setting.domain, optional, setting.sentence() + "."};
        const nlohmann::ordered_json fallback = setting.constant_default();
        if (fallback.is_boolean()) key.fallback = fallback.get<bool>();
        if (fallback.is_number_integer()) key.fallback = fallback.get<int>();
        if (fallback.is_number_float()) key.fallback = fallback.get<double>();
        if (fallback.is_string()) key.fallback = fallback.get<std::string>();
        keys.push_back(key);
    }
    return keys;
}

// Below this the pixels of a picture come close to the steps of single precision, in which rays are.
constexpr NumberRange crop_size_range{1e-3, 1.0};
constexpr NumberRange crop_corner_range{0.0, 1.0};

ObjectDeclaration scene_object() {
    ObjectDeclaration scene{
        "scene",
        "A scene: what there is, what lights it, who looks at it. Files are named relative to the scene's folder.",
        {{"$schema", Text{}, optional, "For editors."},
         {"comment", Text{}, optional, "For people."},
         {"format", OneWord{{"stokes-scene"}}, required, "What this file is."},
         {"version", IntegerRange{1, 1}, required, "Of the format."},
         {"render", Declared{"render"}, optional, "How it is rendered; the command line has the last word."},
         {"film", Declared{"film"}, optional, "The picture."},
         {"camera", Declared{"camera"}, required, "Who looks at it."},
         {"spectra", ByName{"spectrum_object"}, optional, "Spectra by name."},
         {"media", ByName{"medium"}, optional, "Media by name."},
         {"fluorophores", ByName{"fluorophore"}, optional, "Fluorescent substances by name."},
         {"materials", ByName{"material"}, required, "Materials by name."},
         {"lights", ListOf{"light", 1}, required, "At least one."},
         {"shapes", ListOf{"shape"}, optional, "May be left out when a light has a surface."}}};
    for (const Key& key : setting_keys("")) scene.keys.push_back(key);
    return scene;
}

Objects make_objects() {
    Objects objects{
        scene_object(),
        {"render", "Settings of the render.", setting_keys("render")},
        {"film", "The picture.", setting_keys("film")},
        {"camera",
         "A pinhole camera.",
         {{"position_mm", Vector{}, required, "The pinhole."},
          {"target_mm", Vector{}, required, "In the middle of the picture; not the pinhole itself."},
          {"up", Direction{}, optional, "Upward in the picture; not along the view. By default +y."},
          {"vertical_fov_deg", NumberRange{0.01, 179.0}, Camera().vertical_fov_deg,
           "Full angle of view from bottom to top of the whole picture."},
          {"crop", Declared{"crop"}, optional, "What of the whole picture the film shows; by default all."}}},
        {"crop",
         "The window of the picture that the film shows, in fractions of the whole: a close-up from the same place. "
         "Pixels stay square, so that the whole has film.width / width by film.height / height of them.",
         {{"left", crop_corner_range, required, "left + width is 1 at most."},
          {"top", crop_corner_range, required, "top + height is 1 at most."},
          {"width", crop_size_range, required, "Of the whole picture's width."},
          {"height", crop_size_range, required, "Of the whole picture's height."}}},
    };
    for (const Objects& part : {material_objects(), light_objects(), shape_objects()})
        objects.insert(objects.end(), part.begin(), part.end());
    return objects;
}

}  // namespace

const Objects& scene_objects() {
    static const Objects objects = make_objects();
    return objects;
}

}  // namespace stokes
