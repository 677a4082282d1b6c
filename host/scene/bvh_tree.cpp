#include "host/scene/bvh_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <future>

namespace stokes {

namespace {

constexpr float node_cost = 1.0f;   // test of a node's boxes
constexpr float block_cost = 1.0f;  // test of eight triangles
constexpr std::uint32_t fork_from = 4096;

// The least cost of count children below a node, and how many of them go to the left.
std::pair<float, std::uint8_t> best_distribution(const BvhTree& tree, int count) {
    std::pair<float, std::uint8_t> best{BvhBox::infinity, std::uint8_t{0}};
    for (int k = 1; k < count; ++k) {
        const float cost = tree.left->forest_cost[k - 1] + tree.right->forest_cost[count - k - 1];
        if (cost < best.first) best = {cost, static_cast<std::uint8_t>(k)};
    }
    return best;
}

// The optimal collapse of a binary tree by dynamic programming: Ylitie, Karras and Laine 2017, "Efficient
// incoherent ray traversal on GPUs through compressed wide BVHs", section 3.
void choose_forests(BvhTree& tree, int width) {
    const auto area = static_cast<float>(tree.range.box.half_area());
    if (tree.leaf()) {
        tree.forest_cost.fill(area * block_cost);
        return;
    }
    const auto [below, split] = best_distribution(tree, width);
    tree.by[width - 1] = split;
    tree.forest_cost[0] = area * node_cost + below;
    for (int i = 2; i < width; ++i) {
        const auto [cost, by] = best_distribution(tree, i);
        const bool fewer = tree.forest_cost[i - 2] <= cost;
        tree.forest_cost[i - 1] = fewer ? tree.forest_cost[i - 2] : cost;
        tree.by[i - 1] = fewer ? tree.by[i - 2] : by;
    }
}

struct TreeBuilder {
    std::vector<BvhRef>& refs;
    int width;
    int area_levels;
    int fork_levels;

    std::unique_ptr<BvhTree> build(const BvhRange& range, int level) const {
        auto tree = std::make_unique<BvhTree>();
        tree->range = range;
        if (range.count() > 8) {
            const auto [l, r] = level < area_levels ? split_by_area(refs, range) : split_evenly(refs, range);
            if (level < fork_levels && range.count() >= fork_from) {
                auto left = std::async(std::launch::async,
                                       [this, part = l, level] { return build(part, level + 1); });
                tree->right = build(r, level + 1);
                tree->left = left.get();
            } else {
                tree->left = build(l, level + 1);
                tree->right = build(r, level + 1);
            }
        }
        choose_forests(*tree, width);
        return tree;
    }
};

void collect(const BvhTree& tree, int count, std::vector<const BvhTree*>& children) {
    const int left = tree.by[count - 1];
    if (left == 0) {
        children.push_back(&tree);
        return;
    }
    collect(*tree.left, left, children);
    collect(*tree.right, count - left, children);
}

}  // namespace

std::unique_ptr<BvhTree> build_tree(std::vector<BvhRef>& refs, const BvhRange& range, int width, int area_levels,
                                    unsigned threads) {
    int fork_levels = 0;
    while (threads > 1 && fork_levels < 8 && (1u << fork_levels) < 4 * threads) ++fork_levels;
    return TreeBuilder{refs, width, area_levels, fork_levels}.build(range, 0);
}

std::vector<const BvhTree*> wide_children(const BvhTree& tree, int width) {
    std::vector<const BvhTree*> children;
    collect(tree, width, children);
    std::stable_sort(children.begin(), children.end(), [](const BvhTree* a, const BvhTree* b) {
        return a->range.box.half_area() > b->range.box.half_area();
    });
    return children;
}

int wide_levels(const BvhTree& tree, int width) {
    if (tree.leaf()) return 0;
    int below = 0;
    for (const BvhTree* child : wide_children(tree, width)) below = std::max(below, wide_levels(*child, width));
    return below + 1;
}

}  // namespace stokes
