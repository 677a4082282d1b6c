// The hierarchy's invariants, checked in exact arithmetic: counts, scales and floats are all doubles here.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string>

#include "host/core/error.hpp"
#include "host/scene/bvh_builder.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/triangle_meshes.hpp"

using namespace stokes;

namespace {

struct Bounds {
    double lo[3], hi[3];  // counts
};

// A node as any layout keeps it.
struct WideNode {
    Bounds bounds[16];
    std::uint32_t child[16];
};

template <class Node>
WideNode read_as(const Bvh& bvh, std::uint32_t index) {
    Node n;
    REQUIRE((index + 1) * sizeof n <= bvh.nodes.size() * 4);
    std::memcpy(&n, bvh.nodes.data() + index * sizeof n / 4, sizeof n);
    WideNode wide{};
    for (int i = 0; i < bvh.layout.width; ++i) {
        wide.bounds[i] = {{double(n.lo_x[i]), double(n.lo_y[i]), double(n.lo_z[i])},
                          {double(n.hi_x[i]), double(n.hi_y[i]), double(n.hi_z[i])}};
        wide.child[i] = n.child[i];
    }
    return wide;
}

WideNode read_node(const Bvh& bvh, std::uint32_t index) {
    const bool floats = bvh.layout.bounds == BvhBounds::floats;
    if (bvh.layout.width == 8) return floats ? read_as<BvhNode8f>(bvh, index) : read_as<BvhNode8>(bvh, index);
    return floats ? read_as<BvhNode16f>(bvh, index) : read_as<BvhNode16>(bvh, index);
}

// Walks the whole hierarchy and counts what is wrong.
struct Inspection {
    const Bvh& bvh;
    const std::vector<Triangle>& triangles;
    std::multiset<std::uint32_t> seen_triangles;
    std::multiset<std::uint32_t> seen_nodes;
    int levels = 0, outside_parent = 0, corner_outside = 0, order = 0, bad_empty = 0, wrong_corner = 0;

    void visit(std::uint32_t child, const Bounds& bounds, int level) {
        levels = std::max(levels, level);
        if (child & STOKES_BVH_LEAF) {
            visit_block(bvh.blocks.at(child ^ STOKES_BVH_LEAF), bounds);
            return;
        }
        seen_nodes.insert(child);
        const WideNode node = read_node(bvh, child);
        double last_area = std::numeric_limits<double>::infinity();
        for (int i = 0; i < bvh.layout.width; ++i) {
            const Bounds& b = node.bounds[i];
            if (b.lo[0] > b.hi[0]) {
                for (int a = 0; a < 3; ++a) bad_empty += !(b.lo[a] > b.hi[a]);
                bad_empty += node.child[i] != STOKES_BVH_LEAF;  // the first block, safe to visit
                last_area = -1.0;
                continue;
            }
            if (last_area < 0.0) ++bad_empty;  // empty slots stand last
            for (int a = 0; a < 3; ++a) outside_parent += b.lo[a] < bounds.lo[a] || b.hi[a] > bounds.hi[a];
            // Rounding outward adds up to two counts to each side length.
            const double x = (b.hi[0] - b.lo[0]) / bvh.grid.scale_x,
                         y = (b.hi[1] - b.lo[1]) / bvh.grid.scale_y,
                         z = (b.hi[2] - b.lo[2]) / bvh.grid.scale_z;
            const double dx = 2.0 / bvh.grid.scale_x, dy = 2.0 / bvh.grid.scale_y,
                         dz = 2.0 / bvh.grid.scale_z;
            const double area = x * y + y * z + z * x;
            const double rounding = (x + dx) * (y + dy) + (y + dy) * (z + dz) + (z + dz) * (x + dx) - area;
            order += area - rounding > last_area;
            last_area = area + rounding;
            visit(node.child[i], b, level + 1);
        }
    }

