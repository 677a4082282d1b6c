#include "host/scene/readers/shape_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/scene/mesh/mesh.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "host/scene/readers/input_files.hpp"
#include "host/scene/readers/mask.hpp"
#include "host/scene/readers/material_reader.hpp"
#include "host/scene/readers/mesh_materials.hpp"
#include "host/scene/readers/mesh_reader.hpp"
#include "host/scene/readers/picture.hpp"
#include "host/scene/settings/object.hpp"

namespace stokes {
namespace {

constexpr NumberRange scale_range{-1e9, 1e9};
constexpr int most_sectors = 360;

double nonzero_scale(const JsonCursor& where) {
    const double factor = where.number(scale_range);
    if (std::abs(factor) < 1e-9) where.fail_expected("a scale other than zero");
    return factor;
}

glm::dmat4 read_step(const JsonCursor& place) {
    const ObjectReader where(place, "transform");
    const glm::dmat4 identity(1.0);
    if (where.kind() == "transform_scale") {
        const JsonCursor scale = where.at("scale");
        if (!scale.is(JsonValue::Type::array)) return glm::scale(identity, glm::dvec3(nonzero_scale(scale)));
        const glm::dvec3 factors = scale.vector(scale_range);
        for (const JsonCursor& factor : scale.items()) nonzero_scale(factor);
        return glm::scale(identity, factors);
    }
    if (where.kind() == "transform_rotate") {
        return glm::rotate(identity, glm::radians(where.number("angle_deg")), where.direction("rotate_axis"));
    }
    if (where.kind() == "transform_translate") return glm::translate(identity, where.vector("translate_mm"));
    where.fail_unread();
}

glm::dmat4 read_transform(const JsonCursor& shape) {
    glm::dmat4 result(1.0);
    const auto transform = shape.find("transform");
    if (!transform) return result;
    for (const JsonCursor& step : transform->items()) result = read_step(step) * result;
    return result;
}

struct ShapeFiles {
    explicit ShapeFiles(const std::filesystem::path& folder) : meshes(folder), pictures(folder) {}
    InputFiles<FileMesh, read_mesh> meshes;
    InputFiles<Picture, read_picture> pictures;
};

Mesh read_mask(const ObjectReader& where, ShapeFiles& files) {
    const JsonCursor file = where.at("file");
    MaskTexels texels;
    texels.threshold = where.number("threshold");
    texels.invert = where.boolean("invert");
    const double width = where.number("width_mm"), height = where.number("height_mm");
    const Picture& picture = files.pictures.read(file);
    try {
        return make_mask(picture, width, height, texels);
    } catch (const InputError& error) {
        file.fail(error.what());
    }
}

// Of all kinds but those from mesh files.
Mesh make_mesh(const ObjectReader& where, ShapeFiles& files) {
    const std::string& kind = where.kind();
    if (kind == "shape_box") return make_box(where.vector("size_mm"));
    if (kind == "shape_sphere") return make_sphere(where.number("radius_mm"), where.integer("segments"));
    if (kind == "shape_rectangle") return make_rectangle(where.number("width_mm"), where.number("height_mm"));
    if (kind == "shape_disk") return make_disk(where.number("radius_mm"), where.integer("segments"));
    if (kind == "shape_prism")
        return make_prism(where.integer("sides"), where.number("radius_mm"), where.number("height_mm"));
    if (kind == "shape_cylinder")
        return make_cylinder(where.number("radius_mm"), where.number("height_mm"), where.integer("segments"));
    if (kind == "shape_mask") return read_mask(where, files);
    where.fail_unread();
}

const Material& material_of(const Scene& scene, int material) {
    return scene.materials[static_cast<std::size_t>(material)];
}

// Light from below the surface of one part leaves through the others too.
std::vector<int> read_part_materials(const JsonCursor& where, const Scene& scene) {
    const std::vector<JsonCursor> items = where.items();
    if (items.empty()) where.fail_expected("one or more names of materials");
    std::vector<int> materials;
    const auto is_translucent = [&](int m) { return medium_of(material_of(scene, m)).has_value(); };
    for (const JsonCursor& item : items) {
        materials.push_back(index_of_name(item, "materials", scene.materials));
        if (is_translucent(materials.back()) != is_translucent(materials.front()))
            item.fail(
                fmt::format("expected materials all with light below their surfaces or all without, got \"{}\" and "
                            "\"{}\"",
                            material_of(scene, materials.front()).name, item.text()));
    }
    return materials;
}

std::vector<Mesh> read_parts(const ObjectReader& where, std::size_t material_count) {
    const JsonCursor materials = where.at("materials");
    const auto parts = static_cast<int>(material_count);
    if (where.kind() == "shape_tiles") {
        const int columns = where.integer("columns"), rows = where.integer("rows");
        const glm::dvec3 size = where.vector("size_mm");
        if (parts >= columns + rows)
            materials.fail_expected(
                fmt::format("at most {} materials for {} x {} tiles", columns + rows - 1, columns, rows));
        return make_tiles(size, columns, rows, parts);
    }
    if (where.kind() != "shape_sectors") where.fail_unread();
    if (parts > most_sectors) materials.fail_expected(fmt::format("at most {} materials", most_sectors));
    return make_sectors(where.number("radius_mm"), where.number("height_mm"), parts, where.integer("segments"),
                        where.number("start_deg"));
}

// Shapes of several materials: one shape of the scene for each, of one body.
void read_compound(const ObjectReader& where, const std::string& name, Scene& scene, Placement& placement) {
    const std::vector<int> materials = read_part_materials(where.at("materials"), scene);
    const std::vector<Mesh> parts = read_parts(where, materials.size());
    const glm::dmat4 transform = read_transform(where);
    const int body = scene.body_count++;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Shape shape;
        shape.name = fmt::format("{} ({})", name, material_of(scene, materials[i]).name);
        shape.material = materials[i];
        shape.body = body;
        placement.add(where, std::move(shape), parts[i], transform);
    }
}

// Bodies are numbered as they appear; a shape without the key has one of its own. materials: body and material of the
// shapes before.
int read_body(const JsonCursor& shape, int material, Scene& scene, std::map<std::string, int>& bodies,
              std::vector<std::pair<int, int>>& materials) {
    const auto body = shape.find("body");
    if (!body) return scene.body_count++;
    const auto [entry, is_new] = bodies.emplace(body->name(), scene.body_count);
    if (is_new) ++scene.body_count;
    for (const auto& [other_body, other] : materials) {
        if (other_body != entry->second || other == material) continue;
        body->fail(fmt::format("expected one material in a body, got \"{}\" and \"{}\"", material_of(scene, other).name,
                               material_of(scene, material).name));
    }
    materials.emplace_back(entry->second, material);
    return entry->second;
}

// A mesh whose file names materials: one shape of the scene for each of the scene's materials.
void read_materials_of_mesh(const ObjectReader& where, const std::string& name, const FileMesh& mesh, Scene& scene,
                            Placement& placement) {
    for (MaterialPart& part : read_material_parts(where, mesh, scene)) {
        Shape shape;
        shape.name = fmt::format("{} ({})", name, material_of(scene, part.material).name);
        shape.material = part.material;
        shape.body = part.body;
        placement.add(where, std::move(shape), std::move(part.mesh), read_transform(where), true);
    }
}

// A mesh file, its remarks said.
const FileMesh& read_file_mesh(const ObjectReader& where, const std::string& name, ShapeFiles& files) {
    const FileMesh& mesh = files.meshes.read(where.at("file"));
    for (const std::string& remark : mesh.remarks)
        warn(fmt::format("{}: {} ({}): {}", where.file(), where.path(), name, remark));
    if (!where.has("material") && !where.has("materials")) where.fail("missing key \"material\"");
    return mesh;
}

}  // namespace

