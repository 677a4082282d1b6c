#include "host/scene/bvh/bvh_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <thread>
#include <utility>

#include "host/core/error.hpp"
#include "host/scene/bvh/bvh_parallel.hpp"
#include "host/scene/bvh/bvh_tree.hpp"
#include "host/scene/bvh/bvh_writer.hpp"

namespace stokes {

namespace {

constexpr double grid_counts = 65535.0;
constexpr float farthest_mm = 1e12f;  // cubes of lengths stay far inside the range of a float

// Levels of the binary tree that are split by area. Even halves take 2^28 blocks in 28 levels, so that the
// last entry keeps within STOKES_BVH_LEVELS whatever the triangles.
constexpr std::array<int, 3> area_levels_tried{96, 24, STOKES_BVH_LEVELS - 28};

// Spatial splits may add as many refs as there are triangles. Small scenes may add more: 6 MB of blocks.
constexpr std::size_t always_added = 1 << 17;

// A tree with spatial splits is taken when its expected cost is at most this share of that of a tree without:
// splits that pay one by one, as of a hall's walls beside small triangles, need not pay together.
constexpr float most_cut_cost = 0.95f;

bool placeable(const BvhBox& box) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!(box.lo[axis] >= -farthest_mm && box.hi[axis] <= farthest_mm)) return false;
    return true;
}

// A set of all triangles.
BvhSet make_set(const std::vector<Triangle>& triangles, unsigned threads) {
    const auto count = static_cast<std::uint32_t>(triangles.size());
    BvhSet set;
    set.storage = std::make_shared<std::vector<BvhRef>>(count);
    set.end = count;
    struct Part {
        BvhBox box;
        std::uint32_t misplaced = STOKES_NONE;  // the first
    };
    const auto chunks = make_chunks(threads, 0, count);
    for (const Part& part : run_chunks<Part>(threads, chunks, [&](std::uint32_t begin, std::uint32_t end) {
             Part made;
             for (std::uint32_t i = begin; i < end; ++i) {
                 BvhRef& ref = set.ref(i);
                 ref.triangle = i;
                 bool finite = true;
                 for (const std::array<float, 3>& corner : corners_of(triangles[i])) {
                     ref.box.add({corner, corner});
                     for (const float x : corner) finite = finite && std::isfinite(x);
                 }
                 if (made.misplaced == STOKES_NONE && !(finite && placeable(ref.box))) made.misplaced = i;
                 made.box.add(ref.box);
             }
             return made;
         })) {
        if (part.misplaced != STOKES_NONE)
            throw InputError("triangle " + std::to_string(part.misplaced) +
                             ": expected finite corners within 1e12 mm of the origin");
        set.box.add(part.box);
    }
    return set;
}

// A flat axis takes part of the largest extent, a scene without any extent 1 mm.
BvhGrid make_grid(const BvhBox& box) {
    std::array<double, 3> extent{};
    for (std::size_t axis = 0; axis < 3; ++axis) extent[axis] = static_cast<double>(box.hi[axis]) - box.lo[axis];
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
    if (triangles.size() > STOKES_BVH_LEAF) throw InputError("the scene has more than 2^31 triangles");
    if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
    Bvh bvh;
    bvh.layout = layout;
    if (triangles.empty()) {
        bvh.grid = make_grid({{0, 0, 0}, {0, 0, 0}});
        if (layout.bounds == BvhBounds::automatic) bvh.layout.bounds = BvhBounds::counts;
        return bvh;
    }
    const auto build = [&](int area_levels, std::size_t spare, bool& may_cut) {
        BvhSet all = make_set(triangles, threads);
        all.spare = spare;
        bvh.grid = make_grid(all.box);
        const BvhClipper clipper(triangles, all.box);
        return build_tree(std::move(all), clipper, {layout.width, area_levels, threads}, may_cut);
    };
    for (const int area_levels : area_levels_tried) {
        bool may_cut = false;
        const auto tree = build(area_levels, 0, may_cut);
        if (may_cut && area_levels == area_levels_tried.front()) {
            const auto cut = build(area_levels, std::max(triangles.size(), always_added), may_cut);
            if (cut->cost() <= most_cut_cost * tree->cost() && write_bvh(*cut, triangles, threads, bvh)) break;
        }
        if (write_bvh(*tree, triangles, threads, bvh)) break;
    }
    return bvh;
}

std::vector<std::string> bvh_kernel_options(const BvhLayout& layout) {
    std::vector<std::string> options;
    if (layout.width == 8) options.push_back("-DSTOKES_BVH_WIDTH=8");
    if (layout.bounds == BvhBounds::floats) options.push_back("-DSTOKES_BVH_FLOAT");
    return options;
}

}  // namespace stokes
