#include "host/render/device_scene.hpp"

#include <cmath>
#include <numeric>

#include "host/render/pass_spectra.hpp"
#include "host/render/radius.hpp"
#include "host/scene/bvh_builder.hpp"
#include "host/subsurface/distance_sampler.hpp"

namespace stokes {

namespace {

// Rays start this share of the scene's size off a surface: some tens of times the rounding of a coordinate.
constexpr double offset_share = 4e-6;

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more) {
    to.insert(to.end(), more.begin(), more.end());
}

std::vector<MaterialRecord> material_records(const Scene& scene) {
    const SpectraLayout layout(scene);
    std::vector<MaterialRecord> records;
    for (const Material& material : scene.materials) {
        MaterialRecord record{};
        record.kind = material.kind == MaterialKind::diffuse       ? STOKES_DIFFUSE
                      : material.kind == MaterialKind::translucent ? STOKES_TRANSLUCENT
                                                                   : STOKES_BLACK;
        const bool subsurface = material.kind == MaterialKind::translucent && material.subsurface;
        record.medium = subsurface ? static_cast<std::uint32_t>(material.medium) : STOKES_NONE;
        record.fluorescent_fraction = static_cast<float>(material.fluorescent_fraction);
        record.eta = subsurface ? static_cast<float>(scene.media[static_cast<std::size_t>(material.medium)].eta) : 1.0f;
        const bool fluorescent = material.fluorophore >= 0;
        record.excitation_row = fluorescent ? layout.excitation_row(material.fluorophore) : STOKES_NONE;
        record.reradiation_row = fluorescent ? layout.reradiation_row(material.fluorophore) : STOKES_NONE;
        records.push_back(record);
    }
    return records;
}

DeviceTables upload_tables(const Device& device, const Scene& scene) {
    std::vector<bool> needed(scene.media.size(), false);
    for (const Material& material : scene.materials)
        if (material.kind == MaterialKind::translucent && material.subsurface)
            needed[static_cast<std::size_t>(material.medium)] = true;
    std::vector<TableShape> shapes;
    std::vector<float> values, mean_rows, cumulative_rows;
    DeviceTables result;
    for (std::size_t m = 0; m < scene.media.size(); ++m) {
        if (!needed[m]) {
            shapes.insert(shapes.end(), 3, TableShape{});
            continue;
        }
        const Medium& medium = scene.media[m];
        const MediumSpectra spectra{medium.name, medium.sigma_s, medium.sigma_a, medium.eta, medium.dipole_eta};
        for (const PowerTable& table :
             {make_fluorescence_table(spectra), make_single_table(spectra), make_multiple_table(spectra)}) {
            const DistanceSampler sampler = make_distance_sampler(table, mean_rows.size());
            result.wavelengths = device_wavelengths(table);
            shapes.push_back(sampler.shape);
            append(values, device_layout(table));
            append(mean_rows, sampler.mean_rows);
            append(cumulative_rows, sampler.cumulative_rows);
        }
    }
    result.entries = static_cast<std::uint32_t>(mean_rows.size());
    result.shapes = Buffer<TableShape>(device, "power table shapes", shapes);
    result.values = Buffer<float>(device, "power tables", values);
    result.mean_rows = Buffer<float>(device, "distance densities", mean_rows);
    result.cumulative_rows = Buffer<float>(device, "distance distributions", cumulative_rows);
    result.at_wavelengths = Buffer<Flux16>(device, "power tables of the pass", result.entries);
    return result;
}

struct LightTables {
    std::vector<LightRecord> records;
    std::vector<float> areas;
    std::vector<double> surface_area_mm2;
};

// first_triangle: of each shape in the Triangle buffer.
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
            const glm::vec3 p(light.position_mm), d(glm::normalize(light.direction)), u(light.half_u_mm), v(light.half_v_mm);
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

}  // namespace

std::vector<Triangle> scene_triangles(const Scene& scene) {
    std::vector<Triangle> triangles;
    for (std::size_t s = 0; s < scene.shapes.size(); ++s) {
        const Shape& shape = scene.shapes[s];
        for (const glm::uvec3& t : shape.mesh.triangles) {
            const glm::vec3 a = shape.mesh.positions_mm[t.x];
            const glm::vec3 e1 = shape.mesh.positions_mm[t.y] - a, e2 = shape.mesh.positions_mm[t.z] - a;
            triangles.push_back({a.x, a.y, a.z, static_cast<std::uint32_t>(s), e1.x, e1.y, e1.z,
                                 static_cast<std::uint32_t>(shape.body), e2.x, e2.y, e2.z, 0});
        }
    }
    return triangles;
}

DeviceScene::DeviceScene(const Device& device, const Scene& scene) {
    const std::vector<Triangle> all = scene_triangles(scene);
    std::vector<std::uint32_t> first_triangle{0};
    std::vector<ShapeRecord> shape_records;
    for (const Shape& shape : scene.shapes) {
        first_triangle.push_back(first_triangle.back() + static_cast<std::uint32_t>(shape.mesh.triangles.size()));
        shape_records.push_back({static_cast<std::uint32_t>(shape.material),
                                 shape.light < 0 ? STOKES_NONE : static_cast<std::uint32_t>(shape.light)});
    }
    const Bvh bvh = build_bvh(all);
    grid = bvh.grid;
    nodes = Buffer<BvhNode>(device, "bounding volumes", bvh.nodes);
    blocks = Buffer<BvhBlock>(device, "triangle blocks", bvh.blocks);
    triangles = Buffer<Triangle>(device, "triangles", all);
    shapes = Buffer<ShapeRecord>(device, "shapes", shape_records);
    materials = Buffer<MaterialRecord>(device, "materials", material_records(scene));

    light_probability = light_probabilities(scene);
    const LightTables tables_of_lights = light_tables(scene, light_probability, all, first_triangle);
    lights = Buffer<LightRecord>(device, "lights", tables_of_lights.records);
    light_areas = Buffer<float>(device, "light areas", tables_of_lights.areas);
    light_surface_area_mm2 = tables_of_lights.surface_area_mm2;
    light_count = static_cast<std::uint32_t>(scene.lights.size());
    tables = upload_tables(device, scene);

    const SceneExtent extent = scene_extent(scene);
    minimum_mm = glm::vec3(extent.minimum);
    maximum_mm = glm::vec3(extent.maximum);
    const glm::dvec3 farthest = glm::max(glm::abs(extent.minimum), glm::abs(extent.maximum));
    offset_mm = static_cast<float>(offset_share * std::max({farthest.x, farthest.y, farthest.z}));
}

}  // namespace stokes
