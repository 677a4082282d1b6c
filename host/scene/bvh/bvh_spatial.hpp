// Spatial splits: Stich, Friedrich and Dietrich 2009, "Spatial splits in bounding volume hierarchies".
#pragma once

#include <limits>

#include "host/scene/bvh/bvh_clip.hpp"
#include "host/scene/bvh/bvh_split.hpp"

namespace stokes {

// Refs are cut at a plane; those that cross it become two.
struct SpatialSplit {
    double cost = std::numeric_limits<double>::infinity();  // infinity: there is none
    std::size_t axis = 0;
    float plane_mm = 0.0f;
    BvhBox left, right;
    std::uint32_t left_count = 0, right_count = 0;
};

// The split of least cost at evenly spaced planes on each axis that adds no more refs than the set has to spare.
SpatialSplit find_spatial_split(const BvhSet& set, const BvhClipper& clipper, unsigned threads);

// Divides a set at the plane. Refs for which it is cheaper go to one side whole. False, and nothing done, when that
// turns out no cheaper than limit or makes no progress.
bool apply_split(const BvhSet& set, const SpatialSplit& split, const BvhClipper& clipper, double limit,
                 unsigned threads, BvhHalves& halves);

}  // namespace stokes
