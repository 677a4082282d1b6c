#include "host/scene/mesh/file_mesh.hpp"

#include "host/scene/mesh/mesh.hpp"
#include "host/scene/mesh/polygon.hpp"

namespace stokes {
namespace {

// What the corners of a fan have: indices, or texture coordinates.
template <class Corner, class Triangle>
std::vector<Corner> corners_of(const std::vector<Triangle>& triangles, const FanOfMesh& fan) {
    std::vector<Corner> corners{triangles[fan.first][0], triangles[fan.first][1]};
    for (std::size_t i = 0; i < fan.count; ++i) corners.push_back(triangles[fan.first + i][2]);
    return corners;
}

}  // namespace

FileMesh as_file_mesh(const Mesh& mesh) {
    FileMesh result;
    for (const glm::vec3& p : mesh.positions_mm) result.positions.emplace_back(p);
    result.triangles = mesh.triangles;
    for (const auto& uv : mesh.uv) result.uv.push_back({glm::dvec2(uv[0]), glm::dvec2(uv[1]), glm::dvec2(uv[2])});
    result.uv_fault = mesh.uv_fault;
    return result;
}

Mesh placed_mesh(const FileMesh& from, const glm::dmat4& transform, bool repeats) {
    Mesh mesh;
    mesh.positions_mm.reserve(from.positions.size());
    for (const glm::dvec3& p : from.positions) mesh.positions_mm.emplace_back(transform * glm::dvec4(p, 1.0));
    mesh.triangles = from.triangles;
    mesh.uv_fault = from.uv_fault;
    for (std::array<glm::dvec2, 3> uv : from.uv) {
        // The same place of the picture, closer to zero, where single precision is finer.
        const glm::dvec2 whole = repeats ? glm::floor(glm::min(glm::min(uv[0], uv[1]), uv[2])) : glm::dvec2(0.0);
        for (glm::dvec2& corner : uv) corner -= whole;
        mesh.uv.push_back({glm::vec2(uv[0]), glm::vec2(uv[1]), glm::vec2(uv[2])});
    }
    if (glm::determinant(glm::dmat3(transform)) < 0.0) turn_over(mesh);
    return mesh;
}

std::vector<std::int64_t> cut_polygons(FileMesh& mesh, const std::vector<FanOfMesh>& fans) {
    std::vector<std::int64_t> crossing;
    std::vector<glm::uvec3> cut;
    std::vector<glm::dvec3> places;
    for (const FanOfMesh& fan : fans) {
        const auto corners = corners_of<std::uint32_t>(mesh.triangles, fan);
        places.clear();
        for (const std::uint32_t corner : corners) places.push_back(mesh.positions[corner]);
        if (cut_polygon(places, cut) == PolygonCut::crossing) crossing.push_back(fan.place);
        std::vector<glm::dvec2> uvs;
        if (!mesh.uv.empty()) uvs = corners_of<glm::dvec2>(mesh.uv, fan);
        for (std::size_t i = 0; i < fan.count; ++i)
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t corner = cut[i][k];
                mesh.triangles[fan.first + i][k] = corners[corner];
                if (!uvs.empty()) mesh.uv[fan.first + i][static_cast<std::size_t>(k)] = uvs[corner];
            }
    }
    return crossing;
}

}  // namespace stokes