void read_shapes(const JsonCursor& shapes, const std::filesystem::path& folder, Scene& scene, Placement& placement) {
    ShapeFiles files(folder);
    std::map<std::string, int> bodies;
    std::vector<std::pair<int, int>> materials;  // body and material of each shape of one material
    std::vector<std::string> names;
    for (const JsonCursor& place : shapes.items()) {
        const ObjectReader where(place, "shape");
        const std::string name = read_own_name(where, fmt::format("shape {}", names.size()), names);
        names.push_back(name);
        const FileMesh* file = where.kind() == "shape_mesh" ? &read_file_mesh(where, name, files) : nullptr;
        if (where.has("materials")) {
            if (file != nullptr)
                read_materials_of_mesh(where, name, *file, scene, placement);
            else
                read_compound(where, name, scene, placement);
            continue;
        }
        Shape shape;
        shape.name = name;
        shape.material = index_of_name(where.at("material"), "materials", scene.materials);
        shape.two_sided = where.kind() == "shape_mask";
        if (shape.two_sided && as_translucent(material_of(scene, shape.material)) != nullptr)
            where.at("material").fail("expected a black or diffuse material for a mask, got a translucent one");
        shape.body = read_body(where, shape.material, scene, bodies, materials);
        if (file != nullptr) {
            warn_of_one_material(where, name, *file, material_of(scene, shape.material));
            placement.add(where, std::move(shape), *file, read_transform(where), true);
        } else {
            placement.add(where, std::move(shape), make_mesh(where, files), read_transform(where));
        }
    }
}

std::string read_own_name(const JsonCursor& where, const std::string& fallback, const std::vector<std::string>& taken) {
    const auto name = where.find("name");
    if (!name) return fallback;
    if (std::find(taken.begin(), taken.end(), name->name()) == taken.end()) return name->name();
    name->fail(fmt::format("the name \"{}\" given twice", name->name()));
}

}  // namespace stokes
