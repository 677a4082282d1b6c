#include "host/render/device_scene.hpp"

#include <algorithm>
#include <cmath>

#include "host/render/device_lights.hpp"
#include "host/render/device_materials.hpp"
#include "host/render/pass_spectra.hpp"
#include "host/render/radius.hpp"
#include "host/render/transport/transport_model.hpp"
#include "host/scene/mesh/mesh_topology.hpp"

namespace stokes {

namespace {

// Rays start this share of the scene's size off a surface: some tens of times the rounding of a coordinate.
constexpr double offset_share = 4e-6;

// Index of the body within which a thing lies whose light is followed there, else STOKES_NONE.
std::uint32_t walked_container(const Scene& scene, const Container& container) {
    const bool walked =
        container.whole && !transport_model(transport_of_body(scene, *container.whole)).takes_bodies_for_half_spaces();
    return walked ? static_cast<std::uint32_t>(*container.whole) : STOKES_NONE;
}

// Appends the contact regions of each body to regions.
std::vector<BodyRecord> body_records(const Scene& scene, const Contacts& contacts,
                                     std::vector<ContactRegion>& regions) {
    std::vector<BodyRecord> records(static_cast<std::size_t>(std::max(scene.body_count, 1)),
                                    BodyRecord{0, 0, STOKES_NONE, 0, 0, {}});
    const auto by_mesh = [&](int body) {
        return !transport_model(transport_of_body(scene, body)).takes_bodies_for_half_spaces();
    };
    const std::vector<BodyKind> walkable = check_walkable(scene, by_mesh);
    const std::vector<std::uint32_t> uses = uses_of_shapes(scene);
    for (std::size_t s = 0; s < scene.shapes.size(); ++s)
        records[static_cast<std::size_t>(scene.shapes[s].body)].material = uses[s];
    for (std::size_t body = 0; body < walkable.size(); ++body) {
        BodyRecord& record = records[body];
        if (walkable[body] == BodyKind::flat) record.flags |= STOKES_BODY_FLAT;
        if (contacts.touches[body]) record.flags |= STOKES_BODY_TOUCHES;
        if (contacts.solid[body]) record.flags |= STOKES_BODY_SOLID;
        if (contacts.holds[body]) record.flags |= STOKES_BODY_HOLLOW;
        record.first_region = static_cast<std::uint32_t>(regions.size());
        record.region_count = static_cast<std::uint32_t>(contacts.regions[body].size());
        for (const Bounds& box : contacts.regions[body]) {
            const glm::vec3 low(box.low_mm), high(box.high_mm);
            regions.push_back({low.x, low.y, low.z, high.x, high.y, high.z});
        }
        if (walkable[body] == BodyKind::closed)
            record.inside = walked_container(scene, container_of_body(scene, static_cast<int>(body)));
    }
    return records;
}

// Flags of the triangles of each shape that do not depend on the triangle.
std::uint32_t shape_flags(const Scene& scene, const Shape& shape, const Contacts& contacts) {
    const bool opaque = !medium_of(scene.materials[static_cast<std::size_t>(shape.material)]);
    return (shape.two_sided ? STOKES_TRIANGLE_TWO_SIDED : 0u) | (opaque ? STOKES_TRIANGLE_OPAQUE : 0u) |
           (shape.light >= 0 ? STOKES_TRIANGLE_EMITTER : 0u) |
           (contacts.solid[static_cast<std::size_t>(shape.body)] ? STOKES_TRIANGLE_SOLID : 0u);
}

}  // namespace

std::vector<Triangle> scene_triangles(const Scene& scene, const Contacts& contacts) {
    std::vector<Triangle> triangles;
    for (std::size_t s = 0; s < scene.shapes.size(); ++s) {
        const Shape& shape = scene.shapes[s];
        const std::uint32_t flags = shape_flags(scene, shape, contacts);
        for (const glm::uvec3& t : shape.mesh.triangles) {
            const glm::vec3 a = shape.mesh.positions_mm[t.x];
            const glm::vec3 e1 = shape.mesh.positions_mm[t.y] - a, e2 = shape.mesh.positions_mm[t.z] - a;
            const bool contested = contacts.contested[triangles.size()];
            triangles.push_back({a.x, a.y, a.z, static_cast<std::uint32_t>(s), e1.x, e1.y, e1.z,
                                 static_cast<std::uint32_t>(shape.body), e2.x, e2.y, e2.z,
                                 flags | (contested ? STOKES_TRIANGLE_CONTESTED : 0u)});
        }
    }
    return triangles;
}

double ray_offset_mm(const Scene& scene) {
    const SceneExtent extent = scene_extent(scene);
    const glm::dvec3 farthest = glm::max(glm::abs(extent.minimum), glm::abs(extent.maximum));
    return offset_share * std::max({farthest.x, farthest.y, farthest.z});
}

DeviceScene::DeviceScene(const Device& device, const Scene& scene) {
    const double offset = ray_offset_mm(scene);
    const Contacts contacts = find_contacts(scene, offset);
    has_contacts = contacts.any_touch;
    has_contested = contacts.any_contested;
    const std::vector<Triangle> all = scene_triangles(scene, contacts);
    std::vector<std::uint32_t> first_triangle{0};
    std::vector<ShapeRecord> shape_records;
    const std::vector<std::uint32_t> uses = uses_of_shapes(scene);
    for (const Shape& shape : scene.shapes) {
        first_triangle.push_back(first_triangle.back() + static_cast<std::uint32_t>(shape.mesh.triangles.size()));
        shape_records.push_back(
            {uses[shape_records.size()], shape.light < 0 ? STOKES_NONE : static_cast<std::uint32_t>(shape.light)});
    }
    rays = RayScene(device, all);
    triangles = Buffer<Triangle>(device, "triangles", all);
    shapes = Buffer<ShapeRecord>(device, "shapes", shape_records);
    const std::vector<MaterialRecord> records = material_records(scene);
    materials = Buffer<MaterialRecord>(device, "materials", records);
    textures = upload_textures(device, scene);

    const std::vector<EmissionBounds> bounds = emission_bounds(scene);
    light_probability = light_probabilities(scene);
    set_emitted_part(bounds);
    LightTables tables_of_lights = light_tables(scene, light_probability, bounds, all, first_triangle);
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        tables_of_lights.records[i].inside = walked_container(scene, container_of_light(scene, scene.lights[i]));
    lights = Buffer<LightRecord>(device, "lights", tables_of_lights.records);
    light_areas = Buffer<float>(device, "light areas", tables_of_lights.areas);
    light_spread = tables_of_lights.spread;
    light_count = static_cast<std::uint32_t>(scene.lights.size());
    has_mirrors = std::any_of(records.begin(), records.end(), may_mirror);
    std::vector<ContactRegion> regions;
    bodies = Buffer<BodyRecord>(device, "bodies", body_records(scene, contacts, regions));
    if (regions.empty()) regions.emplace_back();
    contact_regions = Buffer<ContactRegion>(device, "contact regions", regions);

    const SceneExtent extent = scene_extent(scene);
    minimum_mm = glm::vec3(extent.minimum);
    maximum_mm = glm::vec3(extent.maximum);
    offset_mm = static_cast<float>(offset);
}

// Each light has photons for what it emits within its bounds.
void DeviceScene::set_emitted_part(const std::vector<EmissionBounds>& bounds) {
    const auto whole = [](const EmissionBounds& of) { return of.part == 1.0; };
    if (std::all_of(bounds.begin(), bounds.end(), whole)) return;
    emitted_part = 0.0;
    for (std::size_t i = 0; i < bounds.size(); ++i) emitted_part += light_probability[i] * bounds[i].part;
    for (std::size_t i = 0; i < bounds.size(); ++i) light_probability[i] *= bounds[i].part / emitted_part;
}

Arguments DeviceScene::arguments() const {
    return rays.arguments()
        .add("triangles", triangles)
        .add("shapes", shapes)
        .add("materials", materials)
        .add(textures.arguments())
        .add("light_count", light_count)
        .add("lights", lights)
        .add("light_areas", light_areas)
        .add("bodies", bodies)
        .add("contact_regions", contact_regions);
}

}  // namespace stokes
