#include "host/scene/bvh/bvh_writer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "host/core/error.hpp"
#include "host/scene/bvh/bvh_parallel.hpp"

namespace stokes {

namespace {

constexpr double grid_counts = 65535.0;
constexpr std::size_t most_nodes = std::size_t{1} << 28;

// How far counts may raise the mean number of tests that follow from one. Float nodes are tested as fast but
// 1.75 times as large; nodes of counts make up a twentieth of nodes and blocks.
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

double half_area(const std::array<double, 3>& side) {
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
}

// Half areas of a box and of the box rounded to counts [mm^2].
std::pair<double, double> half_areas(const BvhBox& box, const BvhGrid& grid) {
    const GridBox on = on_grid(box, grid);
    const std::array<double, 3> scale{grid.scale_x, grid.scale_y, grid.scale_z};
    std::array<double, 3> exact{}, counted{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        exact[axis] = (on.hi[axis] - on.lo[axis]) / scale[axis];
        counted[axis] = (above<unsigned short>(on.hi[axis]) - below<unsigned short>(on.lo[axis])) / scale[axis];
    }
    return {half_area(exact), half_area(counted)};
}

// A wide node: its children, the first of them leaves, and their child words.
struct WideNode {
    std::array<const BvhTree*, BvhTree::widest> children{};
    std::array<std::uint32_t, BvhTree::widest> words{};
};

// All wide nodes, depth first. The blocks of one node lie together.
struct WideTree {
    explicit WideTree(int most_children) : width(most_children) {}

    int width;
    std::vector<WideNode> nodes;
    std::uint32_t blocks = 0;
    int levels = 0;

