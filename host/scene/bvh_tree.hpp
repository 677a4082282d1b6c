// The BVH builder's binary tree, and which of its nodes become the children of a wide one.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "host/scene/bvh_split.hpp"

namespace stokes {

// A leaf holds at most eight refs.
struct BvhTree {
    static constexpr int widest = 16;  // most children of a wide node

    BvhRange range;
    std::unique_ptr<BvhTree> left, right;  // both or none

    // forest_cost[i - 1]: least expected cost of the refs as at most i children of one wide node, in box
    // areas times tests; by[i - 1]: how many of the i go to the left half, 0: this node is a single child.
    std::array<float, widest - 1> forest_cost{};
    std::array<std::uint8_t, widest> by{};

    bool leaf() const { return left == nullptr; }
};

// Splits by area down to area_levels levels, evenly below, and chooses children for nodes of the width. A pure
// function of refs: threads only share the work.
std::unique_ptr<BvhTree> build_tree(std::vector<BvhRef>& refs, const BvhRange& range, int width, int area_levels,
                                    unsigned threads);

// The children, at most width, of the wide node that stands for an inner node of the tree, by falling surface
// area.
std::vector<const BvhTree*> wide_children(const BvhTree& tree, int width);

// Levels of wide nodes below and with this node; 0 for a leaf.
int wide_levels(const BvhTree& tree, int width);

}  // namespace stokes
