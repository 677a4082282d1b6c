// Lights of a scene file.
#include "host/scene/settings/objects.hpp"

namespace stokes {
namespace {

constexpr NumberRange amount_range{0.0, 1e12, true};

const Key own_name{"name", OwnName{}, optional, "Of its own, for messages and reports; by default its kind and index."};
const Key center{"center_mm", Vector{}, required, "Its middle."};
const Key normal{"normal", Direction{}, required, "Out of its front."};
const Key width{"width_mm", length_range, required, "Across up."};
const Key height{"height_mm", length_range, required, "Along up."};

Key type(const char* word) { return {"type", OneWord{{word}}, required, "The kind of light."}; }
Key radius(const char* of) { return {"radius_mm", length_range, required, of}; }
Key up(const char* otherwise) { return {"up", Direction{}, optional, otherwise}; }

ObjectDeclaration beam(const std::string& section, const std::vector<Key>& size) {
    ObjectDeclaration light{
        "beam_" + section,
        "Parallel light through a " + section + ".",
        {type("beam"),
         {"section", OneWord{{section}}, required, "The beam's cross-section."},
         {"position_mm", Vector{}, required, "Centre of the cross-section, where the light starts."},
         {"direction", Direction{}, required, "Of the light."},
         {"spectrum", any_spectrum, required, "Relative. Zero outside its table unless it says otherwise."},
         {"irradiance_W_m2", amount_range, required,
          "On a surface at right angles to the beam, over the render's wavelengths."},
         own_name}};
    light.keys.insert(light.keys.end(), size.begin(), size.end());
    return light;
}

ObjectDeclaration emitter(const char* shape, const std::string& help, const std::vector<Key>& size) {
    ObjectDeclaration light{
        std::string("emitter_") + shape,
        help,
        {type(shape),
         center,
         {"spectrum", any_spectrum, required,
          "Relative, or absolute with radiance_scale_W_m2_sr_nm. Zero outside its table unless it says otherwise."},
         {"power_W", amount_range, optional, "Power of the whole light over the render's wavelengths."},
         {"radiance_W_m2_sr", amount_range, optional, "Radiance over the render's wavelengths."},
         {"radiance_scale_W_m2_sr_nm", amount_range, optional, "Spectral radiance is the spectrum times this."},
         {"material", NameIn{"materials"}, optional,
          "A name in materials, for the light that arrives; black by default."},
         own_name},
        {"power_W", "radiance_W_m2_sr", "radiance_scale_W_m2_sr_nm"}};
    light.keys.insert(light.keys.end(), size.begin(), size.end());
    return light;
}

}  // namespace

Objects light_objects() {
    const std::string front = " that shines from its front, evenly in all directions.";
    return {
        {"light",
         "Where light comes from.",
         {},
         {},
         {},
         {"beam_disk", "beam_rectangle", "emitter_rectangle", "emitter_disk", "emitter_sphere"}},
        beam("disk", {radius("Of the disk.")}),
        beam("rectangle", {width, height, up("By default +y, or +z for a vertical beam.")}),
        emitter("rectangle", "A rectangle" + front,
                {normal, width, height, up("By default +y, or +z for a horizontal rectangle.")}),
        emitter("disk", "A disk" + front, {normal, radius("Of its edge.")}),
        emitter("sphere", "A sphere that shines outward.", {radius("Of its surface.")}),
    };
}

}  // namespace stokes
