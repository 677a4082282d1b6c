#include "host/scene/mesh/orientation.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "host/scene/mesh/mesh.hpp"

namespace stokes {
namespace {

struct Side {
    std::uint32_t low, high;  // vertices
    std::uint32_t triangle;
    bool forward;  // from low to high
};

// A part of the body.
struct Part {
    std::vector<std::uint32_t> triangles;
    bool closed = true;
    double volume_mm3 = 0.0;
    Bounds bounds;
};

// The meshes as one.
struct Soup {
    std::vector<glm::dvec3> points;
    std::vector<glm::uvec3> triangles;                // of welded points
    std::vector<std::pair<Mesh*, std::size_t>> from;  // of each triangle
    std::vector<std::uint32_t> parent;                // of each triangle: union-find
    std::uint32_t root(std::uint32_t t) {
        while (parent[t] != t) t = parent[t] = parent[parent[t]];
        return t;
    }
};

Soup soup_of(const std::vector<Mesh*>& meshes) {
    Soup soup;
    std::vector<glm::dvec3> corners;
    for (Mesh* mesh : meshes) {
        const auto first = static_cast<std::uint32_t>(corners.size());
        for (const glm::vec3& p : mesh->positions_mm) corners.emplace_back(p);
        for (std::size_t i = 0; i < mesh->triangles.size(); ++i) {
            soup.triangles.push_back(mesh->triangles[i] + first);
            soup.from.emplace_back(mesh, i);
        }
    }
    std::vector<std::uint32_t> order(corners.size()), welded(corners.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) { return std::tie(corners[i].x, corners[i].y, corners[i].z); };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (const std::uint32_t i : order) {
        if (soup.points.empty() || soup.points.back() != corners[i]) soup.points.push_back(corners[i]);
        welded[i] = static_cast<std::uint32_t>(soup.points.size() - 1);
    }
    for (glm::uvec3& t : soup.triangles) t = {welded[t.x], welded[t.y], welded[t.z]};
    soup.parent.resize(soup.triangles.size());
    std::iota(soup.parent.begin(), soup.parent.end(), 0u);
    return soup;
}

std::vector<Side> sorted_sides(const Soup& soup) {
    std::vector<Side> sides;
    sides.reserve(3 * soup.triangles.size());
    for (std::uint32_t i = 0; i < soup.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = soup.triangles[i][k], b = soup.triangles[i][(k + 1) % 3];
            if (a != b) sides.push_back({std::min(a, b), std::max(a, b), i, a < b});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    return sides;
}

// Joins the triangles of each edge into parts. Returns triangles at edges that are not passed equally often both ways.
std::vector<std::uint32_t> join_parts(Soup& soup, Orientation& found) {
    std::vector<std::uint32_t> rims;
    const std::vector<Side> sides = sorted_sides(soup);
    for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
        int balance = 0;
        for (; end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high; ++end)
            balance += sides[end].forward ? 1 : -1;
        if (end - begin == 2) soup.parent[soup.root(sides[begin].triangle)] = soup.root(sides[begin + 1].triangle);
        if (balance == 0) continue;
        for (std::size_t i = begin; i < end; ++i) rims.push_back(sides[i].triangle);
        if (end - begin != 2 || found.inconsistent++ > 0) continue;
        found.place_mm = 0.5 * (soup.points[sides[begin].low] + soup.points[sides[begin].high]);
    }
    return rims;
}

std::vector<Part> parts_of(Soup& soup, const std::vector<std::uint32_t>& rims) {
    std::vector<Part> parts;
    std::vector<std::uint32_t> part_of_root(soup.triangles.size(), 0);
    for (std::uint32_t i = 0; i < soup.triangles.size(); ++i) {
        std::uint32_t& part = part_of_root[soup.root(i)];
        if (part == 0) {
            parts.emplace_back();
            part = static_cast<std::uint32_t>(parts.size());
        }
        parts[part - 1].triangles.push_back(i);
    }
    for (const std::uint32_t t : rims) parts[part_of_root[soup.root(t)] - 1].closed = false;
    for (Part& part : parts) {
        const glm::dvec3 apex = soup.points[soup.triangles[part.triangles.front()].x];
        double area = 0.0;
        for (const std::uint32_t i : part.triangles) {
            const glm::uvec3& t = soup.triangles[i];
            const glm::dvec3 area_vector = area_vector_mm2(soup.points[t.x], soup.points[t.y], soup.points[t.z]);
            part.volume_mm3 += glm::dot(soup.points[t.x] - apex, area_vector) / 3.0;
            area += glm::length(area_vector);
            for (int k = 0; k < 3; ++k) {
                part.bounds.low_mm = glm::min(part.bounds.low_mm, soup.points[t[k]]);
                part.bounds.high_mm = glm::max(part.bounds.high_mm, soup.points[t[k]]);
            }
        }
        // Two sides back to back enclose nothing but rounding.
        if (!(std::abs(part.volume_mm3) > FLT_EPSILON * std::pow(area, 1.5))) part.closed = false;
    }
    return parts;
}

// Whether points are inside a closed part: a line from there along x leaves it once more than it enters. The triangles
// lie in a grid of cells across x.
class Inside {
  public:
    Inside(const Soup& soup, const Part& part) : soup_(soup), low_(part.bounds.low_mm) {
        cells_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(part.triangles.size()))), 1, 512);
        size_ = (part.bounds.high_mm - low_) / static_cast<double>(cells_);
        grid_.resize(static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_));
        for (const std::uint32_t i : part.triangles) {
            const glm::uvec3& t = soup.triangles[i];
            const glm::dvec3 a = soup.points[t.x], b = soup.points[t.y], c = soup.points[t.z];
            const glm::dvec3 from = glm::min(glm::min(a, b), c), to = glm::max(glm::max(a, b), c);
            for (int y = cell(from.y, 1); y <= cell(to.y, 1); ++y)
                for (int z = cell(from.z, 2); z <= cell(to.z, 2); ++z) at(y, z).push_back(i);
        }
    }

    // Lines that meet an edge or a vertex count it once: a side belongs to the half-plane below it.
    bool has(const glm::dvec3& p) {
        bool inside = false;
        for (const std::uint32_t i : at(cell(p.y, 1), cell(p.z, 2))) {
            const glm::uvec3& t = soup_.triangles[i];
            const glm::dvec3 v[3] = {soup_.points[t.x] - p, soup_.points[t.y] - p, soup_.points[t.z] - p};
            bool in_shadow = false;
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 &a = v[k], &b = v[(k + 1) % 3];
                if ((a.z > 0.0) == (b.z > 0.0)) continue;
                if ((a.y - a.z * (b.y - a.y) / (b.z - a.z)) > 0.0) in_shadow = !in_shadow;
            }
            if (!in_shadow) continue;
            const glm::dvec3 normal = glm::cross(v[1] - v[0], v[2] - v[0]);
            if (glm::dot(v[0], normal) / normal.x > 0.0) inside = !inside;
        }
        return inside;
    }

  private:
    int cell(double x, int axis) const {
        if (!(size_[axis] > 0.0)) return 0;
        return static_cast<int>(std::clamp((x - low_[axis]) / size_[axis], 0.0, static_cast<double>(cells_ - 1)));
    }
    std::vector<std::uint32_t>& at(int y, int z) {
        return grid_[static_cast<std::size_t>(y) * static_cast<std::size_t>(cells_) + static_cast<std::size_t>(z)];
    }

    const Soup& soup_;
    glm::dvec3 low_, size_{0.0};
    int cells_;
    std::vector<std::vector<std::uint32_t>> grid_;
};

