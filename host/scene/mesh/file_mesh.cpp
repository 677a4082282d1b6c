#include "host/scene/mesh/file_mesh.hpp"

#include <algorithm>
#include <functional>
#include <utility>

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

std::vector<glm::dvec3> places_of(const FileMesh& mesh, const std::vector<std::uint32_t>& corners) {
    std::vector<glm::dvec3> places;
    for (const std::uint32_t corner : corners) places.push_back(mesh.positions[corner]);
    return places;
}

// Polygons that lie in one place and face opposite ways: the later one of two is cut as the earlier one is, so that
// their triangles lie in one place too.
class ReversedPolygons {
  public:
    ReversedPolygons(const FileMesh& mesh, const std::vector<FanOfMesh>& fans) : cuts_(fans.size()) {
        std::vector<std::pair<std::size_t, std::size_t>> by_hash;
        for (std::size_t f = 0; f < fans.size(); ++f)
            by_hash.emplace_back(hash_of(places_of(mesh, corners_of<std::uint32_t>(mesh.triangles, fans[f]))), f);
        std::sort(by_hash.begin(), by_hash.end());
        for (std::size_t i = 1, first = 0; i < by_hash.size(); ++i) {
            if (by_hash[i].first != by_hash[first].first) first = i;
            if (first == i) continue;
            cuts_[by_hash[i].second].first = by_hash[first].second;
            cuts_[by_hash[first].second].kept = true;
        }
    }

    // Of a polygon, in their order.
    void settle(std::size_t polygon, const std::vector<glm::dvec3>& places, std::vector<glm::uvec3>& cut) {
        Cut& own = cuts_[polygon];
        if (own.kept) {
            own.places = places;
            own.triangles = cut;
        }
        if (own.first == none) return;
        const Cut& first = cuts_[own.first];
        const std::size_t n = places.size();
        if (first.places.size() != n) return;
        for (std::size_t shift = 0; shift < n; ++shift) {
            const auto other = [&](std::size_t corner) { return (shift + n - corner) % n; };
            bool same = true;
            for (std::size_t k = 0; same && k < n; ++k) same = places[k] == first.places[other(k)];
            if (!same) continue;
            for (std::size_t i = 0; i < cut.size(); ++i) {
                const glm::uvec3& t = first.triangles[i];
                cut[i] = glm::uvec3(other(t.x), other(t.z), other(t.y));
            }
            return;
        }
    }

  private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    struct Cut {
        std::size_t first = none;  // a polygon before this one that may be in its place
        bool kept = false;         // some polygon has this one for its first
        std::vector<glm::dvec3> places = {};
        std::vector<glm::uvec3> triangles = {};
    };

    // Whatever their order.
    static std::size_t hash_of(const std::vector<glm::dvec3>& places) {
        std::size_t sum = 0;
        for (const glm::dvec3& p : places) {
            std::size_t hash = 0;
            for (int axis = 0; axis < 3; ++axis)  // 0.0 and -0.0 have one hash
                hash = (hash ^ std::hash<double>()(p[axis])) * 0x100000001b3u + (hash >> 29);
            sum += hash;
        }
        return sum;
    }

    std::vector<Cut> cuts_;
};

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
    ReversedPolygons reversed(mesh, fans);
    for (std::size_t f = 0; f < fans.size(); ++f) {
        const FanOfMesh& fan = fans[f];
        const auto corners = corners_of<std::uint32_t>(mesh.triangles, fan);
        const std::vector<glm::dvec3> places = places_of(mesh, corners);
        if (cut_polygon(places, cut) == PolygonCut::crossing) crossing.push_back(fan.place);
        reversed.settle(f, places, cut);
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
