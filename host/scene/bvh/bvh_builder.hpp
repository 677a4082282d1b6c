// Bounding volume hierarchy over the scene's triangles, in the layout that kernels traverse.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/shared/bvh.h"
#include "kernels/shared/ray.h"

namespace stokes {

// How nodes keep the bounds of their children. automatic: as floats where counts would cost too much, because
// much of the scene is small beside the whole.
enum class BvhBounds { automatic, counts, floats };

struct BvhLayout {
    int width = 16;  // children of a node, 8 or 16
    BvhBounds bounds = BvhBounds::automatic;
};

struct Bvh {
    BvhLayout layout;                  // as built: its bounds are counts or floats
    std::vector<std::uint32_t> nodes;  // BvhNode16, BvhNode16f, BvhNode8 or BvhNode8f, in words of 32 bits
    std::size_t node_count = 0;
    std::vector<BvhBlock> blocks;
    BvhGrid grid{};  // grid.root: where traversal starts
};

// Builds the hierarchy by the binned surface area heuristic with cost per block of eight triangles (Wald
// 2007, "On fast construction of SAH-based bounding volume hierarchies"), with spatial splits where they pay
// (Stich, Friedrich and Dietrich 2009, "Spatial splits in bounding volume hierarchies"), made wide by the
// optimal collapse of Ylitie, Karras and Laine 2017, "Efficient incoherent ray traversal on GPUs through
// compressed wide BVHs". Corners [mm] are v0, v0 + e1, v0 + e2 rounded to float. Every triangle lies in at
// least one block, degenerate ones included, and every point of it below one of them in all boxes above; all
// blocks together hold at most twice the triangles, or 2^17 more. There are at most STOKES_BVH_LEVELS levels
// of nodes. The result is the same for any number of threads (0: as many as the machine has). InputError for
// a corner that is not finite or farther than 1e12 mm from the origin on an axis, for more than 2^31
// triangles, and for another width.
Bvh build_bvh(const std::vector<Triangle>& triangles, const BvhLayout& layout = {}, unsigned threads = 0);

// Build options of kernels that traverse such nodes (kernels/shared/bvh.h); automatic: as counts.
std::vector<std::string> bvh_kernel_options(const BvhLayout& layout);

}  // namespace stokes