    void visit_block(const BvhBlock& block, const Bounds& bounds) {
        std::uint32_t last = 0;
        for (int lane = 0; lane < 8; ++lane) {
            const std::uint32_t index = block.triangle[lane];
            const float v[3][3] = {{block.v0x[lane], block.v0y[lane], block.v0z[lane]},
                                   {block.v1x[lane], block.v1y[lane], block.v1z[lane]},
                                   {block.v2x[lane], block.v2y[lane], block.v2z[lane]}};
            if (index == STOKES_NONE) {
                wrong_corner +=
                    std::memcmp(v[0], v[1], sizeof v[0]) != 0 || std::memcmp(v[0], v[2], sizeof v[0]) != 0;
                continue;
            }
            order += lane > 0 && index <= last;
            last = index;
            seen_triangles.insert(index);
            const Triangle& t = triangles.at(index);
            const float corners[3][3] = {{t.v0x, t.v0y, t.v0z},
                                         {t.v0x + t.e1x, t.v0y + t.e1y, t.v0z + t.e1z},
                                         {t.v0x + t.e2x, t.v0y + t.e2y, t.v0z + t.e2z}};
            wrong_corner += std::memcmp(v, corners, sizeof v) != 0;
            for (const auto& corner : corners) corner_outside += !inside(corner, bounds);
        }
    }

    bool inside(const float* p, const Bounds& b) const {
        const double c[3] = {(double(p[0]) - bvh.grid.origin_x) * bvh.grid.scale_x,
                             (double(p[1]) - bvh.grid.origin_y) * bvh.grid.scale_y,
                             (double(p[2]) - bvh.grid.origin_z) * bvh.grid.scale_z};
        for (int a = 0; a < 3; ++a)
            if (c[a] < b.lo[a] || c[a] > b.hi[a]) return false;
        return true;
    }
};

Inspection inspect(const Bvh& bvh, const std::vector<Triangle>& triangles) {
    Inspection result{bvh, triangles, {}, {}};
    if (bvh.grid.root != STOKES_BVH_EMPTY)
        result.visit(bvh.grid.root, {{0.0, 0.0, 0.0}, {65535.0, 65535.0, 65535.0}}, 0);
    return result;
}

constexpr BvhLayout layouts[]{
    {16, BvhBounds::counts}, {16, BvhBounds::floats}, {8, BvhBounds::counts}, {8, BvhBounds::floats}};

void check_layout(const std::vector<Triangle>& triangles, const BvhLayout& layout) {
    CAPTURE(layout.width, layout.bounds == BvhBounds::floats);
    const Bvh bvh = build_bvh(triangles, layout);
    const Inspection found = inspect(bvh, triangles);
    CHECK(found.outside_parent == 0);
    CHECK(found.corner_outside == 0);
    CHECK(found.wrong_corner == 0);
    CHECK(found.order == 0);
    CHECK(found.bad_empty == 0);
    CHECK(found.levels <= STOKES_BVH_LEVELS);
    CHECK(found.seen_triangles.size() == triangles.size());
    CHECK(std::set<std::uint32_t>(found.seen_triangles.begin(), found.seen_triangles.end()).size() ==
          triangles.size());
    CHECK(found.seen_nodes.size() == bvh.node_count);
    for (const float scale : {bvh.grid.scale_x, bvh.grid.scale_y, bvh.grid.scale_z})
        CHECK((scale > 0.0f && scale < std::numeric_limits<float>::infinity()));
}

void check_invariants(const std::vector<Triangle>& triangles) {
    for (const BvhLayout& layout : layouts) check_layout(triangles, layout);
}

bool same_bytes(const Bvh& a, const Bvh& b) {
    return a.nodes == b.nodes && a.node_count == b.node_count && a.blocks.size() == b.blocks.size() &&
           std::memcmp(&a.grid, &b.grid, sizeof a.grid) == 0 &&
           std::memcmp(a.blocks.data(), b.blocks.data(), a.blocks.size() * sizeof(BvhBlock)) == 0;
}

}  // namespace

TEST_CASE("an empty scene has no root") {
    const Bvh bvh = build_bvh({});
    CHECK(bvh.grid.root == STOKES_BVH_EMPTY);
    CHECK(bvh.nodes.empty());
    CHECK(bvh.blocks.empty());
}

