// The same triangles and rays in Embree 3, for comparison.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernels/shared/ray.h"
#include "tests/bench/timing.hpp"

namespace stokes::bench {

// Rays are read from, and hits written to, the same arrays of structs that the kernels use, in blocks of
// 1024 rays taken by the team's threads, as many as the OpenCL device has. Nothing else is done per ray.
// The hierarchy is of RTC_BUILD_QUALITY_MEDIUM, Embree's default; the triangles have corners v0, v0 + e1, v0 + e2.
class EmbreeCaster {
  public:
    // robust: with RTC_SCENE_FLAG_ROBUST, which makes Embree watertight, as the kernels are; without it, Embree's
    // default, it is faster and may miss hits at edges.
    EmbreeCaster(const std::vector<Triangle>& triangles, unsigned threads, bool robust);
    ~EmbreeCaster();

    double build_wall_s() const;
    // rtcIntersect1, incoherent.
    void closest(Team& team, const std::vector<Ray>& rays, std::vector<Hit>& hits) const;
    // rtcIntersect16, flagged as coherent: sixteen rays that follow each other are a packet.
    void coherent(Team& team, const std::vector<Ray>& rays, std::vector<Hit>& hits) const;
    // rtcOccluded1: 1 where anything lies on the segment.
    void any(Team& team, const std::vector<Ray>& rays, std::vector<std::uint32_t>& occluded) const;

  private:
    struct Owner;
    std::unique_ptr<Owner> owner_;
};

std::string embree_version();

}  // namespace stokes::bench
