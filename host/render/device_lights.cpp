#include "host/render/device_lights.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace

LightTables light_tables(const Scene& scene, const std::vector<double>& probability,
                         const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& first_triangle) {
    LightTables tables;
    double cumulative = 0.0;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i];
        LightRecord record{};
        cumulative += probability[i];
        record.cumulative_probability = i + 1 == scene.lights.size() ? 1.0f : static_cast<float>(cumulative);
        double area = 0.0;
        if (light.kind == LightKind::surface) {
            const auto shape = static_cast<std::size_t>(light.shape);
            set_ball(record, scene.shapes[shape].mesh);
            record.kind = STOKES_LIGHT_SURFACE;
            record.first_triangle = first_triangle[shape];
            record.triangle_count = first_triangle[shape + 1] - first_triangle[shape];
            record.first_area = static_cast<std::uint32_t>(tables.areas.size());
            for (std::uint32_t t = 0; t < record.triangle_count; ++t) {
                const Triangle& tri = triangles[record.first_triangle + t];
                area += 0.5 * glm::length(glm::cross(glm::dvec3(tri.e1x, tri.e1y, tri.e1z),
                                                     glm::dvec3(tri.e2x, tri.e2y, tri.e2z)));
                tables.areas.push_back(static_cast<float>(area));
            }
        } else {
            record.kind = light.section == BeamSection::disk ? STOKES_LIGHT_BEAM_DISK : STOKES_LIGHT_BEAM_RECTANGLE;
            const glm::vec3 p(light.position_mm), d(glm::normalize(light.direction)), u(light.half_u_mm),
                v(light.half_v_mm);
            record.px = p.x, record.py = p.y, record.pz = p.z;
            record.dx = d.x, record.dy = d.y, record.dz = d.z;
            record.ux = u.x, record.uy = u.y, record.uz = u.z;
            record.vx = v.x, record.vy = v.y, record.vz = v.z;
        }
        tables.records.push_back(record);
        tables.surface_area_mm2.push_back(area);
    }
    return tables;
}

}  // namespace stokes
