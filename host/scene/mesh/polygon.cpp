#include "host/scene/mesh/polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace stokes {
namespace {

using Points = std::vector<glm::dvec2>;

// Rounding of a cross product, as a share of its terms.
constexpr double turn_rounding = 1e-15;
// A vector area this small beside its parts is none.
constexpr double cancelled = 1e-9;
// Ears are first sought among those at least this high over their longest side, so that slivers come last.
constexpr std::array<double, 3> least_heights{0.05, 1e-4, 0.0};

// Twice the area of the triangle, positive where it turns counter-clockwise; 0 within its rounding.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    const double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x);
    const double area = left - right;
    return std::abs(area) > turn_rounding * (std::abs(left) + std::abs(right)) ? area : 0.0;
}

// The vector area of the polygon, twice. Where its parts cancel, as in a bow tie, that of its largest triangle.
glm::dvec3 normal_of(const std::vector<glm::dvec3>& corners) {
    glm::dvec3 sum(0.0), largest(0.0);
    double total = 0.0;
    for (std::size_t i = 2; i < corners.size(); ++i) {
        const glm::dvec3 part = glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
        sum += part;
        total += glm::length(part);
        if (glm::length(part) > glm::length(largest)) largest = part;
    }
    return glm::length(sum) > cancelled * total ? sum : largest;
}

// The corners as seen against the polygon's normal, counter-clockwise. The largest axis of the normal is left out, so
// that coordinates keep their bits.
Points seen_flat(const std::vector<glm::dvec3>& corners) {
    const glm::dvec3 normal = normal_of(corners), size = glm::abs(normal);
    const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    Points points;
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 from_first = corner - corners[0];
        const glm::dvec2 p(from_first[(axis + 1) % 3], from_first[(axis + 2) % 3]);
        points.push_back(normal[axis] < 0.0 ? glm::dvec2(p.y, p.x) : p);
    }
    return points;
}

// Corner 0 sees all of the polygon, and every triangle of its fan has an area.
bool is_fan(const Points& p) {
    for (std::size_t k = 2; k < p.size(); ++k)
        if (!(turn(p[0], p[k - 1], p[k]) > 0.0) || turn(p[0], p[1], p[k]) < 0.0) return false;
    return true;
}

bool cross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
    return turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0;
}

// Some side passes through another one; sides that touch do not.
bool crosses_itself(const Points& p) {
    const std::size_t n = p.size();
    const auto low = [&](std::size_t i) { return std::min(p[i].x, p[(i + 1) % n].x); };
    const auto high = [&](std::size_t i) { return std::max(p[i].x, p[(i + 1) % n].x); };
    std::vector<std::size_t> by_x(n);
    std::iota(by_x.begin(), by_x.end(), std::size_t{0});
    std::sort(by_x.begin(), by_x.end(), [&](std::size_t a, std::size_t b) { return low(a) < low(b); });
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n && low(by_x[j]) <= high(by_x[i]); ++j)
            if (cross(p[by_x[i]], p[(by_x[i] + 1) % n], p[by_x[j]], p[(by_x[j] + 1) % n])) return true;
    return false;
}

// Ear clipping (Meisters, "Polygons have ears", 1975). Every triangle that it makes turns counter-clockwise or has no
// area, and a polygon that does not cross itself winds once around what is inside: so the triangles cover that once.
class EarClipper {
  public:
    explicit EarClipper(const Points& points)
        : p_(points), before_(points.size()), after_(points.size()), in_way_(points.size()) {
        for (std::size_t i = 0; i < p_.size(); ++i) {
            before_[i] = (i + p_.size() - 1) % p_.size();
            after_[i] = (i + 1) % p_.size();
        }
        for (std::size_t i = 0; i < p_.size(); ++i) mark(i);
    }

    // False: no ear is left.
    bool clip_all(std::vector<glm::uvec3>& triangles) {
        std::size_t at = 0;
        for (std::size_t left = p_.size(); left > 3; --left) {
            if (!find_ear(at, left)) return false;
            triangles.push_back(triangle(at));
            at = clip(at);
        }
        triangles.push_back(triangle(at));
        return turn(p_[before_[at]], p_[at], p_[after_[at]]) >= 0.0;
    }

