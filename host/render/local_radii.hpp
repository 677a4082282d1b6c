// Radii of the density estimate that differ over the picture: larger where photons are few.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/shared/gather.h"

namespace stokes {

// Radii at which a trial pass's photons are counted about each point, over the first radius of the picture. Each is
// twice the one before.
inline constexpr float least_count_factor = 1.0f;
inline constexpr std::uint32_t count_levels = 4;

// Photons that a disk ought to hold, as the first radius gives the middle of the picture.
inline constexpr float enough_photons = 20.0f;

// Factor of a point whose disks held counts[0..count_levels - 1] photons: the root of the factor of the disk that would
// hold enough photons, PHYSICS section 1. Levels above the first with enough are not read. In [least_radius_factor,
// largest_radius_factor].
inline constexpr float least_radius_factor = 1.0f, largest_radius_factor = 4.0f;
float radius_factor(const std::vector<float>& counts);

// The radius of each pixel, y * width + x. points: what the camera rays met, one a pixel, in any order; counts
// [count_levels][points], by point. Logarithms of factors are averaged over neighbouring pixels on the same surface. A
// pixel whose ray was reflected has its neighbours' radius; 1 where there is nothing to gather.
std::vector<PixelRadius> pixel_radii(const std::vector<GatherPoint>& points, const std::vector<float>& counts,
                                     std::uint32_t width, std::uint32_t height);

// Powers of two that together are ceilings of all factors, and of 1: a point is gathered from photons hashed for the
// least of them that its factor does not exceed. In ascending order.
std::vector<float> radius_classes(const std::vector<PixelRadius>& pixels);

}  // namespace stokes
