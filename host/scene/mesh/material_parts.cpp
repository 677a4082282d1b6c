#include "host/scene/mesh/material_parts.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace stokes {
namespace {

using Place = std::tuple<double, double, double>;

// An edge where a part ends, by its ends in order.
struct RimEdge {
    Place low, high;
    std::size_t part;
    bool forward;  // from low to high
};

// Edges that the part's triangles do not pass equally often both ways.
std::vector<RimEdge> rim_of(const FileMesh& mesh, std::size_t part) {
    std::vector<RimEdge> sides;
    for (const glm::uvec3& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 &a = mesh.positions[t[k]], &b = mesh.positions[t[(k + 1) % 3]];
            const Place from(a.x, a.y, a.z), to(b.x, b.y, b.z);
            if (from != to) sides.push_back({std::min(from, to), std::max(from, to), part, from < to});
        }
    std::sort(sides.begin(), sides.end(), [](const RimEdge& a, const RimEdge& b) {
        return std::tie(a.low, a.high, a.forward) < std::tie(b.low, b.high, b.forward);
    });
    std::vector<RimEdge> rim;
    for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
        int balance = 0;
        for (; end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high; ++end)
            balance += sides[end].forward ? 1 : -1;
        if (balance != 0) rim.push_back({sides[begin].low, sides[begin].high, part, balance > 0});
    }
    return rim;
}

}  // namespace

std::vector<FileMesh> split_mesh(const FileMesh& mesh, const std::vector<std::size_t>& part_of_material,
                                 std::size_t parts) {
    std::vector<FileMesh> result(parts);
    for (FileMesh& part : result) part.uv_fault = mesh.uv_fault;
    std::vector<std::map<std::uint32_t, std::uint32_t>> moved(parts);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::size_t p = part_of_material[mesh.material.empty() ? 0 : mesh.material[i]];
        FileMesh& part = result[p];
        glm::uvec3 triangle = mesh.triangles[i];
        for (int k = 0; k < 3; ++k) {
            const auto [entry, is_new] =
                moved[p].emplace(triangle[k], static_cast<std::uint32_t>(part.positions.size()));
            if (is_new) part.positions.push_back(mesh.positions[triangle[k]]);
            triangle[k] = entry->second;
        }
        part.triangles.push_back(triangle);
        if (!mesh.uv.empty()) part.uv.push_back(mesh.uv[i]);
    }
    return result;
}

std::vector<std::size_t> joined_parts(const std::vector<FileMesh>& parts, const std::vector<bool>& may_join) {
    std::vector<std::size_t> first(parts.size());
    std::iota(first.begin(), first.end(), std::size_t{0});
    std::map<std::pair<Place, Place>, std::vector<RimEdge>> edges;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (!may_join[p]) continue;
        for (const RimEdge& edge : rim_of(parts[p], p)) edges[{edge.low, edge.high}].push_back(edge);
    }
    for (const auto& [ends, meeting] : edges)
        for (const RimEdge& a : meeting)
            for (const RimEdge& b : meeting) {
                const std::size_t from = std::max(first[a.part], first[b.part]),
                                  to = std::min(first[a.part], first[b.part]);
                if (a.forward == b.forward || from == to) continue;
                std::replace(first.begin(), first.end(), from, to);
            }
    return first;
}

}  // namespace stokes
