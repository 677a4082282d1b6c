#include "host/scene/mesh/mesh_topology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <limits>
#include <tuple>

#include "host/core/error.hpp"
#include "host/scene/mesh/mesh.hpp"

namespace stokes {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
// Vertices this many roundings of the largest coordinate apart are the same. The readers drop triangles that
// are less than one high.
constexpr double weld_roundings = 4.0;
// Mending a rim takes time with its square.
constexpr std::size_t largest_mended_rim = 10000;
// How far a flat sheet's vertices may lie off its plane, as a share of its size.
constexpr double flatness = 1e-5;

// The meshes of a body as one, vertices in the same place welded.
struct Surface {
    std::vector<glm::dvec3> points;
    std::vector<glm::uvec3> triangles;
    std::vector<glm::dvec3> area_vectors;  // of each triangle: its area times its normal [mm^2]
    double tolerance_mm = 0.0;
};

// A triangle's side in the triangle's direction.
struct Edge {
    std::uint32_t from, to, triangle;
};

// Indices of points, by their coordinates: a hash table with open addressing.
class Welder {
  public:
    explicit Welder(std::size_t points) {
        std::size_t size = 16;
        while (size < 2 * points) size *= 2;
        slots_.assign(size, none);
    }

    std::uint32_t index_of(const glm::vec3& point, std::vector<glm::dvec3>& points) {
        const glm::vec3 p = point + glm::vec3(0.0f);  // -0 becomes 0
        std::array<std::uint32_t, 3> bits{};
        std::memcpy(bits.data(), &p, sizeof bits);
        std::uint64_t hash = bits[0];
        for (const std::uint64_t word : {bits[1], bits[2]}) hash = (hash ^ (hash >> 29)) * 0x9e3779b97f4a7c15u + word;
        hash = (hash ^ (hash >> 32)) * 0x9e3779b97f4a7c15u;
        for (std::size_t slot = hash >> 32;; ++slot) {
            std::uint32_t& index = slots_[slot & (slots_.size() - 1)];
            if (index == none) {
                index = static_cast<std::uint32_t>(points.size());
                points.push_back(glm::dvec3(p));
                return index;
            }
            if (points[index] == glm::dvec3(p)) return index;
        }
    }

