// Writes the BVH builder's tree out as the nodes and blocks that kernels read.
#pragma once

#include <vector>

#include "host/scene/bvh/bvh_builder.hpp"
#include "host/scene/bvh/bvh_tree.hpp"

namespace stokes {

// Fills nodes, node_count, blocks and grid.root of a Bvh whose layout and grid are set; automatic bounds are
// resolved. False, and nothing done, when the tree has more than STOKES_BVH_LEVELS levels of nodes.
bool write_bvh(const BvhTree& tree, const std::vector<Triangle>& triangles, unsigned threads, Bvh& bvh);

}  // namespace stokes
