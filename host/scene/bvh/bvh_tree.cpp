#include "host/scene/bvh/bvh_tree.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <utility>

#include "host/scene/bvh/bvh_parallel.hpp"
#include "host/scene/bvh/bvh_spatial.hpp"

namespace stokes {

namespace {

constexpr float node_cost = 1.0f;   // test of a node's boxes
constexpr float block_cost = 1.0f;  // test of eight triangles

// Spatial splits are tried where the halves of an object split overlap by so much of the scene's area, and where
// the overlap, taken for all blocks, makes so much of the cost. Meshes rarely get there, long triangles do.
constexpr double least_overlap = 1e-5;
constexpr double least_overlap_cost = 0.5;

// A set that can spare less than one in four of its refs is not cut: little could come of it.
constexpr std::uint32_t least_spare = 4;

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
    const auto area = static_cast<float>(tree.box.half_area());
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

class TreeBuilder {
  public:
    TreeBuilder(const BvhSet& all, const BvhClipper& clipper, const BvhTreeOptions& options)
        : clipper_(clipper), options_(options), scene_area_(all.box.half_area()) {}

    std::unique_ptr<BvhTree> build(BvhSet all) {
        std::unique_ptr<BvhTree> root;
        if (options_.threads > 1)
            task_size_ = std::max(least_task, all.count() / (8 * options_.threads));
        else
            task_size_ = ~0u;
        plan(root, std::move(all), 0);
        std::stable_sort(tasks_.begin(), tasks_.end(),
                         [](const Task& a, const Task& b) { return a.set.count() > b.set.count(); });
        run_parallel(options_.threads, tasks_.size(), [this](std::size_t i) {
            *tasks_[i].place = build_below(std::move(tasks_[i].set), tasks_[i].level);
        });
        for (auto tree = planned_.rbegin(); tree != planned_.rend(); ++tree) choose_forests(**tree, options_.width);
        return root;
    }

    bool may_cut() const { return may_cut_; }

  private:
    static constexpr std::uint32_t least_task = 8192;

    struct Task {
        std::unique_ptr<BvhTree>* place;
        BvhSet set;
        int level;
    };

    // Large sets are split by all threads together, one after the other; smaller ones become tasks.
    void plan(std::unique_ptr<BvhTree>& place, BvhSet set, int level) {
        if (set.count() <= task_size_) {
            tasks_.push_back({&place, std::move(set), level});
            return;
        }
        place = std::make_unique<BvhTree>();
        place->box = set.box;
        planned_.push_back(place.get());
        BvhHalves halves = split(std::move(set), level, options_.threads);
        plan(place->left, std::move(halves.first), level + 1);
        plan(place->right, std::move(halves.second), level + 1);
    }

    std::unique_ptr<BvhTree> build_below(BvhSet set, int level) {
        auto tree = std::make_unique<BvhTree>();
        tree->box = set.box;
        if (set.count() > 8) {
            BvhHalves halves = split(std::move(set), level, 1);
            tree->left = build_below(std::move(halves.first), level + 1);
            tree->right = build_below(std::move(halves.second), level + 1);
        } else {
            for (std::uint32_t i = set.begin; i < set.end; ++i)
                tree->triangles[tree->triangle_count++] = set.ref(i).triangle;
        }
        choose_forests(*tree, options_.width);
        return tree;
    }

    BvhHalves split(BvhSet set, int level, unsigned threads) {
        if (level >= options_.area_levels) return split_evenly(std::move(set));
        ObjectSplit by_object = find_object_split(set, threads);
        const bool found = by_object.cost < BvhBox::infinity;
        if (!found) {
            by_object.cost = set.box.half_area() * set.blocks();
            by_object.left = by_object.right = set.box;
        }
        BvhHalves halves;
        const bool overlapping = overlap(set, by_object);
        if (overlapping) may_cut_ = true;
        if (overlapping && set.spare * least_spare >= set.count()) {
            const SpatialSplit by_plane = find_spatial_split(set, clipper_, threads);
            if (by_plane.cost < by_object.cost &&
                apply_split(set, by_plane, clipper_, by_object.cost, threads, halves)) {
                share(set.spare - (halves.first.count() + halves.second.count() - set.count()), halves);
                return halves;
            }
        }
        const std::uint64_t spare = set.spare;
        halves = found ? apply_split(std::move(set), by_object, threads) : split_evenly(std::move(set));
        share(spare, halves);
        return halves;
    }

    bool overlap(const BvhSet& set, const ObjectSplit& split) const {
        BvhBox common = split.left;
        common.cut(split.right);
        const double area = common.half_area();
        return area > least_overlap * scene_area_ && area * set.blocks() > least_overlap_cost * split.cost;
    }

    // What a set has left to spare goes where rays meet more refs.
    static void share(std::uint64_t spare, BvhHalves& halves) {
        const double left = halves.first.box.half_area() * halves.first.count();
        const double right = halves.second.box.half_area() * halves.second.count();
        const double part = left + right > 0.0 ? left / (left + right) : 0.5;
        halves.first.spare = std::min(spare, static_cast<std::uint64_t>(part * static_cast<double>(spare)));
        halves.second.spare = spare - halves.first.spare;
    }

    const BvhClipper& clipper_;
    BvhTreeOptions options_;
    double scene_area_;
    std::uint32_t task_size_ = 0;
    std::atomic<bool> may_cut_{false};
    std::vector<Task> tasks_;
    std::vector<BvhTree*> planned_;  // parents before children
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

std::unique_ptr<BvhTree> build_tree(BvhSet set, const BvhClipper& clipper, const BvhTreeOptions& options,
                                    bool& may_cut) {
    TreeBuilder builder(set, clipper, options);
    auto tree = builder.build(std::move(set));
    may_cut = builder.may_cut();
    return tree;
}

std::vector<const BvhTree*> wide_children(const BvhTree& tree, int width) {
    std::vector<const BvhTree*> children;
    collect(tree, width, children);
    std::stable_sort(children.begin(), children.end(),
                     [](const BvhTree* a, const BvhTree* b) { return a->box.half_area() > b->box.half_area(); });
    return children;
}

}  // namespace stokes