bool holds(const Bounds& bounds, const glm::dvec3& p) {
    return glm::all(glm::lessThanEqual(bounds.low_mm, p)) && glm::all(glm::lessThanEqual(p, bounds.high_mm));
}

// An outermost part, with what is known of it.
struct Outer {
    const Part* part;
    bool turn;
    Inside inside;
};

void turn_over(const Soup& soup, const Part& part) {
    for (const std::uint32_t i : part.triangles) {
        auto& [mesh, triangle] = soup.from[i];
        std::swap(mesh->triangles[triangle].y, mesh->triangles[triangle].z);
        if (!mesh->uv.empty()) std::swap(mesh->uv[triangle][1], mesh->uv[triangle][2]);
    }
}

}  // namespace

Orientation turn_outward(const std::vector<Mesh*>& meshes, const glm::dvec3& eye_mm) {
    Orientation found;
    Soup soup = soup_of(meshes);
    const std::vector<std::uint32_t> rims = join_parts(soup, found);
    std::vector<Part> parts = parts_of(soup, rims);
    const auto is_inward = [](const Part& part) { return part.closed && part.volume_mm3 < 0.0; };
    if (std::none_of(parts.begin(), parts.end(), is_inward)) return found;
    std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
        return std::make_pair(std::abs(b.volume_mm3), a.triangles.front()) <
               std::make_pair(std::abs(a.volume_mm3), b.triangles.front());
    });
    std::vector<Outer> outers;
    for (const Part& part : parts) {
        if (!part.closed) continue;
        const glm::dvec3 point = soup.points[soup.triangles[part.triangles.front()].x];
        const auto within = [&](Outer& outer) {
            return holds(outer.part->bounds, part.bounds.low_mm) && holds(outer.part->bounds, part.bounds.high_mm) &&
                   outer.inside.has(point);
        };
        const auto outer = std::find_if(outers.begin(), outers.end(), within);
        bool turn = outer != outers.end() && outer->turn;
        if (outer == outers.end()) {
            Inside inside(soup, part);
            if (is_inward(part) && holds(part.bounds, eye_mm) && inside.has(eye_mm)) continue;  // a room
            turn = is_inward(part);
            outers.push_back({&part, turn, std::move(inside)});
        }
        if (!turn) continue;
        turn_over(soup, part);
        found.turned += part.triangles.size();
    }
    return found;
}

