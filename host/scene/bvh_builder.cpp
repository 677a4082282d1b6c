#include "host/scene/bvh_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <thread>

#include "host/core/error.hpp"
#include "host/scene/bvh_tree.hpp"

namespace stokes {

namespace {

constexpr double grid_counts = 65535.0;
constexpr float farthest_mm = 1e12f;  // cubes of lengths stay far inside the range of a float

// Levels of the binary tree that are split by area. Even halves take 2^28 blocks in 28 levels, so that the
// last entry keeps within STOKES_BVH_LEVELS whatever the triangles.
constexpr std::array<int, 3> area_levels_tried{96, 24, STOKES_BVH_LEVELS - 28};

using Corners = std::array<std::array<float, 3>, 3>;

Corners corners_of(const Triangle& t) {
    const auto sum = [](float a, float b) { return static_cast<float>(static_cast<double>(a) + b); };
    return {{{t.v0x, t.v0y, t.v0z},
             {sum(t.v0x, t.e1x), sum(t.v0y, t.e1y), sum(t.v0z, t.e1z)},
             {sum(t.v0x, t.e2x), sum(t.v0y, t.e2y), sum(t.v0z, t.e2z)}}};
}

std::vector<BvhRef> make_refs(const std::vector<Triangle>& triangles) {
    if (triangles.size() > STOKES_BVH_LEAF) throw InputError("the scene has more than 2^31 triangles");
    std::vector<BvhRef> refs(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        refs[i].triangle = static_cast<std::uint32_t>(i);
        for (const std::array<float, 3>& corner : corners_of(triangles[i])) {
            for (const float x : corner)
                if (!(std::fabs(x) <= farthest_mm))
                    throw InputError("triangle " + std::to_string(i) +
                                     ": expected finite corners within 1e12 mm of the origin");
            refs[i].box.add({corner, corner});
        }
    }
    return refs;
}

// A flat axis takes part of the largest extent, a scene without any extent 1 mm.
BvhGrid make_grid(const BvhBox& box) {
    std::array<double, 3> extent{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        extent[axis] = static_cast<double>(box.hi[axis]) - box.lo[axis];
    const double largest = *std::max_element(extent.begin(), extent.end());
    std::array<float, 3> scale{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double length = largest > 1e-12 ? std::max(extent[axis], largest / 256.0) : 1.0;
        scale[axis] = std::nextafter(static_cast<float>(grid_counts / length), 0.0f);
    }
    return {box.lo[0], box.lo[1], box.lo[2], scale[0], scale[1], scale[2], STOKES_BVH_EMPTY, 0};
}

class Writer {
  public:
    Writer(const std::vector<Triangle>& triangles, const std::vector<BvhRef>& refs, Bvh& bvh)
        : triangles_(triangles), refs_(refs), bvh_(bvh) {}

    // Returns the child word.
    std::uint32_t write(const BvhTree& tree) {
        return tree.leaf() ? write_block(tree.range) : write_node(tree);
    }

  private:
    // The blocks of one node lie together; nodes stand depth first.
    std::uint32_t write_node(const BvhTree& tree) {
        const std::vector<const BvhTree*> children = wide_children(tree);
        const auto index = static_cast<std::uint32_t>(bvh_.nodes.size());
        bvh_.nodes.push_back(bound(children));
        for (const bool leaves : {true, false})
            for (std::size_t slot = 0; slot < children.size(); ++slot) {
                if (children[slot]->leaf() != leaves) continue;
                const std::uint32_t child = write(*children[slot]);
                bvh_.nodes[index].child[slot] = child;
            }
        return index;
    }

    BvhNode bound(const std::vector<const BvhTree*>& children) const {
        const BvhGrid& grid = bvh_.grid;
        BvhNode node{};
        for (std::size_t slot = 0; slot < STOKES_BVH_WIDTH; ++slot) {
            node.lo_x[slot] = node.lo_y[slot] = node.lo_z[slot] = 65535;
            node.child[slot] = STOKES_BVH_LEAF;
        }
        const auto count = [](float x, float origin, float scale) {
            return (static_cast<double>(x) - origin) * scale;
        };
        const auto below = [](double c) {
            return static_cast<unsigned short>(std::clamp(std::floor(c), 0.0, grid_counts));
        };
        const auto above = [](double c) {
            return static_cast<unsigned short>(std::clamp(std::ceil(c), 0.0, grid_counts));
        };
        for (std::size_t slot = 0; slot < children.size(); ++slot) {
            const BvhBox& box = children[slot]->range.box;
            node.lo_x[slot] = below(count(box.lo[0], grid.origin_x, grid.scale_x));
            node.lo_y[slot] = below(count(box.lo[1], grid.origin_y, grid.scale_y));
            node.lo_z[slot] = below(count(box.lo[2], grid.origin_z, grid.scale_z));
            node.hi_x[slot] = above(count(box.hi[0], grid.origin_x, grid.scale_x));
            node.hi_y[slot] = above(count(box.hi[1], grid.origin_y, grid.scale_y));
            node.hi_z[slot] = above(count(box.hi[2], grid.origin_z, grid.scale_z));
        }
        return node;
    }

    std::uint32_t write_block(const BvhRange& range) {
        std::vector<std::uint32_t> members;
        for (std::uint32_t i = range.begin; i < range.end; ++i) members.push_back(refs_[i].triangle);
        std::sort(members.begin(), members.end());
        BvhBlock block{};
        for (std::size_t lane = 0; lane < 8; ++lane) {
            const bool used = lane < members.size();
            const Corners at = corners_of(triangles_[used ? members[lane] : members.front()]);
            const std::size_t second = used ? 1 : 0, third = used ? 2 : 0;
            block.v0x[lane] = at[0][0], block.v0y[lane] = at[0][1], block.v0z[lane] = at[0][2];
            block.v1x[lane] = at[second][0], block.v1y[lane] = at[second][1], block.v1z[lane] = at[second][2];
            block.v2x[lane] = at[third][0], block.v2y[lane] = at[third][1], block.v2z[lane] = at[third][2];
            block.triangle[lane] = used ? members[lane] : STOKES_NONE;
        }
        bvh_.blocks.push_back(block);
        return STOKES_BVH_LEAF | static_cast<std::uint32_t>(bvh_.blocks.size() - 1);
    }

    const std::vector<Triangle>& triangles_;
    const std::vector<BvhRef>& refs_;
    Bvh& bvh_;
};

}  // namespace

Bvh build_bvh(const std::vector<Triangle>& triangles, unsigned threads) {
    Bvh bvh;
    std::vector<BvhRef> refs = make_refs(triangles);
    const auto count = static_cast<std::uint32_t>(refs.size());
    const BvhRange all = make_range(refs, 0, count);
    bvh.grid = make_grid(count > 0 ? all.box : BvhBox{{0, 0, 0}, {0, 0, 0}});
    if (count == 0) return bvh;

    if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
    std::unique_ptr<BvhTree> tree;
    for (const int area_levels : area_levels_tried) {
        tree = build_tree(refs, all, area_levels, threads);
        if (wide_levels(*tree) <= STOKES_BVH_LEVELS) break;
    }
    bvh.grid.root = Writer(triangles, refs, bvh).write(*tree);
    return bvh;
}

}  // namespace stokes
