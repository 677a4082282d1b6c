#include "host/scene/bvh_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <thread>

#include "host/core/error.hpp"
#include "host/scene/bvh_tree.hpp"
#include "host/scene/bvh_writer.hpp"

namespace stokes {

namespace {

constexpr double grid_counts = 65535.0;
constexpr float farthest_mm = 1e12f;  // cubes of lengths stay far inside the range of a float

// Levels of the binary tree that are split by area. Even halves take 2^28 blocks in 28 levels, so that the
// last entry keeps within STOKES_BVH_LEVELS whatever the triangles.
constexpr std::array<int, 3> area_levels_tried{96, 24, STOKES_BVH_LEVELS - 28};

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

}  // namespace

Bvh build_bvh(const std::vector<Triangle>& triangles, const BvhLayout& layout, unsigned threads) {
    if (layout.width != 8 && layout.width != 16) throw InputError("BVH width: expected 8 or 16");
    Bvh bvh;
    bvh.layout = layout;
    std::vector<BvhRef> refs = make_refs(triangles);
    const auto count = static_cast<std::uint32_t>(refs.size());
    const BvhRange all = make_range(refs, 0, count);
    bvh.grid = make_grid(count > 0 ? all.box : BvhBox{{0, 0, 0}, {0, 0, 0}});
    if (count == 0) {
        if (layout.bounds == BvhBounds::automatic) bvh.layout.bounds = BvhBounds::counts;
        return bvh;
    }

    if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
    std::unique_ptr<BvhTree> tree;
    for (const int area_levels : area_levels_tried) {
        tree = build_tree(refs, all, layout.width, area_levels, threads);
        if (wide_levels(*tree, layout.width) <= STOKES_BVH_LEVELS) break;
    }
    write_bvh(*tree, refs, triangles, bvh);
    return bvh;
}

std::vector<std::string> bvh_kernel_options(const BvhLayout& layout) {
    std::vector<std::string> options;
    if (layout.width == 8) options.push_back("-DSTOKES_BVH_WIDTH=8");
    if (layout.bounds == BvhBounds::floats) options.push_back("-DSTOKES_BVH_FLOAT");
    return options;
}

}  // namespace stokes
