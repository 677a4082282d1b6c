#include "host/scene/readers/mesh_materials.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/log.hpp"
#include "host/core/text_input.hpp"
#include "host/scene/mesh/material_parts.hpp"
#include "host/scene/readers/material_reader.hpp"

namespace stokes {
namespace {

std::string quoted(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(names.size(), 8); ++i)
        text += (i > 0 ? ", " : "") + (names[i].empty() ? "none" : "\"" + printable(names[i]) + "\"");
    return text + (names.size() > 8 ? ", ..." : "");
}

// The index in the scene's materials of each of the file's.
std::vector<int> materials_of_file(const ObjectReader& where, const FileMesh& mesh, const Scene& scene) {
    const JsonCursor given = where.at("materials");
    const auto fallback = where.find("material");
    const auto members = given.members();
    std::vector<int> materials;
    for (const std::string& name : mesh.materials) {
        const auto found =
            std::find_if(members.begin(), members.end(), [&](const auto& member) { return member.first == name; });
        if (found == members.end() && !fallback)
            given.fail(fmt::format("expected a material for {}, or the key \"material\" for all that are not named",
                                   name.empty() ? "the faces without usemtl" : "\"" + printable(name) + "\""));
        materials.push_back(
            index_of_name(found == members.end() ? *fallback : found->second, "materials", scene.materials));
    }
    for (const auto& [name, material] : members) {
        index_of_name(material, "materials", scene.materials);
        if (std::find(mesh.materials.begin(), mesh.materials.end(), name) != mesh.materials.end()) continue;
        const std::string closest = closest_name(name, mesh.materials);
        const bool has_none = mesh.materials == std::vector<std::string>{""};
        material.fail(fmt::format("the mesh has no material \"{}\"; {}", printable(name),
                                  closest.empty() ? "it has " + (has_none ? "none" : quoted(mesh.materials))
                                                  : "did you mean \"" + closest + "\"?"));
    }
    return materials;
}

}  // namespace

std::vector<MaterialPart> read_material_parts(const ObjectReader& where, const FileMesh& mesh, Scene& scene) {
    if (mesh.materials.empty())
        where.at("materials").fail("expected an OBJ file, which names the materials of its faces");
    if (const auto body = where.find("body")) body->fail("expected either this or \"materials\", got both");
    std::vector<int> used;  // each once
    std::vector<std::size_t> part_of_material;
    std::vector<bool> below_surface;
    for (const int material : materials_of_file(where, mesh, scene)) {
        const auto found = std::find(used.begin(), used.end(), material);
        part_of_material.push_back(static_cast<std::size_t>(found - used.begin()));
        if (found != used.end()) continue;
        used.push_back(material);
        below_surface.push_back(medium_of(scene.materials[static_cast<std::size_t>(material)]).has_value());
    }
    std::vector<FileMesh> meshes = split_mesh(mesh, part_of_material, used.size());
    const std::vector<std::size_t> first_of_body = joined_parts(meshes, below_surface);
    std::vector<MaterialPart> parts;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const int body = first_of_body[i] < i ? parts[first_of_body[i]].body : scene.body_count++;
        parts.push_back({std::move(meshes[i]), used[i], body});
    }
    return parts;
}

// Materials, objects and groups of a file that the shape does not tell apart.
void warn_of_one_material(const ObjectReader& where, const std::string& name, const FileMesh& mesh,
                          const Material& material) {
    const std::size_t things = std::max(mesh.objects, mesh.groups);
    const bool one_body = things > 1 && medium_of(material).has_value();
    if (mesh.materials.size() < 2 && !one_body) return;
    const std::string objects =
        things > 1 ? fmt::format("{} {}", things, mesh.objects >= mesh.groups ? "objects" : "groups") : "";
    const std::string materials = mesh.materials.size() > 1
                                      ? fmt::format("{} materials ({})", mesh.materials.size(), quoted(mesh.materials))
                                      : "";
    warn(fmt::format("{}: {} ({}): {}{}{} of the file become one body of material \"{}\"{}", where.file(), where.path(),
                     name, materials, materials.empty() || objects.empty() ? "" : " and ", objects, material.name,
                     materials.empty() ? "" : "; \"materials\" gives each its own"));
}

}  // namespace stokes
