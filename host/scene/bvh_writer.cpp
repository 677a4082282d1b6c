#include "host/scene/bvh_writer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace stokes {

namespace {

constexpr double grid_counts = 65535.0;

// How far counts may raise the expected number of tests above that of exact boxes. Float nodes are 1.75 times
// as large.
constexpr double most_count_cost = 1.15;

struct GridBox {
    std::array<double, 3> lo, hi;
};

GridBox on_grid(const BvhBox& box, const BvhGrid& grid) {
    const std::array<float, 3> origin{grid.origin_x, grid.origin_y, grid.origin_z};
    const std::array<float, 3> scale{grid.scale_x, grid.scale_y, grid.scale_z};
    GridBox result{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        result.lo[axis] = (static_cast<double>(box.lo[axis]) - origin[axis]) * scale[axis];
        result.hi[axis] = (static_cast<double>(box.hi[axis]) - origin[axis]) * scale[axis];
    }
    return result;
}

// To the nearest value of a bound outward.
template <class T>
T below(double x);
template <class T>
T above(double x);
template <>
unsigned short below<unsigned short>(double x) {
    return static_cast<unsigned short>(std::clamp(std::floor(x), 0.0, grid_counts));
}
template <>
unsigned short above<unsigned short>(double x) {
    return static_cast<unsigned short>(std::clamp(std::ceil(x), 0.0, grid_counts));
}
template <>
float below<float>(double x) {
    const auto rounded = static_cast<float>(std::clamp(x, 0.0, grid_counts));
    return rounded <= x ? rounded : std::nextafter(rounded, 0.0f);
}
template <>
float above<float>(double x) {
    const auto rounded = static_cast<float>(std::clamp(x, 0.0, grid_counts));
    return rounded >= x ? rounded : std::nextafter(rounded, std::numeric_limits<float>::infinity());
}

// The expected number of tests of what hangs below wide nodes, by exact boxes and by boxes rounded to counts,
// but for a common factor.
struct Cost {
    double exact = 0.0, counted = 0.0;
};

void add_cost(const BvhTree& tree, int width, const BvhGrid& grid, Cost& cost) {
    for (const BvhTree* child : wide_children(tree, width)) {
        const GridBox box = on_grid(child->range.box, grid);
        const std::array<double, 3> scale{grid.scale_x, grid.scale_y, grid.scale_z};
        std::array<double, 3> exact{}, counted{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            exact[axis] = (box.hi[axis] - box.lo[axis]) / scale[axis];
            counted[axis] =
                (above<unsigned short>(box.hi[axis]) - below<unsigned short>(box.lo[axis])) / scale[axis];
        }
        cost.exact += exact[0] * exact[1] + exact[1] * exact[2] + exact[2] * exact[0];
        cost.counted += counted[0] * counted[1] + counted[1] * counted[2] + counted[2] * counted[0];
        if (!child->leaf()) add_cost(*child, width, grid, cost);
    }
}

template <class Node, class Bound>
class Writer {
  public:
    Writer(const std::vector<Triangle>& triangles, const std::vector<BvhRef>& refs, Bvh& bvh)
        : triangles_(triangles), refs_(refs), bvh_(bvh) {}

    void write_all(const BvhTree& tree) {
        bvh_.grid.root = write(tree);
        bvh_.node_count = nodes_.size();
        bvh_.nodes.resize(nodes_.size() * sizeof(Node) / 4);
        if (!nodes_.empty()) std::memcpy(bvh_.nodes.data(), nodes_.data(), nodes_.size() * sizeof(Node));
    }

  private:
    static constexpr int width = sizeof(Node::child) / 4;

    // Returns the child word.
    std::uint32_t write(const BvhTree& tree) {
        return tree.leaf() ? write_block(tree.range) : write_node(tree);
    }

    // The blocks of one node lie together; nodes stand depth first.
    std::uint32_t write_node(const BvhTree& tree) {
        const std::vector<const BvhTree*> children = wide_children(tree, width);
        const auto index = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back(bound(children));
        for (const bool leaves : {true, false})
            for (std::size_t slot = 0; slot < children.size(); ++slot) {
                if (children[slot]->leaf() != leaves) continue;
                const std::uint32_t child = write(*children[slot]);
                nodes_[index].child[slot] = child;
            }
        return index;
    }

