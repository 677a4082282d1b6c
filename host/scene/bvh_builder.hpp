// Bounding volume hierarchy over the scene's triangles, in the layout that kernels traverse.
#pragma once

#include <vector>

#include "kernels/shared/bvh.h"
#include "kernels/shared/ray.h"

namespace stokes {

struct Bvh {
    std::vector<BvhNode> nodes;
    std::vector<BvhBlock> blocks;
    BvhGrid grid{};  // grid.root: where traversal starts
};

// Builds the hierarchy by the binned surface area heuristic with cost per block of eight triangles (Wald
// 2007, "On fast construction of SAH-based bounding volume hierarchies"), made 16-wide by the optimal
// collapse of Ylitie, Karras and Laine 2017, "Efficient incoherent ray traversal on GPUs through compressed
// wide BVHs". Corners [mm] are v0, v0 + e1, v0 + e2 rounded to float. Every triangle lies in exactly one
// block, degenerate ones included; there are at most STOKES_BVH_LEVELS levels of nodes. The result is the
// same for any number of threads (0: as many as the machine has). InputError for a corner that is not finite
// or farther than 1e12 mm from the origin on an axis, and for more than 2^31 triangles.
Bvh build_bvh(const std::vector<Triangle>& triangles, unsigned threads = 0);

}  // namespace stokes
