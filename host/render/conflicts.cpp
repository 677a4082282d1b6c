#include "host/render/conflicts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/error.hpp"
#include "host/render/device_scene.hpp"
#include "host/render/transport/transport_model.hpp"
#include "host/scene/mesh/contacts.hpp"

namespace stokes {

namespace {

// Bodies smaller than so many offsets of rays are told of. A box of 40 mm, 200 offsets, lost 0.012 of the light.
constexpr double least_offsets = 250.0;

bool takes_for_half_space(const Scene& scene, int body) {
    return transport_model(transport_of_body(scene, body)).takes_bodies_for_half_spaces();
}

std::string transport_word(const Scene& scene, int body) {
    return std::string(word_of(transport_of_body(scene, body)));
}

std::string name_of_body(const Scene& scene, int body) {
    for (const Shape& shape : scene.shapes)
        if (shape.body == body) return fmt::format("shape \"{}\"", shape.name);
    return "a shape";
}

bool has_medium(const Scene& scene, int body) {
    for (const Shape& shape : scene.shapes)
        if (shape.body == body && medium_of(scene.materials[static_cast<std::size_t>(shape.material)])) return true;
    return false;
}

void check_lights(const Scene& scene) {
    for (const Light& light : scene.lights) {
        const Container container = container_of_light(scene, light);
        if (container.part && !container.whole)
            throw InputError(
                fmt::format("{}: light \"{}\": lies partly within the translucent {}; expected a light that is wholly "
                            "inside or outside",
                            scene.file, light.name, name_of_body(scene, *container.part)));
        if (container.whole && takes_for_half_space(scene, *container.whole))
            throw InputError(
                fmt::format("{}: light \"{}\": lies within the translucent {}; transport \"{}\" does not follow light "
                            "from within a "
                            "body, \"walk\" does",
                            scene.file, light.name, name_of_body(scene, *container.whole),
                            transport_word(scene, *container.whole)));
    }
}

void check_camera(const Scene& scene) {
    const Container container = container_of_camera(scene);
    if (container.whole)
        throw InputError(
            fmt::format("{}: camera: lies within the translucent {}; a translucent body is seen from outside only",
                        scene.file, name_of_body(scene, *container.whole)));
}

bool is_light(const Scene& scene, int body) {
    for (const Shape& shape : scene.shapes)
        if (shape.body == body && shape.light >= 0) return true;
    return false;
}

void add_contained(const Scene& scene, std::vector<std::string>& lines) {
    for (int body = 0; body < scene.body_count; ++body) {
        if (is_light(scene, body)) continue;
        const Container container = container_of_body(scene, body);
        if (container.whole && takes_for_half_space(scene, *container.whole))
            lines.push_back(fmt::format(
                "{}: {} lies within {} and is not seen: transport \"{}\" takes a body for a half-space; \"walk\" "
                "sees what lies within",
                scene.file, name_of_body(scene, body), name_of_body(scene, *container.whole),
                transport_word(scene, *container.whole)));
    }
}

// Bodies so small beside the scene that rays start far off their surfaces.
void add_tiny(const Scene& scene, double offset_mm, std::vector<std::string>& lines) {
    std::size_t tiny = 0;
    std::string name;
    double smallest_mm = INFINITY;
    for (const Shape& shape : scene.shapes) {
        const Bounds box = mesh_bounds(shape.mesh);
        const glm::dvec3 size = box.high_mm - box.low_mm;
        const double largest_mm = std::max({size.x, size.y, size.z});
        if (!(largest_mm < least_offsets * offset_mm)) continue;
        ++tiny;
        if (largest_mm < smallest_mm) {
            smallest_mm = largest_mm;
            name = shape.name;
        }
    }
    if (tiny == 0) return;
    lines.push_back(fmt::format(
        "{}: shape \"{}\"{} is {:.3g} mm large in a scene where rays start {:.2g} mm off a surface, in proportion to "
        "what lies farthest out: its shadows and faces are not right",
        scene.file, name, tiny > 1 ? fmt::format(" (and {} more)", tiny - 1) : "", smallest_mm, offset_mm));
}

}  // namespace

std::vector<std::string> find_conflicts(const Scene& scene) {
    check_lights(scene);
    check_camera(scene);
    std::vector<std::string> lines;
    add_contained(scene, lines);
    add_tiny(scene, ray_offset_mm(scene), lines);
    const Contacts contacts = find_contacts(scene, ray_offset_mm(scene));
    for (const auto& [body, other] : contacts.coincide)
        lines.push_back(fmt::format(
            "{}: {} and {} are translucent and have surfaces in one place that face the same way: light enters the "
            "later one there",
            scene.file, name_of_body(scene, body), name_of_body(scene, other)));
    for (const auto& [body, other] : contacts.cross) {
        const bool both = has_medium(scene, other);
        if (!both && !takes_for_half_space(scene, body)) continue;
        lines.push_back(fmt::format("{}: {} and {} pass through one another: {}", scene.file, name_of_body(scene, body),
                                    name_of_body(scene, other),
                                    both ? "where light goes in the part that both fill is not defined"
                                         : "transport \"" + transport_word(scene, body) +
                                               "\" does not see what lies within a body; \"walk\" does"));
    }
    return lines;
}

}  // namespace stokes
