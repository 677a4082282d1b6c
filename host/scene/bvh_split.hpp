// How the BVH builder divides a range of triangles in two.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace stokes {

struct BvhBox {
    std::array<float, 3> lo{infinity, infinity, infinity};     // [mm]
    std::array<float, 3> hi{-infinity, -infinity, -infinity};  // [mm]

    void add(const BvhBox& other);
    double half_area() const;  // [mm^2], 0 when empty

    static constexpr float infinity = std::numeric_limits<float>::infinity();
};

// A triangle as the builder moves it about, and its bounds.
struct BvhRef {
    BvhBox box;
    std::uint32_t triangle = 0;
};

// refs[begin, end) and their common box.
struct BvhRange {
    std::uint32_t begin = 0, end = 0;
    BvhBox box;

    std::uint32_t count() const { return end - begin; }
    std::uint32_t blocks() const { return (count() + 7) / 8; }
};

BvhRange make_range(const std::vector<BvhRef>& refs, std::uint32_t begin, std::uint32_t end);

// Reorders the refs of a range of more than eight and divides it in two, neither empty.
// split_by_area: least (area times blocks) over 32 bins on each axis. split_evenly: half the blocks to each
// side, along the axis on which the centres spread most; it bounds the depth whatever the triangles.
std::pair<BvhRange, BvhRange> split_by_area(std::vector<BvhRef>& refs, const BvhRange& range);
std::pair<BvhRange, BvhRange> split_evenly(std::vector<BvhRef>& refs, const BvhRange& range);

}  // namespace stokes
