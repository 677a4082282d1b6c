#include "host/scene/readers/light_reader.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/scene/mesh/mesh.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "host/scene/readers/material_reader.hpp"
#include "host/scene/readers/shape_reader.hpp"

namespace stokes {
namespace {

constexpr double m2_per_mm2 = 1e-6;
constexpr const char* built_in_black = "(black)";

// Right-handed: u x axis = v.
struct Frame {
    glm::dvec3 u;
    glm::dvec3 axis;
    glm::dvec3 v;
};

// v is as close to "up" as the axis lets it be; where the scene has no "up", to +y, or +z about a vertical
// axis.
Frame read_frame(const JsonCursor& light, const char* axis_key) {
    Frame frame;
    frame.axis = light.at(axis_key).direction();
    const bool vertical = std::abs(frame.axis.y) > 0.999;
    glm::dvec3 up = vertical ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    if (const auto given = light.find("up")) {
        up = given->direction();
        if (glm::length(glm::cross(up, frame.axis)) < 1e-6) {
            given->fail(fmt::format("expected another direction than {}", axis_key));
        }
    }
    frame.u = glm::normalize(glm::cross(frame.axis, up));
    frame.v = glm::cross(frame.u, frame.axis);
    return frame;
}

// The light's spectrum times total over its own sum, so that it sums to total over the render's wavelengths.
Spectrum with_total(const JsonCursor& light, const Spectrum& spectrum, double total, const RenderSettings& render) {
    const double sum = spectrum.sum_1nm(render.lambda_min_nm, render.lambda_max_nm);
    const double factor = total / sum;
    if (!(sum > 0.0) || !std::isfinite(factor)) {
        light.at("spectrum")
            .fail(fmt::format("expected some light from {} to {} nm, got {}", render.lambda_min_nm,
                              render.lambda_max_nm, sum > 0.0 ? fmt::format("a sum of only {:g}", sum) : "none"));
    }
    return spectrum.scaled(factor);
}

Spectrum emitter_flux(const ObjectReader& light, const Spectrum& spectrum, double area_mm2,
                      const RenderSettings& render) {
    const std::string unit = light.exactly_one();
    const double amount = light.number(unit);
    const double watt_per_radiance = M_PI * area_mm2 * m2_per_mm2;
    if (unit == "power_W") return with_total(light, spectrum, amount, render);
    if (unit == "radiance_W_m2_sr") return with_total(light, spectrum, amount * watt_per_radiance, render);
    with_total(light, spectrum, 1.0, render);
    return spectrum.scaled(amount * watt_per_radiance);
}

int emitter_material(const JsonCursor& light, Scene& scene) {
    if (const auto material = light.find("material")) return index_of_name(*material, "materials", scene.materials);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (scene.materials[i].name == built_in_black) return static_cast<int>(i);
    }
    Material black;
    black.name = built_in_black;
    scene.materials.push_back(black);
    return static_cast<int>(scene.materials.size()) - 1;
}

Beam place_beam(const ObjectReader& where, double half_width_mm, double half_height_mm) {
    const Frame frame = read_frame(where, "direction");
    return {where.vector("position_mm"), frame.axis, half_width_mm * frame.u, half_height_mm * frame.v};
}

Light read_beam(const ObjectReader& where, SpectrumReader& spectra, const RenderSettings& render) {
    Light light;
    double area_mm2 = 0.0;
    if (where.kind() == "beam_disk") {
        const double radius_mm = where.number("radius_mm");
        light.kind = DiskBeam{place_beam(where, radius_mm, radius_mm)};
        area_mm2 = M_PI * radius_mm * radius_mm;
    } else if (where.kind() == "beam_rectangle") {
        const RectangleBeam beam{place_beam(where, 0.5 * where.number("width_mm"), 0.5 * where.number("height_mm"))};
        light.kind = beam;
        area_mm2 = 4.0 * glm::length(beam.half_u_mm) * glm::length(beam.half_v_mm);
    } else {
        where.fail_unread();
    }
    const double power_w = where.number("irradiance_W_m2") * area_mm2 * m2_per_mm2;
    light.flux = with_total(where, spectra.read_density(where, "spectrum"), power_w, render);
    return light;
}

glm::dmat4 placed(const Frame& frame, const glm::dvec3& center_mm) {
    return {glm::dvec4(frame.u, 0), glm::dvec4(frame.axis, 0), glm::dvec4(frame.v, 0), glm::dvec4(center_mm, 1)};
}

// The emitter's mesh about the origin; transform: to its place.
Mesh read_emitter_mesh(const ObjectReader& where, glm::dmat4& transform) {
    Mesh mesh;
    if (where.kind() == "emitter_rectangle") {
        transform = placed(read_frame(where, "normal"), where.vector("center_mm"));
        mesh = make_rectangle(where.number("width_mm"), where.number("height_mm"));
    } else if (where.kind() == "emitter_disk") {
        transform = placed(read_frame(where, "normal"), where.vector("center_mm"));
        mesh = make_disk(where.number("radius_mm"));
    } else if (where.kind() == "emitter_sphere") {
        transform[3] = glm::dvec4(where.vector("center_mm"), 1.0);
        mesh = make_sphere(where.number("radius_mm"));
    } else {
        where.fail_unread();
    }
    return mesh;
}

Light read_emitter(const ObjectReader& where, const std::string& name, Scene& scene, Placement& placement) {
    Shape shape;
    shape.name = name;
    glm::dmat4 transform(1.0);
    const Mesh mesh = read_emitter_mesh(where, transform);
    shape.material = emitter_material(where, scene);
    shape.body = scene.body_count++;
    shape.light = static_cast<int>(scene.lights.size());
    Light light;
    light.kind = SurfaceLight{placement.add(where, std::move(shape), mesh, transform)};
    return light;
}

}  // namespace

void read_lights(const JsonCursor& lights, SpectrumReader& spectra, Scene& scene, Placement& placement) {
    std::vector<std::string> names;
    for (const JsonCursor& place : lights.items()) {
        const ObjectReader where(place, "light");
        const bool beam = where.kind().rfind("beam_", 0) == 0, emitter = where.kind().rfind("emitter_", 0) == 0;
        if (!beam && !emitter) where.fail_unread();
        names.push_back(read_own_name(where, fmt::format("light {}", names.size()), names));
        Light light =
            beam ? read_beam(where, spectra, scene.render) : read_emitter(where, names.back(), scene, placement);
        light.name = names.back();
        scene.lights.push_back(std::move(light));
    }
    if (scene.lights.empty()) lights.fail("expected at least one light");
}

void read_emitter_spectra(const JsonCursor& lights, SpectrumReader& spectra, Scene& scene) {
    const std::vector<JsonCursor> places = lights.items();
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto* emitter = std::get_if<SurfaceLight>(&scene.lights[i].kind);
        if (emitter == nullptr) continue;
        const ObjectReader where(places[i], "light");
        const Spectrum spectrum = spectra.read_density(where, "spectrum");
        const double area_mm2 = mesh_area_mm2(scene.shapes[static_cast<std::size_t>(emitter->shape)].mesh);
        scene.lights[i].flux = emitter_flux(where, spectrum, area_mm2, scene.render);
    }
}

}  // namespace stokes
