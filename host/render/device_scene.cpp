#include "host/render/device_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/render/device_lights.hpp"
#include "host/render/device_materials.hpp"
#include "host/render/green_resampler.hpp"
#include "host/render/green_walk.hpp"
#include "host/render/pass_spectra.hpp"
#include "host/render/radius.hpp"
#include "host/scene/mesh_topology.hpp"
#include "host/subsurface/distance_mixture.hpp"
#include "host/subsurface/distance_sampler.hpp"

namespace stokes {

namespace {

// Rays start this share of the scene's size off a surface: some tens of times the rounding of a coordinate.
constexpr double offset_share = 4e-6;

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more) {
    to.insert(to.end(), more.begin(), more.end());
}

// By index of Scene::media: some material has it below its surface.
std::vector<bool> needed_media(const Scene& scene) {
    std::vector<bool> needed(scene.media.size(), false);
    for (const Material& material : scene.materials)
        if (const auto medium = medium_of(material)) needed[static_cast<std::size_t>(*medium)] = true;
    return needed;
}

MediumSpectra spectra_of(const Medium& medium) {
    return {medium.name, medium.sigma_s, medium.sigma_a, medium.eta, medium.dipole_eta};
}

bool integrates(const Scene& scene) { return scene.render.transport == Transport::paper && !scene.render.tables; }

IntegratedMedia upload_integrated_media(const Device& device, const Scene& scene) {
    const std::vector<bool> needed = needed_media(scene);
    std::vector<DistanceMixture> mixtures(scene.media.size());
    std::vector<float> rows;
    for (std::size_t m = 0; m < scene.media.size(); ++m) {
        if (!needed[m]) continue;
        const MediumMixture mixture = make_medium_mixture(spectra_of(scene.media[m]), rows.size());
        mixtures[m] = mixture.record;
        append(rows, mixture.rows);
    }
    return {Buffer<DistanceMixture>(device, "distance mixtures", mixtures),
            Buffer<float>(device, "distance mixture rows", rows),
            Buffer<PassMedium>(device, "media of the pass", scene.media.size())};
}

DeviceTables upload_power_tables(const Device& device, const Scene& scene) {
    const std::vector<bool> needed = needed_media(scene);
    std::vector<TableShape> shapes;
    std::vector<float> values, mean_rows, cumulative_rows, weighted, weighted_cumulative;
    DeviceTables result;
    for (std::size_t m = 0; m < scene.media.size(); ++m) {
        if (!needed[m]) {
            shapes.insert(shapes.end(), 3, TableShape{});
            continue;
        }
        const MediumSpectra spectra = spectra_of(scene.media[m]);
        for (const PowerTable& table :
             {make_fluorescence_table(spectra), make_single_table(spectra), make_multiple_table(spectra)}) {
            const DistanceSampler sampler = make_distance_sampler(table, mean_rows.size());
            result.wavelengths = device_wavelengths(table);
            shapes.push_back(sampler.shape);
            append(values, device_layout(table));
            append(mean_rows, sampler.mean_rows);
            append(cumulative_rows, sampler.cumulative_rows);
            append(weighted, sampler.weighted_rows);
            append(weighted_cumulative, sampler.weighted_cumulative_rows);
        }
    }
    result.entries = static_cast<std::uint32_t>(mean_rows.size());
    append(mean_rows, weighted);
    append(cumulative_rows, weighted_cumulative);
    result.shapes = Buffer<TableShape>(device, "power table shapes", shapes);
    result.values = Buffer<float>(device, "power tables", values);
    result.mean_rows = Buffer<float>(device, "distance densities", mean_rows);
    result.cumulative_rows = Buffer<float>(device, "distance distributions", cumulative_rows);
    result.at_wavelengths = Buffer<Flux16>(device, "power tables of the pass", result.entries);
    return result;
}

// Room for the Green's function tables, which every pass makes anew.
DeviceTables reserve_green_tables(const Device& device, const Scene& scene) {
    std::vector<TableShape> shapes(std::max<std::size_t>(6 * scene.media.size(), 1), TableShape{});
    DeviceTables result;
    for (std::size_t m = 0; m < scene.media.size(); ++m) {
        const Medium& medium = scene.media[m];
        double least = std::numeric_limits<double>::infinity(), most = 0.0;
        for (int lambda = scene.render.lambda_min_nm; lambda <= scene.render.lambda_max_nm; ++lambda) {
            const double sigma_t = medium.sigma_s.at(lambda) + medium.sigma_a.at(lambda);
            least = std::min(least, sigma_t);
            most = std::max(most, sigma_t);
        }
        for (const bool fresnel : {false, true}) {
            const auto owned = [&](const Material& material) {
                return medium_of(material) == static_cast<int>(m) &&
                       reflects(material, Transport::conserving) == fresnel;
            };
            if (std::none_of(scene.materials.begin(), scene.materials.end(), owned)) continue;
            GreenOwner owner;
            owner.medium = static_cast<int>(m);
            owner.eta = fresnel ? medium.eta : 1.0;
            if (result.green_tables.count(owner.eta) == 0)
                result.green_tables[owner.eta] = green_table_for(device, owner.eta);
            owner.shape = green_medium_shape(result.green_tables[owner.eta], least, most, result.entries);
            owner.first_row = result.green_rows;
            result.entries += owner.shape.row_count * owner.shape.r_count;
            result.green_rows += owner.shape.row_count;
            for (std::size_t component = 0; component < 3; ++component)
                shapes[3 * (2 * m + (fresnel ? 1 : 0)) + component] = owner.shape;
            result.green.push_back(owner);
        }
    }
    const std::size_t entries = std::max<std::size_t>(result.entries, 1);
    result.shapes = Buffer<TableShape>(device, "power table shapes", shapes);
    result.mean_rows = Buffer<float>(device, "distance densities", entries);
    result.cumulative_rows = Buffer<float>(device, "distance distributions", entries);
    result.at_wavelengths = Buffer<Flux16>(device, "power tables of the pass", entries);
    return result;
}

// `walk` needs none, and `paper` need not have any; the kernels' arguments are there.
DeviceTables make_tables(const Device& device, const Scene& scene) {
    if (scene.render.transport == Transport::paper && !integrates(scene)) return upload_power_tables(device, scene);
    if (scene.render.transport == Transport::conserving) return reserve_green_tables(device, scene);
    return reserve_green_tables(device, Scene{});
}

std::vector<std::uint32_t> body_kinds(const Scene& scene) {
    std::vector<std::uint32_t> kinds(static_cast<std::size_t>(std::max(scene.body_count, 1)), STOKES_BODY_CLOSED);
    if (scene.render.transport != Transport::walk) return kinds;
    const std::vector<BodyKind> walkable = check_walkable(scene);
    for (std::size_t body = 0; body < walkable.size(); ++body)
        if (walkable[body] == BodyKind::flat) kinds[body] = STOKES_BODY_FLAT;
    return kinds;
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
                                 static_cast<std::uint32_t>(shape.body), e2.x, e2.y, e2.z, shape.two_sided ? 1u : 0u});
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
    rays = RayScene(device, all);
    triangles = Buffer<Triangle>(device, "triangles", all);
    shapes = Buffer<ShapeRecord>(device, "shapes", shape_records);
    materials = Buffer<MaterialRecord>(device, "materials", material_records(scene, scene.render.transport));
    textures = upload_textures(device, scene);

    light_probability = light_probabilities(scene);
    const LightTables tables_of_lights = light_tables(scene, light_probability, all, first_triangle);
    lights = Buffer<LightRecord>(device, "lights", tables_of_lights.records);
    light_areas = Buffer<float>(device, "light areas", tables_of_lights.areas);
    light_spread = tables_of_lights.spread;
    light_count = static_cast<std::uint32_t>(scene.lights.size());
    transport = scene.render.transport;
    tables = make_tables(device, scene);
    if (integrates(scene)) integrated = upload_integrated_media(device, scene);
    has_fresnel = std::any_of(scene.materials.begin(), scene.materials.end(),
                              [&](const Material& material) { return reflects(material, scene.render.transport); });
    bodies = Buffer<std::uint32_t>(device, "bodies", body_kinds(scene));

    const SceneExtent extent = scene_extent(scene);
    minimum_mm = glm::vec3(extent.minimum);
    maximum_mm = glm::vec3(extent.maximum);
    const glm::dvec3 farthest = glm::max(glm::abs(extent.minimum), glm::abs(extent.maximum));
    offset_mm = static_cast<float>(offset_share * std::max({farthest.x, farthest.y, farthest.z}));
}

}  // namespace stokes