  private:
    glm::uvec3 triangle(std::size_t i) const { return {before_[i], i, after_[i]}; }

    // A convex corner is in no ear unless one that is not convex is in it too.
    void mark(std::size_t i) { in_way_[i] = !(turn(p_[before_[i]], p_[i], p_[after_[i]]) > 0.0); }

    // Moves on to the next ear, the highest ones first.
    bool find_ear(std::size_t& at, std::size_t left) const {
        for (const double least_height : least_heights)
            for (std::size_t tried = 0; tried < left; ++tried, at = after_[at])
                if (is_spike(at) || is_ear(at, least_height)) return true;
        return all_flat(at, left);
    }

    // Returns the corner after next, so that ears are not all taken in one place.
    std::size_t clip(std::size_t i) {
        const std::size_t a = before_[i], c = after_[i];
        after_[a] = c;
        before_[c] = a;
        mark(a);
        mark(c);
        return after_[c];
    }

    bool is_spike(std::size_t i) const {
        const glm::dvec2 a = p_[before_[i]] - p_[i], c = p_[after_[i]] - p_[i];
        if (a == glm::dvec2(0.0) || c == glm::dvec2(0.0)) return true;
        return turn(p_[before_[i]], p_[i], p_[after_[i]]) == 0.0 && glm::dot(a, c) > 0.0;
    }

    bool all_flat(std::size_t at, std::size_t left) const {
        for (; left > 0; --left, at = after_[at])
            if (turn(p_[before_[at]], p_[at], p_[after_[at]]) != 0.0) return false;
        return true;
    }

    bool is_ear(std::size_t i, double least_height) const {
        const std::size_t ia = before_[i], ic = after_[i];
        const glm::dvec2 a = p_[ia], b = p_[i], c = p_[ic];
        const double area = turn(a, b, c);
        const double longest2 = std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
        if (!(area > least_height * longest2) || in_way_[i]) return false;
        if (!within_corner(ia, c) || !within_corner(ic, a)) return false;
        const glm::dvec2 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
        for (std::size_t k = after_[ic]; k != ia; k = after_[k]) {
            const glm::dvec2 q = p_[k];
            if (!in_way_[k] || q.x < low.x || q.y < low.y || q.x > high.x || q.y > high.y) continue;
            if (turn(a, b, q) < 0.0 || turn(b, c, q) < 0.0 || turn(c, a, q) < 0.0) continue;
            if (q == a || q == c) continue;  // another visit of the place; the corners themselves are asked above
            if (q != b || into_triangle(a, b, c, p_[before_[k]]) || into_triangle(a, b, c, p_[after_[k]])) return false;
        }
        return true;
    }

    // Going from the corner to this place starts inside the polygon.
    bool within_corner(std::size_t i, const glm::dvec2& to) const {
        const glm::dvec2 a = p_[before_[i]], b = p_[i], c = p_[after_[i]];
        const bool left_of_after = turn(b, c, to) >= 0.0, right_of_before = turn(b, to, a) >= 0.0;
        return in_way_[i] ? left_of_after || right_of_before : left_of_after && right_of_before;
    }

    static bool into_triangle(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& to) {
        return turn(b, c, to) > 0.0 && turn(b, to, a) > 0.0;
    }

    const Points& p_;
    std::vector<std::size_t> before_, after_;
    std::vector<bool> in_way_;  // not convex
};

void make_fan(std::size_t corners, std::vector<glm::uvec3>& triangles) {
    triangles.clear();
    for (std::uint32_t k = 2; k < corners; ++k) triangles.push_back({0, k - 1, k});
}

}  // namespace

PolygonCut cut_polygon(const std::vector<glm::dvec3>& corners, std::vector<glm::uvec3>& triangles) {
    const Points points = seen_flat(corners);
    make_fan(corners.size(), triangles);
    if (corners.size() == 3 || is_fan(points)) return PolygonCut::exact;
    if (!crosses_itself(points)) {
        std::vector<glm::uvec3> ears;
        if (EarClipper(points).clip_all(ears)) {
            triangles = ears;
            return PolygonCut::exact;
        }
    }
    return PolygonCut::crossing;
}

}  // namespace stokes
