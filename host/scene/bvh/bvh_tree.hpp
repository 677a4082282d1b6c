// The BVH builder's binary tree, and which of its nodes become the children of a wide one.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "host/scene/bvh/bvh_clip.hpp"
#include "host/scene/bvh/bvh_split.hpp"

namespace stokes {

struct BvhTree {
    static constexpr int widest = 16;  // most children of a wide node

    BvhBox box;
    std::unique_ptr<BvhTree> left, right;  // both or none

    // forest_cost[i - 1]: least expected cost of the refs as at most i children of one wide node, in box
    // areas times tests; by[i - 1]: how many of the i go to the left half, 0: this node is a single child.
    std::array<float, widest - 1> forest_cost{};
    std::array<std::uint8_t, widest> by{};

    // Of a leaf, in rising order.
    std::uint32_t triangle_count = 0;
    std::array<std::uint32_t, 8> triangles{};

    bool leaf() const { return left == nullptr; }
    float cost() const { return forest_cost[0]; }
};

struct BvhTreeOptions {
    int width = 16;        // of the nodes that children are chosen for
    int area_levels = 96;  // split by area down to here, evenly below
    unsigned threads = 1;  // share the work, the tree is the same for any number
};

// A tree of all refs of a set that is not empty, with spatial splits while the set has refs to spare. may_cut: set
// when halves overlap so much somewhere that spatial splits may pay.
std::unique_ptr<BvhTree> build_tree(BvhSet set, const BvhClipper& clipper, const BvhTreeOptions& options,
                                    bool& may_cut);

// The children, at most width, of the wide node that stands for an inner node of the tree, by falling surface
// area.
std::vector<const BvhTree*> wide_children(const BvhTree& tree, int width);

}  // namespace stokes
