// Which side of each shape the camera rays meet, once a render, so that the host can tell of black backs.
#include "lib/surface_normal.clh"
#include "shared/arguments.h"
#include "shared/limits.h"
#include "shared/material.h"
#include "shared/ray.h"

// Work-items: one per stride rays, of which the first one counts. Reads rays, hits [n], triangles.
// Raises side_counts [2 * shapes]: of each shape the rays that meet its front, and those that meet its back.
__kernel void count_sides(uint n, uint stride, SURFACE_ARGUMENTS, __global const Ray* rays, __global const Hit* hits,
                          __global uint* side_counts) {
    const uint i = (uint)get_global_id(0) * stride;
    if (i >= n || hits[i].triangle == STOKES_NONE) return;
    const Triangle t = triangles[hits[i].triangle];
    const float3 direction = (float3)(rays[i].dx, rays[i].dy, rays[i].dz);
    atomic_inc(&side_counts[2u * t.shape + (dot(direction, triangle_normal(t)) > 0.0f ? 1u : 0u)]);
}