bool is_closed(const std::vector<Mesh*>& meshes) {
    Orientation found;
    Soup soup = soup_of(meshes);
    return join_parts(soup, found).empty();
}

namespace {

// How many of the triangles that lie in one place with their reverse belong to sheets. The rest are walls between
// solids that stand side by side: about such a wall each edge goes on into the solids.
std::size_t count_sheets(Soup& soup, const std::vector<bool>& paired) {
    const std::vector<Side> sides = sorted_sides(soup);
    std::vector<std::pair<std::uint32_t, bool>> edges;  // a triangle at the end of what is paired; whether solids go on
    for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
        std::uint32_t first = 0;
        std::size_t count = 0;
        for (; end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high;
             ++end) {
            const std::uint32_t t = sides[end].triangle;
            if (!paired[t]) continue;
            if (count++ == 0) first = t;
            soup.parent[soup.root(t)] = soup.root(first);
        }
        const std::size_t others = end - begin - count;
        if (count == 2 || (count > 0 && others > 0)) edges.emplace_back(first, others > 0 && others % 2 == 0);
    }
    std::vector<bool> is_wall(paired.size(), false), is_sheet(paired.size(), false);
    for (const auto& [triangle, goes_on] : edges) (goes_on ? is_wall : is_sheet)[soup.root(triangle)] = true;
    std::size_t sheets = 0;
    for (std::uint32_t t = 0; t < paired.size(); ++t)
        if (paired[t] && (is_sheet[soup.root(t)] || !is_wall[soup.root(t)])) ++sheets;
    return sheets;
}

}  // namespace

Pairs drop_reversed_twins(Mesh& mesh, bool may_drop) {
    Soup soup = soup_of({&mesh});
    // Corners from the least one on, and whether the triangle goes round the other way.
    struct Place {
        glm::uvec3 corners;
        bool reversed;
        std::uint32_t triangle;
    };
    const auto key = [](const Place& p) {
        return std::make_tuple(p.corners.x, p.corners.y, p.corners.z, p.reversed, p.triangle);
    };
    std::vector<Place> places;
    for (std::uint32_t i = 0; i < soup.triangles.size(); ++i) {
        glm::uvec3 t = soup.triangles[i];
        while (t.x > t.y || t.x > t.z) t = {t.y, t.z, t.x};
        const bool reversed = t.y > t.z;
        if (reversed) std::swap(t.y, t.z);
        places.push_back({t, reversed, i});
    }
    std::sort(places.begin(), places.end(), [&](const Place& a, const Place& b) { return key(a) < key(b); });
    std::vector<bool> keep(places.size(), false), paired(places.size(), false);
    Pairs pairs;
    for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
        std::uint32_t first = places[begin].triangle;
        for (; end < places.size() && places[end].corners == places[begin].corners; ++end)
            first = std::min(first, places[end].triangle);
        keep[first] = true;
        if (places[begin].reversed != places[end - 1].reversed)
            for (std::size_t i = begin; i < end; ++i) paired[places[i].triangle] = true;
    }
    pairs.dropped = may_drop && std::find(paired.begin(), paired.end(), false) == paired.end();
    if (!pairs.dropped) {
        if (std::find(paired.begin(), paired.end(), true) != paired.end()) pairs.paired = count_sheets(soup, paired);
        return pairs;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < keep.size(); ++i) {
        if (!keep[i]) continue;
        mesh.triangles[kept] = mesh.triangles[i];
        if (!mesh.uv.empty()) mesh.uv[kept] = mesh.uv[i];
        ++kept;
    }
    mesh.triangles.resize(kept);
    if (!mesh.uv.empty()) mesh.uv.resize(kept);
    return pairs;
}

}  // namespace stokes