TEST_CASE("up to eight triangles are one block without a node") {
    for (const int count : {1, 8}) {
        const auto triangles = triangle_soup(count, 1.0f, glm::vec3(1.0f), 1);
        const Bvh bvh = build_bvh(triangles);
        CHECK(bvh.grid.root == STOKES_BVH_LEAF);
        CHECK(bvh.nodes.empty());
        CHECK(bvh.blocks.size() == 1);
        check_invariants(triangles);
    }
    CHECK(build_bvh(triangle_soup(9, 1.0f, glm::vec3(1.0f), 1)).node_count == 1);
}

TEST_CASE("every corner lies in all boxes above it, every triangle in one block") {
    check_invariants(triangle_soup(9, 1.0f, glm::vec3(1.0f), 2));
    check_invariants(triangle_soup(20000, 1.0f, glm::vec3(1.0f), 3));
    check_invariants(triangle_soup(5000, 30.0f, glm::vec3(1.0f, 0.01f, 0.01f), 4));
    check_invariants(sphere_mesh(60, 120, 10.0f, glm::vec3(1000.0f, -3.0f, 0.3f)));
}

TEST_CASE("flat, far, tiny and huge scenes keep the invariants") {
    std::vector<Triangle> flat;
    for (int i = 0; i < 500; ++i) {
        const auto x = static_cast<float>(i);
        flat.push_back(make_triangle({x, 2.5f, 0.0f}, {x + 1.0f, 2.5f, 0.0f}, {x, 2.5f, 1.0f}));
    }
    check_invariants(flat);
    check_invariants(sphere_mesh(20, 40, 1.0f, glm::vec3(1e6f, 0.0f, 0.0f)));
    check_invariants(sphere_mesh(20, 40, 1e-6f, glm::vec3(0.0f)));
    check_invariants(sphere_mesh(20, 40, 1e11f, glm::vec3(0.0f)));
    check_invariants(
        std::vector<Triangle>(100, make_triangle(glm::vec3(7.0f), glm::vec3(7.0f), glm::vec3(7.0f))));
}

TEST_CASE("triangles that coincide and sizes that fall geometrically keep the depth bounded") {
    check_invariants(std::vector<Triangle>(10000, triangle_soup(1, 1.0f, glm::vec3(1.0f), 5).front()));
    std::vector<Triangle> nested;
    for (int i = 0; i < 4000; ++i) {
        const float s = std::pow(0.97f, static_cast<float>(i % 2000));
        nested.push_back(make_triangle({s, 0.0f, 0.0f}, {0.0f, s, 0.0f}, {0.0f, 0.0f, s}));
    }
    check_invariants(nested);
}

TEST_CASE("the hierarchy is the same bits for any number of threads") {
    const auto triangles = sphere_mesh(150, 300, 10.0f, glm::vec3(0.0f));
    const Bvh one = build_bvh(triangles, {}, 1);
    CHECK(same_bytes(one, build_bvh(triangles, {}, 2)));
    CHECK(same_bytes(one, build_bvh(triangles, {}, 7)));
    CHECK(same_bytes(one, build_bvh(triangles)));
}

TEST_CASE("blocks and nodes are well filled on a smooth mesh") {
    const auto triangles = sphere_mesh(150, 300, 10.0f, glm::vec3(0.0f));
    const Bvh bvh = build_bvh(triangles);
    CHECK(static_cast<double>(triangles.size()) / static_cast<double>(bvh.blocks.size()) > 6.5);
    CHECK(static_cast<double>(bvh.blocks.size() + bvh.node_count) / static_cast<double>(bvh.node_count) >
          8.0);
}

TEST_CASE("corners that cannot be placed are refused by triangle") {
    auto triangles = triangle_soup(20, 1.0f, glm::vec3(1.0f), 6);
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2e12f}) {
        triangles[13].e1y = bad;
        CHECK_THROWS_AS(build_bvh(triangles), InputError);
        try {
            build_bvh(triangles);
        } catch (const InputError& error) {
            CHECK(std::string(error.what()).find("triangle 13") == 0);
        }
    }
}
