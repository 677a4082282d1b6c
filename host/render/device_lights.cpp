#include "host/render/device_lights.hpp"

#include <algorithm>
#include <cmath>

#include "host/core/overloaded.hpp"

namespace stokes {

namespace {

void set_ball(LightRecord& record, const Mesh& mesh) {
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (const glm::vec3& p : mesh.positions_mm) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 centre = 0.5f * (low + high);
    record.px = centre.x, record.py = centre.y, record.pz = centre.z;
    for (const glm::vec3& p : mesh.positions_mm) record.ball_mm = std::max(record.ball_mm, glm::length(p - centre));
}

void set_beam(LightRecord& record, const Beam& beam) {
    const glm::vec3 p(beam.position_mm), d(glm::normalize(beam.direction)), u(beam.half_u_mm), v(beam.half_v_mm);
    record.px = p.x, record.py = p.y, record.pz = p.z;
    record.dx = d.x, record.dy = d.y, record.dz = d.z;
    record.ux = u.x, record.uy = u.y, record.uz = u.z;
    record.vx = v.x, record.vy = v.y, record.vz = v.z;
}

// Appends the record's triangles to areas, the cumulative ones of all surface lights. Returns their sum [mm^2].
double add_areas(LightRecord& record, const std::vector<Triangle>& triangles, std::vector<float>& areas) {
    record.first_area = static_cast<std::uint32_t>(areas.size());
    double area = 0.0;
    for (std::uint32_t t = 0; t < record.triangle_count; ++t) {
        const Triangle& tri = triangles[record.first_triangle + t];
        area +=
            0.5 * glm::length(glm::cross(glm::dvec3(tri.e1x, tri.e1y, tri.e1z), glm::dvec3(tri.e2x, tri.e2y, tri.e2z)));
        areas.push_back(static_cast<float>(area));
    }
    return area;
}

// Of where its photons start.
void set_bounds(LightRecord& record, const EmissionBounds& bounds) {
    record.restricted = bounds.window || bounds.ball ? 1u : 0u;
    record.part = static_cast<float>(bounds.part);
    if (bounds.window) {
        const glm::vec3 t(bounds.window->centre_mm), u(bounds.window->half_u_mm), v(bounds.window->half_v_mm);
        record.tx = t.x, record.ty = t.y, record.tz = t.z;
        record.wux = u.x, record.wuy = u.y, record.wuz = u.z;
        record.wvx = v.x, record.wvy = v.y, record.wvz = v.z;
    }
    if (bounds.ball) {
        const glm::vec3 t(bounds.ball->centre_mm);
        record.tx = t.x, record.ty = t.y, record.tz = t.z;
        record.target_mm = static_cast<float>(bounds.ball->radius_mm);
    }
}

double product_of_half_axes(const Beam& beam) { return glm::length(beam.half_u_mm) * glm::length(beam.half_v_mm); }

}  // namespace

unsigned place_dimensions(const Light& light) {
    return std::visit(Overloaded{[](const SurfaceLight&) { return 4u; }, [](const Beam&) { return 2u; }}, light.kind);
}

LightTables light_tables(const Scene& scene, const std::vector<double>& probability,
                         const std::vector<EmissionBounds>& bounds, const std::vector<Triangle>& triangles,
                         const std::vector<std::uint32_t>& first_triangle) {
    LightTables tables;
    double cumulative = 0.0;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i];
        LightRecord record{};
        cumulative += probability[i];
        record.cumulative_probability = i + 1 == scene.lights.size() ? 1.0f : static_cast<float>(cumulative);
        record.dimensions = place_dimensions(light);
        set_bounds(record, bounds[i]);
        const auto surface = [&](const SurfaceLight& of) {
            const auto shape = static_cast<std::size_t>(of.shape);
            record.kind = STOKES_LIGHT_SURFACE;
            record.first_triangle = first_triangle[shape];
            record.triangle_count = first_triangle[shape + 1] - first_triangle[shape];
            set_ball(record, scene.shapes[shape].mesh);
            return M_PI * add_areas(record, triangles, tables.areas);
        };
        const auto disk = [&](const DiskBeam& beam) {
            record.kind = STOKES_LIGHT_BEAM_DISK;
            set_beam(record, beam);
            return M_PI * product_of_half_axes(beam);
        };
        const auto rectangle = [&](const RectangleBeam& beam) {
            record.kind = STOKES_LIGHT_BEAM_RECTANGLE;
            set_beam(record, beam);
            return 4.0 * product_of_half_axes(beam);
        };
        tables.spread.push_back(std::visit(Overloaded{surface, disk, rectangle}, light.kind));
        tables.records.push_back(record);
    }
    return tables;
}

}  // namespace stokes
