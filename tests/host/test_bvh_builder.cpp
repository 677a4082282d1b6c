// The hierarchy's invariants, checked in double precision, in which counts, scales and corners are exact.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <set>
#include <string>

#include "host/core/error.hpp"
#include "host/scene/bvh/bvh_builder.hpp"
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
    std::vector<std::vector<Bounds>> boxes{};  // of the blocks that each triangle lies in
    std::multiset<std::uint32_t> seen_nodes{}, seen_blocks{};
    std::size_t refs = 0;
    double leaf_area = 0.0;  // half areas of all blocks' boxes [mm^2]
    int levels = 0, outside_parent = 0, order = 0, bad_empty = 0, wrong_corner = 0;

    void visit(std::uint32_t child, const Bounds& bounds, int level) {
        levels = std::max(levels, level);
        if (child & STOKES_BVH_LEAF) {
            seen_blocks.insert(child ^ STOKES_BVH_LEAF);
            visit_block(bvh.blocks.at(child ^ STOKES_BVH_LEAF), bounds);
            leaf_area += half_area(bounds, 0.0);
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
            const double area = half_area(b, 0.0), rounding = half_area(b, 2.0) - area;
            order += area - rounding > last_area;
            last_area = area + rounding;
            visit(node.child[i], b, level + 1);
        }
    }

    double half_area(const Bounds& b, double more_counts) const {
        const double x = (b.hi[0] - b.lo[0] + more_counts) / bvh.grid.scale_x,
                     y = (b.hi[1] - b.lo[1] + more_counts) / bvh.grid.scale_y,
                     z = (b.hi[2] - b.lo[2] + more_counts) / bvh.grid.scale_z;
        return x * y + y * z + z * x;
    }

    void visit_block(const BvhBlock& block, const Bounds& bounds) {
        std::uint32_t last = 0;
        for (int lane = 0; lane < 8; ++lane) {
            const std::uint32_t index = block.triangle[lane];
            const float v[3][3] = {{block.v0x[lane], block.v0y[lane], block.v0z[lane]},
                                   {block.v1x[lane], block.v1y[lane], block.v1z[lane]},
                                   {block.v2x[lane], block.v2y[lane], block.v2z[lane]}};
            if (index == STOKES_NONE) {
                wrong_corner += std::memcmp(v[0], v[1], sizeof v[0]) != 0 || std::memcmp(v[0], v[2], sizeof v[0]) != 0;
                continue;
            }
            order += lane > 0 && index <= last;
            last = index;
            ++refs;
            boxes.at(index).push_back(bounds);
            float corners[3][3];
            corners_of(triangles.at(index), corners);
            wrong_corner += std::memcmp(v, corners, sizeof v) != 0;
        }
    }

    static void corners_of(const Triangle& t, float corners[3][3]) {
        const float at[3][3] = {{t.v0x, t.v0y, t.v0z},
                                {t.v0x + t.e1x, t.v0y + t.e1y, t.v0z + t.e1z},
                                {t.v0x + t.e2x, t.v0y + t.e2y, t.v0z + t.e2z}};
        std::memcpy(corners, at, sizeof at);
    }

    // Points of triangles, corners and edges among them, that no block's box holds.
    int lost_points(int points_each) const {
        std::mt19937 random(77);
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        int lost = 0;
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            float v[3][3];
            corners_of(triangles[i], v);
            for (int point = 0; point < 3 + points_each; ++point) {
                double u = point == 1 ? 1.0 : 0.0, w = point == 2 ? 1.0 : 0.0;
                if (point > 2) {
                    u = unit(random), w = unit(random);
                    if (u + w > 1.0) u = 1.0 - u, w = 1.0 - w;
                    if (point % 4 == 0) w = 0.0;
                    if (point % 4 == 1) w = 1.0 - u;
                }
                double p[3];
                for (int a = 0; a < 3; ++a)
                    p[a] = point == 0 ? v[0][a]
                                      : (1.0 - u - w) * double(v[0][a]) + u * double(v[1][a]) + w * double(v[2][a]);
                lost += std::none_of(boxes[i].begin(), boxes[i].end(), [&](const Bounds& b) { return holds(b, p); });
            }
        }
        return lost;
    }

    bool holds(const Bounds& b, const double* p) const {
        const double c[3] = {(p[0] - bvh.grid.origin_x) * bvh.grid.scale_x,
                             (p[1] - bvh.grid.origin_y) * bvh.grid.scale_y,
                             (p[2] - bvh.grid.origin_z) * bvh.grid.scale_z};
        const double scale[3] = {bvh.grid.scale_x, bvh.grid.scale_y, bvh.grid.scale_z};
        for (int a = 0; a < 3; ++a) {
            const double rounding = 1e-14 * std::fabs(p[a]) * scale[a];  // of a point between the corners
            if (c[a] < b.lo[a] - rounding || c[a] > b.hi[a] + rounding) return false;
        }
        return true;
    }
};

