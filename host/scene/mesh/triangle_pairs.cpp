#include "host/scene/mesh/triangle_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stokes {

namespace {

constexpr std::size_t most_in_leaf = 8;

// A tree of boxes over a range of triangles, which it sorts.
class BoxTree {
  public:
    explicit BoxTree(std::vector<BodyTriangle>& triangles) : triangles_(triangles) {
        if (!triangles.empty()) build(0, triangles.size());
    }

    template <class Visit>
    void visit_near(const Bounds& box, double distance, const Visit& visit) const {
        if (nodes_.empty()) return;
        std::vector<std::size_t> open{0};
        while (!open.empty()) {
            const Node& node = nodes_[open.back()];
            open.pop_back();
            if (!node.box.meets(box, distance)) continue;
            if (node.second == 0) {
                for (std::size_t i = node.begin; i < node.end; ++i) visit(i);
                continue;
            }
            open.push_back(node.second);
            open.push_back(node.first);
        }
    }

  private:
    struct Node {
        Bounds box;
        std::size_t begin = 0, end = 0;     // of the triangles below it
        std::size_t first = 0, second = 0;  // children; second 0: a leaf
    };

    std::size_t build(std::size_t begin, std::size_t end) {
        const std::size_t at = nodes_.size();
        Node node;
        Bounds centres;
        for (std::size_t i = begin; i < end; ++i) {
            node.box.add(triangles_[i].box);
            centres.add(middle(triangles_[i]));
        }
        node.begin = begin;
        node.end = end;
        nodes_.push_back(node);
        if (end - begin <= most_in_leaf) return at;
        const glm::dvec3 size = centres.high_mm - centres.low_mm;
        const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        const std::size_t half = begin + (end - begin) / 2;
        const auto start = triangles_.begin();
        std::nth_element(start + static_cast<std::ptrdiff_t>(begin), start + static_cast<std::ptrdiff_t>(half),
                         start + static_cast<std::ptrdiff_t>(end), [&](const BodyTriangle& a, const BodyTriangle& b) {
                             const double u = middle(a)[axis], v = middle(b)[axis];
                             return u < v || (u == v && a.index < b.index);
                         });
        const std::size_t first = build(begin, half);
        const std::size_t second = build(half, end);
        nodes_[at].first = first;
        nodes_[at].second = second;
        return at;
    }

    static glm::dvec3 middle(const BodyTriangle& t) { return 0.5 * (t.box.low_mm + t.box.high_mm); }

    std::vector<BodyTriangle>& triangles_;
    std::vector<Node> nodes_;
};

glm::dvec3 distances_to_plane(const BodyTriangle& of, const BodyTriangle& plane) {
    glm::dvec3 result;
    for (int i = 0; i < 3; ++i)
        result[i] = glm::dot(of.corners[static_cast<std::size_t>(i)] - plane.corners[0], plane.normal);
    return result;
}

// Where a triangle that a plane cuts meets the line of the two planes: an interval along the line.
std::pair<double, double> cut_on_line(const BodyTriangle& t, const glm::dvec3& distances, const glm::dvec3& line) {
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        if (!((distances[i] < 0.0) != (distances[j] < 0.0))) continue;
        const glm::dvec3 &a = t.corners[static_cast<std::size_t>(i)], &b = t.corners[static_cast<std::size_t>(j)];
        const double at = glm::dot(a + (b - a) * (distances[i] / (distances[i] - distances[j])), line);
        low = std::min(low, at);
        high = std::max(high, at);
    }
    return {low, high};
}

// The part of a polygon on the inner side of an edge, which lies at heights >= 0.
std::vector<glm::dvec3> clipped(const std::vector<glm::dvec3>& polygon, const glm::dvec3& on_edge,
                                const glm::dvec3& inward) {
    std::vector<glm::dvec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double height_a = glm::dot(a - on_edge, inward), height_b = glm::dot(b - on_edge, inward);
        if (height_a >= 0.0) kept.push_back(a);
        if ((height_a >= 0.0) != (height_b >= 0.0)) kept.push_back(a + (b - a) * (height_a / (height_a - height_b)));
    }
    return kept;
}

}  // namespace

void visit_near_pairs(std::vector<BodyTriangle>& triangles, double distance_mm,
                      const std::function<void(const BodyTriangle&, const BodyTriangle&)>& visit) {
    const BoxTree tree(triangles);
    for (std::size_t i = 0; i < triangles.size(); ++i)
        tree.visit_near(triangles[i].box, distance_mm, [&](std::size_t j) {
            if (j > i && triangles[j].body != triangles[i].body &&
                triangles[i].box.meets(triangles[j].box, distance_mm))
                visit(triangles[i], triangles[j]);
        });
}

bool share_a_plane(const BodyTriangle& a, const BodyTriangle& b, double distance_mm) {
    if (!(std::abs(glm::dot(a.normal, b.normal)) > 0.999)) return false;
    std::vector<glm::dvec3> common(b.corners.begin(), b.corners.end());
    for (std::size_t i = 0; i < 3 && !common.empty(); ++i) {
        const glm::dvec3 edge = a.corners[(i + 1) % 3] - a.corners[i];
        const double length = glm::length(edge);
        if (!(length > 0.0)) return false;
        // Moved inward, so that neighbours in a plane do not overlap by their rounding.
        const glm::dvec3 inward = glm::cross(a.normal, edge) / length;
        common = clipped(common, a.corners[i] + inward * distance_mm, inward);
    }
    if (common.empty()) return false;
    return std::any_of(common.begin(), common.end(), [&](const glm::dvec3& p) {
        return std::abs(glm::dot(p - a.corners[0], a.normal)) <= distance_mm;
    });
}

bool cross_each_other(const BodyTriangle& a, const BodyTriangle& b, double distance_mm) {
    const glm::dvec3 of_a = distances_to_plane(a, b), of_b = distances_to_plane(b, a);
    for (const glm::dvec3& d : {of_a, of_b})
        if (!(std::min({d.x, d.y, d.z}) < -distance_mm && std::max({d.x, d.y, d.z}) > distance_mm)) return false;
    const glm::dvec3 along = glm::cross(a.normal, b.normal);
    const double sine = glm::length(along);
    if (!(sine > 0.0)) return false;
    const auto in_a = cut_on_line(a, of_a, along / sine), in_b = cut_on_line(b, of_b, along / sine);
    return std::min(in_a.second, in_b.second) - std::max(in_a.first, in_b.first) > distance_mm;
}

int stands_on(const BodyTriangle& a, const BodyTriangle& plane, double distance_mm) {
    const glm::dvec3 heights = distances_to_plane(a, plane);
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3, third = (k + 2) % 3;
        if (std::abs(heights[k]) > distance_mm || std::abs(heights[next]) > distance_mm ||
            !(std::abs(heights[third]) > distance_mm))
            continue;
        const glm::dvec3 middle =
            0.5 * (a.corners[static_cast<std::size_t>(k)] + a.corners[static_cast<std::size_t>(next)]);
        bool within = true;
        for (std::size_t side = 0; side < 3; ++side) {
            const glm::dvec3 edge = plane.corners[(side + 1) % 3] - plane.corners[side];
            const glm::dvec3 inward = glm::cross(plane.normal, edge) / glm::length(edge);
            within &= glm::dot(middle - plane.corners[side], inward) > distance_mm;
        }
        if (within) return heights[third] > 0.0 ? 1 : -1;
    }
    return 0;
}

}  // namespace stokes
