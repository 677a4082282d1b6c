// Writes the BVH builder's tree out as the nodes and blocks that kernels read.
#pragma once

#include <array>
#include <vector>

#include "host/scene/bvh_builder.hpp"
#include "host/scene/bvh_tree.hpp"

namespace stokes {

using BvhCorners = std::array<std::array<float, 3>, 3>;

// v0, v0 + e1, v0 + e2, rounded to float [mm].
BvhCorners corners_of(const Triangle& triangle);

// Fills nodes, node_count, blocks and grid.root of a Bvh whose layout and grid are set; automatic bounds are
// resolved.
void write_bvh(const BvhTree& tree, const std::vector<BvhRef>& refs, const std::vector<Triangle>& triangles, Bvh& bvh);

}  // namespace stokes
