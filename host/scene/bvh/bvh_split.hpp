// How the BVH builder divides a set of triangles in two.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace stokes {

struct BvhBox {
    std::array<float, 3> lo{infinity, infinity, infinity};     // [mm]
    std::array<float, 3> hi{-infinity, -infinity, -infinity};  // [mm]

    void add(const BvhBox& other);
    void cut(const BvhBox& other);  // to what both hold, which may be nothing
    bool empty() const { return !(lo[0] <= hi[0] && lo[1] <= hi[1] && lo[2] <= hi[2]); }
    double half_area() const;  // [mm^2], 0 when empty

    static constexpr float infinity = std::numeric_limits<float>::infinity();
};

// A triangle, or a part of one, as the builder moves it about, and its bounds.
struct BvhRef {
    BvhBox box;
    std::uint32_t triangle = 0;
};

// Some refs and their common box. Sets share storage, each with a range of its own. Refs stand in order of
// rising triangle index.
struct BvhSet {
    std::shared_ptr<std::vector<BvhRef>> storage;
    std::uint32_t begin = 0, end = 0;
    BvhBox box;
    std::uint64_t spare = 0;  // how many refs spatial splits may add below

    std::uint32_t count() const { return end - begin; }
    std::uint32_t blocks() const { return (count() + 7) / 8; }
    BvhRef& ref(std::uint32_t i) const { return (*storage)[i]; }
};

using BvhHalves = std::pair<BvhSet, BvhSet>;

// Expected cost of halves: areas of boxes times blocks [mm^2].
double split_cost(const BvhBox& left, std::uint32_t left_count, const BvhBox& right, std::uint32_t right_count);

// Maps twice the centre of a box on one axis to a bin; the same arithmetic bins and partitions.
struct BvhBinning {
    static constexpr int bins = 128;
    float first = 0.0f, scale = 0.0f;  // scale 0: all centres coincide

    int bin(const BvhBox& box, std::size_t axis) const;
};

// What lies in each bin and in those after it.
template <class Bins>
Bins sums_from_each_bin(Bins bins) {
    for (std::size_t i = bins.size() - 1; i > 0; --i) bins[i - 1].add(bins[i]);
    return bins;
}

// Refs go to the side on which their centres lie: those in bins below `bin` to the left.
struct ObjectSplit {
    double cost = std::numeric_limits<double>::infinity();  // infinity: all centres coincide
    std::size_t axis = 0;
    int bin = 0;
    BvhBinning binning;
    BvhBox left, right;
};

// The split of least cost over 128 bins on each axis, of a set of more than one.
ObjectSplit find_object_split(const BvhSet& set, unsigned threads);

// Divides a set in two, neither empty, where a split was found. Reorders the refs.
BvhHalves apply_split(BvhSet set, const ObjectSplit& split, unsigned threads);

// Half the blocks to each side, along the axis on which the centres spread most; it bounds the depth whatever
// the triangles.
BvhHalves split_evenly(BvhSet set);

}  // namespace stokes