Inspection inspect(const Bvh& bvh, const std::vector<Triangle>& triangles) {
    Inspection result{bvh, triangles};
    result.boxes.resize(triangles.size());
    if (bvh.grid.root != STOKES_BVH_EMPTY)
        result.visit(bvh.grid.root, {{0.0, 0.0, 0.0}, {65535.0, 65535.0, 65535.0}}, 0);
    return result;
}

constexpr BvhLayout layouts[]{
    {16, BvhBounds::counts}, {16, BvhBounds::floats}, {8, BvhBounds::counts}, {8, BvhBounds::floats}};

constexpr BvhLayout counts16{16, BvhBounds::counts};

// Returns the number of refs: triangles, by the blocks they lie in.
std::size_t check_layout(const std::vector<Triangle>& triangles, const BvhLayout& layout) {
    CAPTURE(layout.width, layout.bounds == BvhBounds::floats);
    const Bvh bvh = build_bvh(triangles, layout);
    CHECK(bvh.layout.width == layout.width);
    CHECK(bvh.layout.bounds == layout.bounds);
    const Inspection found = inspect(bvh, triangles);
    CHECK(found.outside_parent == 0);
    CHECK(found.lost_points(12) == 0);
    CHECK(found.wrong_corner == 0);
    CHECK(found.order == 0);
    CHECK(found.bad_empty == 0);
    CHECK(found.levels <= STOKES_BVH_LEVELS);
    for (const auto* seen : {&found.seen_nodes, &found.seen_blocks})
        CHECK(std::set<std::uint32_t>(seen->begin(), seen->end()).size() == seen->size());
    CHECK(found.seen_nodes.size() == bvh.node_count);
    CHECK(found.seen_blocks.size() == bvh.blocks.size());
    const std::size_t words_each = layout.bounds == BvhBounds::floats ? 7 : 4;
    CHECK(bvh.nodes.size() == bvh.node_count * words_each * static_cast<std::size_t>(layout.width));
    CHECK(found.refs <= triangles.size() + std::max<std::size_t>(triangles.size(), 1 << 17));
    for (const float scale : {bvh.grid.scale_x, bvh.grid.scale_y, bvh.grid.scale_z})
        CHECK((scale > 0.0f && scale < std::numeric_limits<float>::infinity()));
    return found.refs;
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

TEST_CASE("every point of a triangle lies in all boxes above one of its blocks") {
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
    check_invariants(std::vector<Triangle>(100, make_triangle(glm::vec3(7.0f), glm::vec3(7.0f), glm::vec3(7.0f))));
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

TEST_CASE("long triangles are cut and stay whole all the same") {
    const auto rods = rod_soup(150, 0.5f, 7);
    for (const BvhLayout& layout : layouts) CHECK(check_layout(rods, layout) > 2 * rods.size());
    // Beside many small triangles, and as plates.
    auto mixed = sphere_mesh(60, 120, 20.0f, glm::vec3(50.0f));
    append(mixed, rods);
    CHECK(check_layout(mixed, counts16) > mixed.size() + rods.size());
    check_invariants(triangle_soup(400, 100.0f, glm::vec3(1.0f), 8));
}

TEST_CASE("cuts pay: rays meet fewer blocks than whole triangles would allow") {
    const auto rods = rod_soup(150, 0.5f, 9);
    // A block's box is at least as large as that of each of its triangles.
    double whole = 0.0;
    for (const Triangle& t : rods) {
        float v[3][3];
        Inspection::corners_of(t, v);
        double side[3];
        for (int a = 0; a < 3; ++a)
            side[a] = double(std::max({v[0][a], v[1][a], v[2][a]})) - std::min({v[0][a], v[1][a], v[2][a]});
        whole += (side[0] * side[1] + side[1] * side[2] + side[2] * side[0]) / 8.0;
    }
    CHECK(inspect(build_bvh(rods, counts16), rods).leaf_area < 0.5 * whole);
}

TEST_CASE("triangles of even sizes are not cut") {
    for (const auto& triangles :
         {sphere_mesh(150, 300, 10.0f, glm::vec3(0.0f)), box_mesh(glm::vec3(0.0f), glm::vec3(5.0f)),
          triangle_soup(20000, 1.0f, glm::vec3(1.0f), 10)})
        CHECK(inspect(build_bvh(triangles, counts16), triangles).refs == triangles.size());
}

TEST_CASE("many long triangles at most double") {
    const auto rods = rod_soup(8000, 0.2f, 11);  // 160,000 triangles
    const Bvh bvh = build_bvh(rods, counts16);
    const Inspection found = inspect(bvh, rods);
    CHECK(found.refs > rods.size() * 3 / 2);
    CHECK(found.refs <= 2 * rods.size());
    CHECK(found.lost_points(4) == 0);
}

TEST_CASE("the hierarchy is the same bits for any number of threads") {
    const auto sphere = sphere_mesh(150, 300, 10.0f, glm::vec3(0.0f));
    auto rods = rod_soup(1500, 0.2f, 12);
    append(rods, sphere);
    REQUIRE(inspect(build_bvh(rods, counts16), rods).refs > rods.size() * 5 / 4);
    for (const auto& triangles : {sphere, rods})
        for (const BvhLayout& layout : {BvhLayout{16, BvhBounds::automatic}, BvhLayout{8, BvhBounds::floats}}) {
            const Bvh one = build_bvh(triangles, layout, 1);
            for (const unsigned threads : {2u, 3u, 7u, 0u})
                CHECK(same_bytes(one, build_bvh(triangles, layout, threads)));
        }
}

TEST_CASE("floats are chosen where counts would be coarse") {
    const auto bounds_of = [](const std::vector<Triangle>& triangles, int width) {
        return build_bvh(triangles, {width, BvhBounds::automatic}).layout.bounds;
    };
    const auto hall = box_mesh(glm::vec3(0.0f), glm::vec3(10000.0f));
    for (const int width : {8, 16}) {
        CAPTURE(width);
        CHECK(bounds_of({}, width) == BvhBounds::counts);
        CHECK(bounds_of(hall, width) == BvhBounds::counts);
        CHECK(bounds_of(sphere_mesh(100, 200, 10.0f, glm::vec3(0.0f)), width) == BvhBounds::counts);
        CHECK(bounds_of(rod_soup(200, 0.5f, 13), width) == BvhBounds::counts);
        auto gem = sphere_mesh(60, 120, 0.5f, glm::vec3(3000.0f));  // triangles of 0.02 mm, counts of 0.15 mm
        append(gem, hall);
        CHECK(bounds_of(gem, width) == BvhBounds::floats);
        check_layout(gem, {width, BvhBounds::floats});
        auto ball = sphere_mesh(60, 120, 1000.0f, glm::vec3(3000.0f));
        append(ball, hall);
        CHECK(bounds_of(ball, width) == BvhBounds::counts);
        const Triangle point = make_triangle(glm::vec3(7.0f), glm::vec3(7.0f), glm::vec3(7.0f));
        CHECK(bounds_of(std::vector<Triangle>(50, point), width) == BvhBounds::counts);
    }
}

TEST_CASE("kernels are told the layout") {
    using Options = std::vector<std::string>;
    CHECK(bvh_kernel_options({16, BvhBounds::counts}).empty());
    CHECK(bvh_kernel_options({16, BvhBounds::automatic}).empty());
    CHECK(bvh_kernel_options({8, BvhBounds::counts}) == Options{"-DSTOKES_BVH_WIDTH=8"});
    CHECK(bvh_kernel_options({16, BvhBounds::floats}) == Options{"-DSTOKES_BVH_FLOAT"});
    CHECK(bvh_kernel_options({8, BvhBounds::floats}) == Options{"-DSTOKES_BVH_WIDTH=8", "-DSTOKES_BVH_FLOAT"});
    CHECK_THROWS_AS(build_bvh({}, {4, BvhBounds::counts}), InputError);
}

TEST_CASE("blocks and nodes are well filled on a smooth mesh") {
    const auto triangles = sphere_mesh(150, 300, 10.0f, glm::vec3(0.0f));
    const Bvh bvh = build_bvh(triangles);
    CHECK(static_cast<double>(triangles.size()) / static_cast<double>(bvh.blocks.size()) > 6.5);
    CHECK(static_cast<double>(bvh.blocks.size() + bvh.node_count) / static_cast<double>(bvh.node_count) > 8.0);
}

TEST_CASE("corners that cannot be placed are refused by triangle") {
    auto triangles = triangle_soup(20, 1.0f, glm::vec3(1.0f), 6);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2e12f}) {
        triangles[13].e1y = bad;
        CHECK_THROWS_AS(build_bvh(triangles), InputError);
        try {
            build_bvh(triangles);
        } catch (const InputError& error) {
            CHECK(std::string(error.what()).find("triangle 13") == 0);
        }
    }
}
