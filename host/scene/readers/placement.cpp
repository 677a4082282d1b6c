#include "host/scene/readers/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <variant>

#include "host/core/log.hpp"
#include "host/scene/mesh/mesh.hpp"
#include "host/scene/mesh/orientation.hpp"
#include "host/scene/mesh/scene_origin.hpp"

namespace stokes {
namespace {

constexpr const char* too_small = "too small for single precision at this distance from the middle of the scene";

void warn_at(const JsonCursor& where, const std::string& name, const std::string& what) {
    warn(fmt::format("{}: {} ({}): {}", where.file(), where.path(), name, what));
}

// The eye is behind every triangle.
bool faces_away(const Mesh& mesh, const glm::dvec3& eye_mm) {
    return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const glm::uvec3& t) {
        return glm::dot(area_vector_mm2(mesh, t), eye_mm - glm::dvec3(mesh.positions_mm[t.x])) < 0.0;
    });
}

void warn_of_triangles(const JsonCursor& where, const std::string& name, std::size_t count, const char* what) {
    if (count == 0) return;
    warn_at(where, name, fmt::format("left out {} triangle{} {}", count, count == 1 ? "" : "s", what));
}

// Of the vertices that triangles use.
Bounds bounds_of(const FileMesh& mesh, const glm::dmat4& transform) {
    Bounds bounds;
    for (const glm::uvec3& triangle : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 placed(transform * glm::dvec4(mesh.positions[triangle[k]], 1.0));
            bounds.add(placed);
        }
    return bounds;
}

void check_range(const JsonCursor& where, const glm::dvec3& place, const glm::dvec3& origin_mm) {
    for (int axis = 0; axis < 3; ++axis) {
        if (coordinate_range.contains(place[axis])) continue;
        const std::string from = origin_mm == glm::dvec3(0.0) ? ""
                                                              : fmt::format(" from ({:.10g}, {:.10g}, {:.10g}) mm on",
                                                                            origin_mm.x, origin_mm.y, origin_mm.z);
        where.fail(fmt::format("expected coordinates {} mm{}, got {}", coordinate_range.text(), from, place[axis]));
    }
}

void move_camera(const JsonCursor& where, Camera& camera, const glm::dvec3& origin_mm) {
    camera.position_mm -= origin_mm;
    camera.target_mm -= origin_mm;
    check_range(where, camera.position_mm, origin_mm);
}

void move_beams(const std::vector<JsonCursor>& where, Scene& scene) {
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        std::visit(
            [&](auto& kind) {
                if constexpr (std::is_base_of_v<Beam, std::decay_t<decltype(kind)>>) {
                    kind.position_mm -= scene.origin_mm;
                    check_range(where[i], kind.position_mm, scene.origin_mm);
                }
            },
            scene.lights[i].kind);
}

std::vector<Mesh*> meshes_of(Scene& scene, int body) {
    std::vector<Mesh*> meshes;
    for (Shape& shape : scene.shapes)
        if (shape.body == body) meshes.push_back(&shape.mesh);
    return meshes;
}

}  // namespace

int Placement::add(const JsonCursor& where, Shape shape, FileMesh mesh, const glm::dmat4& transform, bool from_file) {
    shapes_.push_back({where, std::move(shape), std::move(mesh), transform, from_file});
    return static_cast<int>(shapes_.size()) - 1;
}

int Placement::add(const JsonCursor& where, Shape shape, const Mesh& mesh, const glm::dmat4& transform) {
    return add(where, std::move(shape), as_file_mesh(mesh), transform);
}

void Placement::settle(const JsonCursor& root, Scene& scene) {
    std::vector<Bounds> bounds;
    for (const Placed& placed : shapes_) bounds.push_back(bounds_of(placed.mesh, placed.transform));
    scene.origin_mm = scene_origin_mm(scene.camera, bounds);
    move_camera(root.at("camera"), scene.camera, scene.origin_mm);
    move_beams(root.at("lights").items(), scene);
    for (Placed& placed : shapes_) move_to_origin(placed, scene);
    turn_inside_out(scene);
}