    // Returns the child word.
    std::uint32_t add(const BvhTree& tree, int level = 1) {
        if (tree.leaf()) return STOKES_BVH_LEAF | blocks++;
        levels = std::max(levels, level);
        const auto index = static_cast<std::uint32_t>(nodes.size());
        nodes.emplace_back();
        const std::vector<const BvhTree*> children = wide_children(tree, width);
        for (const bool leaves : {true, false})
            for (std::size_t slot = 0; slot < children.size(); ++slot) {
                if (children[slot]->leaf() != leaves) continue;
                const std::uint32_t word = add(*children[slot], level + 1);
                nodes[index].children[slot] = children[slot];
                nodes[index].words[slot] = word;
            }
        return index;
    }
};

BvhBlock make_block(const BvhTree& leaf, const std::vector<Triangle>& triangles) {
    BvhBlock block{};
    for (std::size_t lane = 0; lane < 8; ++lane) {
        const bool used = lane < leaf.triangle_count;
        const BvhCorners at = corners_of(triangles[leaf.triangles[used ? lane : 0]]);
        const std::size_t second = used ? 1 : 0, third = used ? 2 : 0;
        block.v0x[lane] = at[0][0], block.v0y[lane] = at[0][1], block.v0z[lane] = at[0][2];
        block.v1x[lane] = at[second][0], block.v1y[lane] = at[second][1], block.v1z[lane] = at[second][2];
        block.v2x[lane] = at[third][0], block.v2y[lane] = at[third][1], block.v2z[lane] = at[third][2];
        block.triangle[lane] = used ? leaf.triangles[lane] : STOKES_NONE;
    }
    return block;
}

template <class Node, class Bound>
Node make_node(const WideNode& wide, const BvhGrid& grid) {
    constexpr std::size_t width = sizeof(Node::child) / 4;
    Node node{};
    for (std::size_t slot = 0; slot < width; ++slot) {
        if (wide.children[slot] == nullptr) {
            node.lo_x[slot] = node.lo_y[slot] = node.lo_z[slot] = 65535;
            node.child[slot] = STOKES_BVH_LEAF;
            continue;
        }
        const GridBox box = on_grid(wide.children[slot]->box, grid);
        node.lo_x[slot] = below<Bound>(box.lo[0]);
        node.lo_y[slot] = below<Bound>(box.lo[1]);
        node.lo_z[slot] = below<Bound>(box.lo[2]);
        node.hi_x[slot] = above<Bound>(box.hi[0]);
        node.hi_y[slot] = above<Bound>(box.hi[1]);
        node.hi_z[slot] = above<Bound>(box.hi[2]);
        node.child[slot] = wide.words[slot];
    }
    return node;
}

template <class Node, class Bound>
void write_nodes(const WideTree& wide, unsigned threads, Bvh& bvh) {
    constexpr std::size_t words = sizeof(Node) / 4;
    bvh.nodes.resize(wide.nodes.size() * words);
    const auto chunks = make_chunks(threads, 0, static_cast<std::uint32_t>(wide.nodes.size()));
    run_parallel(threads, chunks.size(), [&](std::size_t chunk) {
        for (std::size_t i = chunks[chunk].first; i < chunks[chunk].second; ++i) {
            const Node node = make_node<Node, Bound>(wide.nodes[i], bvh.grid);
            std::memcpy(bvh.nodes.data() + i * words, &node, sizeof node);
        }
    });
}

void write_blocks(const WideTree& wide, const std::vector<Triangle>& triangles, unsigned threads, Bvh& bvh) {
    const auto chunks = make_chunks(threads, 0, static_cast<std::uint32_t>(wide.nodes.size()));
    run_parallel(threads, chunks.size(), [&](std::size_t chunk) {
        for (std::size_t i = chunks[chunk].first; i < chunks[chunk].second; ++i) {
            const WideNode& node = wide.nodes[i];
            for (std::size_t slot = 0; slot < node.children.size(); ++slot)
                if (node.children[slot] != nullptr && node.children[slot]->leaf())
                    bvh.blocks[node.words[slot] ^ STOKES_BVH_LEAF] = make_block(*node.children[slot], triangles);
        }
    });
}

// By how much counts raise the tests below a node that a ray has reached, on average over all children. Rays
// need not be spread over the scene: what is small beside it may be all that is looked at.
BvhBounds choose_bounds(const WideTree& wide, const BvhGrid& grid) {
    double raised = 0.0, children = 0.0;
    for (const WideNode& node : wide.nodes) {
        double exact = 0.0, counted = 0.0, count = 0.0;
        for (const BvhTree* child : node.children) {
            if (child == nullptr) continue;
            const auto [area, counted_area] = half_areas(child->box, grid);
            exact += area;
            counted += counted_area;
            count += 1.0;
        }
        if (!(exact > 0.0)) continue;  // points and lines, which rays hardly ever meet
        raised += count * counted / exact;
        children += count;
    }
    return raised > most_count_cost * children ? BvhBounds::floats : BvhBounds::counts;
}

}  // namespace

bool write_bvh(const BvhTree& tree, const std::vector<Triangle>& triangles, unsigned threads, Bvh& bvh) {
    WideTree wide(bvh.layout.width);
    const std::uint32_t root = wide.add(tree);
    if (wide.levels > STOKES_BVH_LEVELS) return false;
    bvh.grid.root = root;
    bvh.node_count = wide.nodes.size();
    // Packets of rays keep a node and its child in one word.
    if (bvh.node_count > most_nodes) throw InputError("the scene's bounding volumes have more than 2^28 nodes");
    bvh.blocks.resize(wide.blocks);
    if (tree.leaf()) bvh.blocks[0] = make_block(tree, triangles);
    write_blocks(wide, triangles, threads, bvh);
    if (bvh.layout.bounds == BvhBounds::automatic) bvh.layout.bounds = choose_bounds(wide, bvh.grid);
    const bool floats = bvh.layout.bounds == BvhBounds::floats;
    if (bvh.layout.width == 16 && !floats) write_nodes<BvhNode16, unsigned short>(wide, threads, bvh);
    if (bvh.layout.width == 16 && floats) write_nodes<BvhNode16f, float>(wide, threads, bvh);
    if (bvh.layout.width == 8 && !floats) write_nodes<BvhNode8, unsigned short>(wide, threads, bvh);
    if (bvh.layout.width == 8 && floats) write_nodes<BvhNode8f, float>(wide, threads, bvh);
    return true;
}

}  // namespace stokes
