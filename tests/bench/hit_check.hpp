// Whether hits are right, by double precision.
#pragma once

#include <cstddef>
#include <vector>

#include "kernels/shared/ray.h"

namespace stokes::bench {

struct HitCount {
    std::size_t rays = 0, hits = 0;
    std::size_t differ = 0;   // from the reference: hit or miss, or a distance by more than 1e-4 of it
    std::size_t wrong = 0;    // hits and misses that double precision refutes, whether they differ or not
    std::size_t inexact = 0;  // hits whose distance is off by more than coordinates are rounded
    std::size_t reference_wrong = 0, reference_inexact = 0;
};

// A hit is refuted when the ray passes its triangle, or crosses it elsewhere than at t, by more than single precision
// rounds coordinates (4e-6 of the largest coordinate and distance at play, more where the ray grazes the triangle)
// and the products of watertight edge functions (2^-22 of the squared distance of the corners: thin triangles far
// away); or when it surely crosses, nearer, the triangle that the reference names. A miss likewise.
HitCount check_hits(const std::vector<Triangle>& triangles, const std::vector<Ray>& rays, const std::vector<Hit>& hits,
                    const std::vector<Hit>& reference);

// The nearest hits of the first rays by a search over all triangles in double precision.
std::vector<Hit> search_all(const std::vector<Triangle>& triangles, const std::vector<Ray>& rays, std::size_t count);

}  // namespace stokes::bench