    Node bound(const std::vector<const BvhTree*>& children) const {
        Node node{};
        for (std::size_t slot = 0; slot < width; ++slot) {
            node.lo_x[slot] = node.lo_y[slot] = node.lo_z[slot] = 65535;
            node.child[slot] = STOKES_BVH_LEAF;
        }
        for (std::size_t slot = 0; slot < children.size(); ++slot) {
            const GridBox box = on_grid(children[slot]->range.box, bvh_.grid);
            node.lo_x[slot] = below<Bound>(box.lo[0]);
            node.lo_y[slot] = below<Bound>(box.lo[1]);
            node.lo_z[slot] = below<Bound>(box.lo[2]);
            node.hi_x[slot] = above<Bound>(box.hi[0]);
            node.hi_y[slot] = above<Bound>(box.hi[1]);
            node.hi_z[slot] = above<Bound>(box.hi[2]);
        }
        return node;
    }

    std::uint32_t write_block(const BvhRange& range) {
        std::vector<std::uint32_t> members;
        for (std::uint32_t i = range.begin; i < range.end; ++i) members.push_back(refs_[i].triangle);
        std::sort(members.begin(), members.end());
        BvhBlock block{};
        for (std::size_t lane = 0; lane < 8; ++lane) {
            const bool used = lane < members.size();
            const BvhCorners at = corners_of(triangles_[used ? members[lane] : members.front()]);
            const std::size_t second = used ? 1 : 0, third = used ? 2 : 0;
            block.v0x[lane] = at[0][0], block.v0y[lane] = at[0][1], block.v0z[lane] = at[0][2];
            block.v1x[lane] = at[second][0], block.v1y[lane] = at[second][1], block.v1z[lane] = at[second][2];
            block.v2x[lane] = at[third][0], block.v2y[lane] = at[third][1], block.v2z[lane] = at[third][2];
            block.triangle[lane] = used ? members[lane] : STOKES_NONE;
        }
        bvh_.blocks.push_back(block);
        return STOKES_BVH_LEAF | static_cast<std::uint32_t>(bvh_.blocks.size() - 1);
    }

    const std::vector<Triangle>& triangles_;
    const std::vector<BvhRef>& refs_;
    std::vector<Node> nodes_;
    Bvh& bvh_;
};

template <class Node, class Bound>
void write_as(const BvhTree& tree, const std::vector<BvhRef>& refs, const std::vector<Triangle>& triangles, Bvh& bvh) {
    Writer<Node, Bound>(triangles, refs, bvh).write_all(tree);
}

}  // namespace

BvhCorners corners_of(const Triangle& t) {
    const auto sum = [](float a, float b) { return static_cast<float>(static_cast<double>(a) + b); };
    return {{{t.v0x, t.v0y, t.v0z},
             {sum(t.v0x, t.e1x), sum(t.v0y, t.e1y), sum(t.v0z, t.e1z)},
             {sum(t.v0x, t.e2x), sum(t.v0y, t.e2y), sum(t.v0z, t.e2z)}}};
}

void write_bvh(const BvhTree& tree, const std::vector<BvhRef>& refs, const std::vector<Triangle>& triangles, Bvh& bvh) {
    BvhLayout& layout = bvh.layout;
    if (layout.bounds == BvhBounds::automatic) {
        Cost cost;
        if (!tree.leaf()) add_cost(tree, layout.width, bvh.grid, cost);
        layout.bounds = cost.counted > most_count_cost * cost.exact ? BvhBounds::floats : BvhBounds::counts;
    }
    const bool floats = layout.bounds == BvhBounds::floats;
    if (layout.width == 16 && !floats) write_as<BvhNode16, unsigned short>(tree, refs, triangles, bvh);
    if (layout.width == 16 && floats) write_as<BvhNode16f, float>(tree, refs, triangles, bvh);
    if (layout.width == 8 && !floats) write_as<BvhNode8, unsigned short>(tree, refs, triangles, bvh);
    if (layout.width == 8 && floats) write_as<BvhNode8f, float>(tree, refs, triangles, bvh);
}

}  // namespace stokes
