#include "host/scene/bvh/bvh_clip.hpp"

#include <algorithm>
#include <cmath>

namespace stokes {

namespace {

using Point = std::array<double, 3>;

struct Part {
    Point lo, hi;

    void clear() {
        lo.fill(std::numeric_limits<double>::infinity());
        hi.fill(-std::numeric_limits<double>::infinity());
    }
    void add(const Point& p) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lo[axis] = std::min(lo[axis], p[axis]);
            hi[axis] = std::max(hi[axis], p[axis]);
        }
    }
};

float float_below(double x) {
    const auto rounded = static_cast<float>(x);
    return rounded <= x ? rounded : std::nextafter(rounded, -BvhBox::infinity);
}

float float_above(double x) {
    const auto rounded = static_cast<float>(x);
    return rounded >= x ? rounded : std::nextafter(rounded, BvhBox::infinity);
}

// Where the edge from a to b, a[axis] < b[axis], is at a plane.
Point at_plane(const Point& a, const Point& b, std::size_t axis, double plane) {
    const double share = (plane - a[axis]) / (b[axis] - a[axis]);
    Point p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = a[i] + share * (b[i] - a[i]);
    p[axis] = plane;
    return p;
}

// Adds the vertices that the edge gives to the parts, each within the planes around it and within lo and hi.
void cut_edge(const Point& a, const Point& b, std::size_t axis, double lo, double hi, const float* planes, int count,
              Part* parts) {
    const double first = std::max(a[axis], lo), last = std::min(b[axis], hi);
    if (first > last) return;
    int part = 0;
    while (part < count && planes[part] < first) ++part;
    if (a[axis] == b[axis]) {
        const bool on_plane = part < count && planes[part] == first;
        for (int i = part; i <= part + (on_plane ? 1 : 0); ++i) {
            parts[i].add(a);
            parts[i].add(b);
        }
        return;
    }
    parts[part].add(first == a[axis] ? a : at_plane(a, b, axis, first));
    for (; part < count && planes[part] <= last; ++part) {
        const Point p = at_plane(a, b, axis, planes[part]);
        parts[part].add(p);
        parts[part + 1].add(p);
    }
    parts[part].add(last == b[axis] ? b : at_plane(a, b, axis, last));
}

}  // namespace

BvhCorners corners_of(const Triangle& t) {
    const auto sum = [](float a, float b) { return static_cast<float>(static_cast<double>(a) + b); };
    return {{{t.v0x, t.v0y, t.v0z},
             {sum(t.v0x, t.e1x), sum(t.v0y, t.e1y), sum(t.v0z, t.e1z)},
             {sum(t.v0x, t.e2x), sum(t.v0y, t.e2y), sum(t.v0z, t.e2z)}}};
}

BvhClipper::BvhClipper(const std::vector<Triangle>& triangles, const BvhBox& box) : triangles_(triangles) {
    double extent = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        extent = std::max(extent, static_cast<double>(box.hi[axis]) - box.lo[axis]);
    slack_mm_ = 0x1p-22 * extent;
}

void BvhClipper::cut(const BvhRef& ref, std::size_t axis, const float* planes, int count, BvhBox* parts) const {
    const BvhCorners corners = corners_of(triangles_[ref.triangle]);
    std::array<Point, 3> points;
    for (std::size_t i = 0; i < 3; ++i) points[i] = {corners[i][0], corners[i][1], corners[i][2]};
    std::sort(points.begin(), points.end(), [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; });
    std::array<Part, most_planes + 1> found;
    for (int i = 0; i <= count; ++i) found[i].clear();
    const double lo = ref.box.lo[axis], hi = ref.box.hi[axis];
    cut_edge(points[0], points[1], axis, lo, hi, planes, count, found.data());
    cut_edge(points[1], points[2], axis, lo, hi, planes, count, found.data());
    cut_edge(points[0], points[2], axis, lo, hi, planes, count, found.data());
    for (int i = 0; i <= count; ++i) {
        parts[i] = {};
        if (!(found[i].lo[0] <= found[i].hi[0])) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            parts[i].lo[k] = float_below(found[i].lo[k] - slack_mm_);
            parts[i].hi[k] = float_above(found[i].hi[k] + slack_mm_);
        }
        parts[i].cut(ref.box);
        if (parts[i].empty()) parts[i] = {};
    }
}

}  // namespace stokes
