// How thickly photons lie about the points that camera rays meet: points get radii of their own from it (PHYSICS
// section 1).
#include "lib/gather.clh"
#include "lib/inline.clh"
#include "shared/arguments.h"
#include "shared/gather.h"

// Work-items: one per point; launched once for each map and each radius, from the least radius up. The photons of a
// map that count towards the point within grid.radius_mm, each as much as its light: (sum w)^2 / sum w^2, w the flux
// (Kish 1965), which is their number where all have the same.
// Reads points[count], the map in cell order with its hash (hash_photons.cl).
// counts[levels][count]: the largest of all maps at this level, 0 to begin with. Points that have enough at a level
// below are left out.
__kernel void count_photons(uint count, uint map, uint level, float enough, SORTED_MAP_ARGUMENTS,
                            __global const GatherPoint* gather_points, __global float* counts) {
    const uint i = (uint)get_global_id(0);
    if (i >= count || (gather_points[i].maps & (1u << map)) == 0u) return;
    for (uint below = 0u; below < level; ++below)
        if (counts[below * count + i] >= enough) return;
    const GatherPoint point = gather_points[i];
    const KeyRuns runs = key_runs(hash_grid, point.x, point.y, point.z);
    const uint begins[4] = {runs.begin.x, runs.begin.y, runs.begin.z, runs.begin.w};
    const uint ends[4] = {runs.end.x, runs.end.y, runs.end.z, runs.end.w};
    float sum = 0.0f, squares = 0.0f;
    for (int run = 0; run < 4; ++run)
        for (uint j = cell_starts[begins[run]]; j < cell_starts[ends[run]]; ++j) {
            const float3 to = (float3)(positions[j] - point.x, positions[hash_grid.stride + j] - point.y,
                                       positions[2u * hash_grid.stride + j] - point.z);
            const float3 normal = (float3)(point.nx, point.ny, point.nz);
            const uint16 packed = normals[j];
            if (!(dot(to, to) < hash_grid.radius_mm * hash_grid.radius_mm) ||
                !(fabs(dot(to, normal)) < STOKES_GATHER_MAX_HEIGHT * hash_grid.radius_mm) ||
                !(dot_packed_normals(packed, normal).s0 > STOKES_GATHER_MIN_COSINE) ||
                of_body(packed, point.body).s0 == 0)
                continue;
            const float16 f = sorted_flux[j];
            const float8 g = f.lo + f.hi;
            const float4 h = g.lo + g.hi;
            const float light = (h.x + h.z) + (h.y + h.w);
            sum += light;
            squares += light * light;
        }
    if (squares > 0.0f) counts[level * count + i] = max(counts[level * count + i], sum * sum / squares);
}

// Work-items: one per point. Gives points[count] the radius of their pixel: pixels[count], by GatherPoint.pixel. A
// point that a reflected ray met, or of another material than at set-up, keeps the radius of the pass.
__kernel void choose_radii(uint count, __global const PixelRadius* pixel_radii, __global GatherPoint* gather_points) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    const PixelRadius radius = pixel_radii[gather_points[i].pixel];
    if (gather_points[i].reflected == 0u && gather_points[i].material == radius.material)
        gather_points[i].radius_factor = radius.factor;
}