void Placement::move_to_origin(Placed& placed, Scene& scene) const {
    const JsonCursor& where = placed.where;
    Shape& shape = placed.shape;
    const Material& material = scene.materials[static_cast<std::size_t>(shape.material)];
    const DiffuseMaterial* diffuse = as_diffuse(material);
    const bool textured = texture_of(material) != nullptr;
    if (!textured) placed.mesh.uv.clear();
    shape.texture_repeats = textured && placed.from_file && diffuse->wrap == TextureWrap::repeat;
    const std::size_t flat_before = count_flat_triangles(placed.mesh.positions, placed.mesh.triangles);
    glm::dmat4 transform = placed.transform;
    if (scene.origin_mm != glm::dvec3(0.0)) transform = glm::translate(glm::dmat4(1.0), -scene.origin_mm) * transform;
    shape.mesh = placed_mesh(placed.mesh, transform, shape.texture_repeats);
    placed.mesh = {};
    for (const glm::uvec3& triangle : shape.mesh.triangles)
        for (int k = 0; k < 3; ++k)
            check_range(where, glm::dvec3(shape.mesh.positions_mm[triangle[k]]), scene.origin_mm);
    if (textured && shape.mesh.uv.empty())
        where.fail(
            fmt::format("the texture of material \"{}\" needs a shape with coordinates: a rectangle, a disk or a "
                        "mesh with texture coordinates{}",
                        material.name, shape.mesh.uv_fault.empty() ? "" : " (" + shape.mesh.uv_fault + ")"));
    const std::size_t dropped = drop_degenerate_triangles(shape.mesh);
    const std::size_t flat = std::min(flat_before, dropped);
    if (shape.mesh.triangles.empty()) {
        where.fail(flat < dropped ? fmt::format("expected a larger shape: {}", too_small)
                                  : "expected a triangle with an area, found none");
    }
    warn_of_triangles(where, shape.name, flat, "without area");
    warn_of_triangles(where, shape.name, dropped - flat, too_small);
    settle_reversed_twins(placed, shape, material);
    scene.shapes.push_back(std::move(shape));
}

// Every face stored a second time, the other way round, is how some programs write sheets that have two sides.
void Placement::settle_reversed_twins(const Placed& placed, Shape& shape, const Material& material) const {
    if (!placed.from_file) return;
    const bool opaque = as_translucent(material) == nullptr;
    const Pairs pairs = drop_reversed_twins(shape.mesh, opaque && shape.light < 0);
    if (pairs.dropped) {
        shape.two_sided = true;
        warn_at(placed.where, shape.name,
                fmt::format("each of its faces is there twice, facing both ways: it has {} triangles that look alike "
                            "from both sides",
                            shape.mesh.triangles.size()));
    } else if (pairs.paired > 0) {
        warn_at(placed.where, shape.name,
                fmt::format("{} triangles lie in one place with others that face the other way; {}", pairs.paired,
                            opaque ? "which one is seen is by chance" : "a translucent body has no inside there"));
    }
}

// Which shapes are judged together: those of one body, and the open parts of one file, which may close each other. By
// shape: a body of its group.
std::vector<int> Placement::orientation_groups(Scene& scene) const {
    std::vector<int> groups;
    for (const Shape& shape : scene.shapes) groups.push_back(shape.body);
    for (std::size_t i = 1; i < shapes_.size(); ++i) {
        const auto same_file = [&](std::size_t j) {
            return shapes_[i].from_file && shapes_[j].from_file && scene.shapes[i].body != scene.shapes[j].body &&
                   shapes_[i].where.path() == shapes_[j].where.path();
        };
        const auto open = [&](std::size_t j) { return !is_closed(meshes_of(scene, scene.shapes[j].body)); };
        for (std::size_t j = 0; j < i; ++j) {
            if (!same_file(j) || !open(j) || !open(i)) continue;
            std::replace(groups.begin(), groups.end(), groups[i], groups[j]);
            break;
        }
    }
    return groups;
}

void Placement::turn_inside_out(Scene& scene) const {
    const std::vector<int> groups = orientation_groups(scene);
    std::vector<bool> done(static_cast<std::size_t>(scene.body_count), false);
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
        const Shape& shape = scene.shapes[i];
        const auto group = static_cast<std::size_t>(groups[i]);
        if (!shapes_[i].from_file || shape.two_sided || done[group]) continue;
        done[group] = true;
        std::vector<Mesh*> meshes;
        for (std::size_t j = 0; j < groups.size(); ++j)
            if (groups[j] == groups[i]) meshes.push_back(&scene.shapes[j].mesh);
        const Orientation found = turn_outward(meshes, scene.camera.position_mm);
        if (found.turned > 0)
            warn_at(shapes_[i].where, shape.name,
                    fmt::format("its closed surface faces inward: turned over {} triangle{}", found.turned,
                                found.turned == 1 ? "" : "s"));
        const auto away = [&](const Mesh* mesh) { return faces_away(*mesh, scene.camera.position_mm); };
        if (std::all_of(meshes.begin(), meshes.end(), away))
            warn_at(shapes_[i].where, shape.name, "all of it faces away from the camera, which sees its black back");
        const glm::dvec3 at = found.place_mm + scene.origin_mm;
        if (found.inconsistent > 0)
            warn_at(shapes_[i].where, shape.name,
                    fmt::format("its triangles do not all face one side: they change sides at {} edge{}, one at "
                                "({:.10g}, {:.10g}, {:.10g}) mm, and are black from behind",
                                found.inconsistent, found.inconsistent == 1 ? "" : "s", at.x, at.y, at.z));
    }
}

}  // namespace stokes
