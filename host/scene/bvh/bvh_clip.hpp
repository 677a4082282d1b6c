// Parts of triangles between planes, for the spatial splits of the BVH builder.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "host/scene/bvh/bvh_split.hpp"
#include "kernels/shared/ray.h"

namespace stokes {

using BvhCorners = std::array<std::array<float, 3>, 3>;

// v0, v0 + e1, v0 + e2, rounded to float [mm].
BvhCorners corners_of(const Triangle& triangle);

class BvhClipper {
  public:
    static constexpr int most_planes = 15;

    // box: of the whole scene.
    BvhClipper(const std::vector<Triangle>& triangles, const BvhBox& box);

    // Cuts the part of a triangle that ref stands for at planes across an axis, in rising order and inside of its
    // box; the boxes of the count + 1 parts, empty ones where a part has no points.
    void cut(const BvhRef& ref, std::size_t axis, const float* planes, int count, BvhBox* parts) const;

    // By how much the boxes of parts are larger than the parts [mm]. Kernels round the corners that they see from
    // the start of a ray to 2^-24 of the distance, and take a triangle for hit when the ray passes outside of it
    // by a few of these.
    double slack_mm() const { return slack_mm_; }

  private:
    const std::vector<Triangle>& triangles_;
    double slack_mm_;
};

}  // namespace stokes