  private:
    std::vector<std::uint32_t> slots_;
};

Surface surface_of(const Scene& scene, int body) {
    std::size_t point_count = 0, triangle_count = 0;
    for (const Shape& shape : scene.shapes) {
        if (shape.body != body) continue;
        point_count += shape.mesh.positions_mm.size();
        triangle_count += shape.mesh.triangles.size();
    }
    Surface surface;
    surface.points.reserve(point_count);
    surface.triangles.reserve(triangle_count);
    surface.area_vectors.reserve(triangle_count);
    Welder welder(point_count);
    std::vector<std::uint32_t> welded;
    double farthest = 0.0;
    for (const Shape& shape : scene.shapes) {
        if (shape.body != body) continue;
        welded.clear();
        for (const glm::vec3& p : shape.mesh.positions_mm) {
            welded.push_back(welder.index_of(p, surface.points));
            for (int axis = 0; axis < 3; ++axis) farthest = std::max(farthest, std::abs(static_cast<double>(p[axis])));
        }
        for (const glm::uvec3& t : shape.mesh.triangles) {
            const glm::uvec3 triangle(welded[t.x], welded[t.y], welded[t.z]);
            const glm::dvec3 area_vector =
                area_vector_mm2(surface.points[triangle.x], surface.points[triangle.y], surface.points[triangle.z]);
            if (!(glm::dot(area_vector, area_vector) > 0.0)) continue;
            surface.triangles.push_back(triangle);
            surface.area_vectors.push_back(area_vector);
        }
    }
    surface.tolerance_mm = weld_roundings * FLT_EPSILON * farthest;
    return surface;
}

// Calls pair(edge, opposite edge) for edges that triangles pass in opposite directions, edge.from < edge.to,
// in the order of their triangles: where parts of a body touch, each edge meets its own part's. Returns the
// edges left over.
template <class Pair>
std::vector<Edge> match_edges(const std::vector<Edge>& edges, std::size_t points, Pair&& pair) {
    // Buckets by lower end; an entry holds higher end, triangle and, in its last bit, the direction.
    std::vector<std::uint32_t> bucket(points + 1, 0);
    for (const Edge& edge : edges) ++bucket[std::min(edge.from, edge.to) + 1];
    for (std::size_t i = 1; i <= points; ++i) bucket[i] += bucket[i - 1];
    std::vector<std::uint64_t> entries(edges.size());
    std::vector<std::uint32_t> next(bucket.begin(), bucket.end() - 1);
    for (const Edge& edge : edges) {
        const std::uint64_t to = std::max(edge.from, edge.to);
        const std::uint64_t rest = 2ull * edge.triangle + (edge.from > edge.to ? 1 : 0);
        entries[next[std::min(edge.from, edge.to)]++] = to << 32 | rest;
    }
    std::vector<Edge> left, forward, backward;
    for (std::uint32_t low = 0; low < points; ++low) {
        const auto begin = entries.begin() + bucket[low], end = entries.begin() + bucket[low + 1];
        std::sort(begin, end);
        for (auto entry = begin; entry != end;) {
            const auto high = static_cast<std::uint32_t>(*entry >> 32);
            forward.clear();
            backward.clear();
            for (; entry != end && *entry >> 32 == high; ++entry) {
                const std::uint32_t triangle = static_cast<std::uint32_t>(*entry) >> 1;
                if (*entry & 1) {
                    backward.push_back({high, low, triangle});
                } else {
                    forward.push_back({low, high, triangle});
                }
            }
            const std::size_t pairs = std::min(forward.size(), backward.size());
            for (std::size_t i = 0; i < pairs; ++i) pair(forward[i], backward[i]);
            left.insert(left.end(), forward.begin() + pairs, forward.end());
            left.insert(left.end(), backward.begin() + pairs, backward.end());
        }
    }
    return left;
}

// The rim's edges with vertices closer than the tolerance made one, and cut where other vertices lie on them:
// parts that were placed side by side, and the gaps that triangles without height leave where they were
// dropped.
std::vector<Edge> mended(const Surface& surface, const std::vector<Edge>& rim) {
    const std::vector<glm::dvec3>& points = surface.points;
    const double tolerance = surface.tolerance_mm;
    std::vector<std::uint32_t> vertices;  // by x
    for (const Edge& edge : rim) vertices.insert(vertices.end(), {edge.from, edge.to});
    std::sort(vertices.begin(), vertices.end(),
              [&](std::uint32_t a, std::uint32_t b) { return std::tie(points[a].x, a) < std::tie(points[b].x, b); });
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

    std::vector<std::uint32_t> kept;  // by x
    std::vector<std::uint32_t> same(points.size(), none);
    for (const std::uint32_t v : vertices) {
        for (auto k = kept.rbegin(); k != kept.rend() && points[v].x - points[*k].x <= tolerance; ++k)
            if (glm::distance(points[v], points[*k]) <= tolerance) same[v] = *k;
        if (same[v] != none) continue;
        same[v] = v;
        kept.push_back(v);
    }

    std::vector<Edge> result;
    std::vector<std::pair<double, std::uint32_t>> cuts;  // place along the edge, vertex
    for (const Edge& edge : rim) {
        const std::uint32_t from = same[edge.from], to = same[edge.to];
        if (from == to) continue;
        const glm::dvec3 a = points[from], along = points[to] - a;
        const double length = glm::length(along);
        const double low = std::min(a.x, points[to].x) - tolerance, high = std::max(a.x, points[to].x) + tolerance;
        cuts.clear();
        auto v =
            std::lower_bound(kept.begin(), kept.end(), low, [&](std::uint32_t i, double x) { return points[i].x < x; });
        for (; v != kept.end() && points[*v].x <= high; ++v) {
            const double t = glm::dot(points[*v] - a, along) / length;
            if (*v == from || *v == to || t <= 0.0 || t >= length) continue;
            if (glm::distance(points[*v], a + along * (t / length)) <= tolerance) cuts.emplace_back(t, *v);
        }
        std::sort(cuts.begin(), cuts.end());
        std::uint32_t start = from;
        for (const auto& cut : cuts) {
            result.push_back({start, cut.second, edge.triangle});
            start = cut.second;
        }
        result.push_back({start, to, edge.triangle});
    }
    return result;
}

// Length times bending angle [mm rad], convex positive.
double bend(const Surface& surface, const Edge& edge, const Edge& opposite) {
    const glm::dvec3 a = surface.area_vectors[edge.triangle], b = surface.area_vectors[opposite.triangle];
    const glm::dvec3 along = surface.points[edge.to] - surface.points[edge.from];
    const double length = glm::length(along);
    return length * std::atan2(glm::dot(glm::cross(a, b), along) / length, glm::dot(a, b));
}

bool is_flat(const Surface& surface) {
    glm::dvec3 normal(0.0), low = surface.points.front(), high = low;
    for (const glm::dvec3& a : surface.area_vectors) normal += a;
    if (!(glm::length(normal) > 0.0)) return false;
    normal = glm::normalize(normal);
    for (const glm::dvec3& a : surface.area_vectors)
        if (!(glm::dot(a, normal) > 0.0)) return false;
    for (const glm::dvec3& p : surface.points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const double allowed = flatness * glm::distance(low, high) + surface.tolerance_mm;
    return std::all_of(surface.points.begin(), surface.points.end(), [&](const glm::dvec3& p) {
        return std::abs(glm::dot(p - surface.points.front(), normal)) <= allowed;
    });
}

double volume_mm3(const Surface& surface) {
    const glm::dvec3 apex = surface.points.front();  // far from the origin the terms would cancel badly
    double sum = 0.0;
    for (std::size_t i = 0; i < surface.triangles.size(); ++i)
        sum += glm::dot(surface.points[surface.triangles[i].x] - apex, surface.area_vectors[i]) / 3.0;
    return sum;
}

// An edge per side of each triangle.
std::vector<Edge> edges_of(const Surface& surface) {
    std::vector<Edge> edges;
    edges.reserve(3 * surface.triangles.size());
    for (std::uint32_t i = 0; i < surface.triangles.size(); ++i) {
        const glm::uvec3& t = surface.triangles[i];
        edges.insert(edges.end(), {{t.x, t.y, i}, {t.y, t.z, i}, {t.z, t.x, i}});
    }
    return edges;
}

[[noreturn]] void fail_to_walk(const Scene& scene, const Shape& shape, const std::string& got) {
    throw InputError(fmt::format("{}: shape \"{}\": transport \"walk\" expects a closed mesh or a flat sheet, got {}",
                                 scene.file, shape.name, got));
}

}  // namespace

BodyTopology body_topology(const Scene& scene, int body) {
    const Surface surface = surface_of(scene, body);
    BodyTopology result;
    if (surface.triangles.empty()) return result;
    for (const glm::dvec3& a : surface.area_vectors) result.area_mm2 += glm::length(a);
    const auto pair = [&](const Edge& edge, const Edge& opposite) {
        result.mean_curvature_mm += 0.5 * bend(surface, edge, opposite);
    };
    std::vector<Edge> rim = match_edges(edges_of(surface), surface.points.size(), pair);
    if (!rim.empty() && rim.size() <= largest_mended_rim)
        rim = match_edges(mended(surface, rim), surface.points.size(), pair);
    result.rim_edges = rim.size();
    if (rim.empty()) {
        result.kind = BodyKind::closed;
        result.volume_mm3 = volume_mm3(surface);
        return result;
    }
    result.rim_mm = 0.5 * (surface.points[rim.front().from] + surface.points[rim.front().to]);
    if (is_flat(surface)) {
        result.kind = BodyKind::flat;
        result.mean_curvature_mm = 0.0;
    }
    return result;
}

std::vector<BodyKind> check_walkable(const Scene& scene, const std::function<bool(int)>& wanted) {
    std::vector<BodyKind> kinds(static_cast<std::size_t>(scene.body_count), BodyKind::open);
    std::vector<bool> checked(kinds.size(), false);
    for (const Shape& shape : scene.shapes) {
        const auto body = static_cast<std::size_t>(shape.body);
        if (checked[body] || !wanted(shape.body) ||
            !medium_of(scene.materials[static_cast<std::size_t>(shape.material)]))
            continue;
        checked[body] = true;
        const BodyTopology topology = body_topology(scene, shape.body);
        const glm::dvec3 rim = topology.rim_mm + scene.origin_mm;
        if (topology.kind == BodyKind::open)
            fail_to_walk(scene, shape,
                         fmt::format("{} edges without a neighbour, one at ({:.6g}, {:.6g}, {:.6g}) mm",
                                     topology.rim_edges, rim.x, rim.y, rim.z));
        // Two sides back to back enclose nothing but rounding.
        const double rounding = FLT_EPSILON * std::pow(topology.area_mm2, 1.5);
        if (topology.kind == BodyKind::closed && !(topology.volume_mm3 > rounding))
            fail_to_walk(scene, shape,
                         topology.volume_mm3 < -rounding ? "one that faces inward" : "one without a volume");
        kinds[body] = topology.kind;
    }
    return kinds;
}

}  // namespace stokes
