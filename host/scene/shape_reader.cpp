#include "host/scene/shape_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <new>

#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/scene/material_reader.hpp"
#include "host/scene/mesh.hpp"
#include "host/scene/mesh_reader.hpp"
#include "host/scene/shapes.hpp"
#include "host/scene/spectrum_reader.hpp"

namespace stokes {
namespace {

constexpr NumberRange scale_range{-1e9, 1e9};
constexpr NumberRange angle_range{-1e6, 1e6};

double length(const JsonCursor& where, const char* key) {
    return where.at(key).number(length_range);
}

int segments(const JsonCursor& where) {
    return static_cast<int>(where.integer_or("segments", default_segments, 4, 2048));
}

double nonzero_scale(const JsonCursor& where) {
    const double factor = where.number(scale_range);
    if (std::abs(factor) < 1e-9) where.fail_expected("a scale other than zero");
    return factor;
}

glm::dmat4 read_step(const JsonCursor& where) {
    const std::string kind = where.one_of({"scale", "rotate_axis", "translate_mm"});
    const glm::dmat4 identity(1.0);
    if (kind == "scale") {
        where.expect_keys(keys::transform_scale);
        const JsonCursor scale = where.at("scale");
        if (!scale.is(JsonValue::Type::array)) return glm::scale(identity, glm::dvec3(nonzero_scale(scale)));
        const glm::dvec3 factors = scale.vector(scale_range);
        for (const JsonCursor& factor : scale.items()) nonzero_scale(factor);
        return glm::scale(identity, factors);
    }
    if (kind == "rotate_axis") {
        where.expect_keys(keys::transform_rotate);
        const double angle_deg = where.at("angle_deg").number(angle_range);
        return glm::rotate(identity, glm::radians(angle_deg), where.at("rotate_axis").direction());
    }
    where.expect_keys(keys::transform_translate);
    return glm::translate(identity, where.at("translate_mm").vector());
}

glm::dmat4 read_transform(const JsonCursor& shape) {
    glm::dmat4 result(1.0);
    const auto transform = shape.find("transform");
    if (!transform) return result;
    for (const JsonCursor& step : transform->items()) result = read_step(step) * result;
    return result;
}

// Meshes by path, so that a file used twice is read once.
class MeshFiles {
  public:
    explicit MeshFiles(const std::filesystem::path& folder) : folder_(folder) {}

    const Mesh& read(const JsonCursor& file) {
        const std::string path = scene_path(folder_, file.text());
        const auto found = meshes_.find(path);
        if (found != meshes_.end()) return found->second;
        try {
            return meshes_.emplace(path, read_mesh(path)).first->second;
        } catch (const InputError& error) {
            file.fail(error.what());
        } catch (const std::bad_alloc&) {
            file.fail(path + ": this mesh is too large for the memory");
        }
    }

  private:
    const std::filesystem::path& folder_;
    std::map<std::string, Mesh> meshes_;
};

Mesh read_round_shape(const JsonCursor& where, std::size_t type) {
    if (type == 2) {
        where.expect_keys(keys::shape_sphere);
        return make_sphere(length(where, "radius_mm"), segments(where));
    }
    if (type == 4) {
        where.expect_keys(keys::shape_disk);
        return make_disk(length(where, "radius_mm"), segments(where));
    }
    where.expect_keys(keys::shape_cylinder);
    return make_cylinder(length(where, "radius_mm"), length(where, "height_mm"), segments(where));
}

Mesh read_shape_mesh(const JsonCursor& where, MeshFiles& files) {
    const auto type =
        where.at("type").choice({"mesh", "box", "sphere", "rectangle", "disk", "prism", "cylinder"});
    switch (type) {
        case 0:
            where.expect_keys(keys::shape_mesh);
            return files.read(where.at("file"));
        case 1:
            where.expect_keys(keys::shape_box);
            return make_box(where.at("size_mm").vector(length_range));
        case 3:
            where.expect_keys(keys::shape_rectangle);
            return make_rectangle(length(where, "width_mm"), length(where, "height_mm"));
        case 5:
            where.expect_keys(keys::shape_prism);
            return make_prism(static_cast<int>(where.at("sides").integer(3, 2048)),
                              length(where, "radius_mm"), length(where, "height_mm"));
        default:
            return read_round_shape(where, type);
    }
}

// Bodies are numbered as they appear; a shape without the key has one of its own.
int read_body(const JsonCursor& shape, int material, Scene& scene, std::map<std::string, int>& bodies) {
    const auto body = shape.find("body");
    if (!body) return scene.body_count++;
    const auto [entry, is_new] = bodies.emplace(body->name(), scene.body_count);
    if (is_new) return scene.body_count++;
    for (const Shape& other : scene.shapes) {
        if (other.body != entry->second || other.material == material) continue;
        body->fail(fmt::format("expected one material in a body, got \"{}\" and \"{}\"",
                               scene.materials[static_cast<std::size_t>(other.material)].name,
                               scene.materials[static_cast<std::size_t>(material)].name));
    }
    return entry->second;
}

constexpr const char* too_small = "too small for single precision at this distance from the origin";

void warn_of_triangles(const JsonCursor& where, const std::string& name, std::size_t count,
                       const char* what) {
    if (count == 0) return;
    warn(fmt::format("{}: {} ({}): left out {} triangle{} {}", where.file(), where.path(), name, count,
                     count == 1 ? "" : "s", what));
}

}  // namespace

void read_shapes(const JsonCursor& shapes, const std::filesystem::path& folder, Scene& scene) {
    MeshFiles files(folder);
    std::map<std::string, int> bodies;
    std::vector<std::string> names;
    for (const JsonCursor& where : shapes.items()) {
        Shape shape;
        shape.mesh = read_shape_mesh(where, files);
        shape.name = read_own_name(where, fmt::format("shape {}", names.size()), names);
        names.push_back(shape.name);
        shape.material = index_of_name(where.at("material"), "materials", scene.materials);
        shape.body = read_body(where, shape.material, scene, bodies);
        add_shape(where, std::move(shape), read_transform(where), scene);
    }
}

int add_shape(const JsonCursor& where, Shape shape, const glm::dmat4& transform, Scene& scene) {
    const std::size_t flat_before = count_degenerate_triangles(shape.mesh);
    transform_mesh(shape.mesh, transform);
    for (const glm::vec3& position : shape.mesh.positions_mm) {
        for (int axis = 0; axis < 3; ++axis) {
            if (coordinate_range.contains(position[axis])) continue;
            where.fail(
                fmt::format("expected coordinates {} mm, got {}", coordinate_range.text(), position[axis]));
        }
    }
    const std::size_t dropped = drop_degenerate_triangles(shape.mesh);
    const std::size_t flat = std::min(flat_before, dropped);
    if (shape.mesh.triangles.empty()) {
        where.fail(flat < dropped ? fmt::format("expected a larger shape: {}", too_small)
                                  : "expected a triangle with an area, found none");
    }
    warn_of_triangles(where, shape.name, flat, "without area");
    warn_of_triangles(where, shape.name, dropped - flat, too_small);
    scene.shapes.push_back(std::move(shape));
    return static_cast<int>(scene.shapes.size()) - 1;
}

std::string read_own_name(const JsonCursor& where, const std::string& fallback,
                          const std::vector<std::string>& taken) {
    const auto name = where.find("name");
    if (!name) return fallback;
    if (std::find(taken.begin(), taken.end(), name->name()) == taken.end()) return name->name();
    name->fail(fmt::format("the name \"{}\" given twice", name->name()));
}

}  // namespace stokes
