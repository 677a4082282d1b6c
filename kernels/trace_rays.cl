// Rays and probes against the scene's bounding volume hierarchy (lib/bvh.clh).
#include "lib/bvh.clh"

// Work-items: n. Reads: list [n] indices of rays; rays, segments [mm]; t_max < t_min: not
// traced. Writes: hits at the rays' indices: the nearest intersection, STOKES_NONE without one.
__kernel void trace_closest(__global const uint* list, uint n, __global const BvhNode* nodes,
                            __global const BvhBlock* blocks, BvhGrid grid, __global const Ray* rays,
                            __global Hit* hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const BvhScene scene = {nodes, blocks, grid};
    const BvhFilter all = {BVH_BOTH, 0u, 0};
    const uint j = list[i];
    hits[j] = bvh_closest(scene, rays[j], all);
}

// Work-items: n. Reads and writes as trace_closest, for rays [n] and hits [n] in place of a list.
__kernel void trace_closest_all(uint n, __global const BvhNode* nodes, __global const BvhBlock* blocks,
                                BvhGrid grid, __global const Ray* rays, __global Hit* hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const BvhScene scene = {nodes, blocks, grid};
    const BvhFilter all = {BVH_BOTH, 0u, 0};
    hits[i] = bvh_closest(scene, rays[i], all);
}

// Work-items: n. Reads: rays [n], as trace_closest. Writes: occluded [n], 1 where anything lies on the
// segment, else 0.
__kernel void trace_any(uint n, __global const BvhNode* nodes, __global const BvhBlock* blocks, BvhGrid grid,
                        __global const Ray* rays, __global uint* occluded) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const BvhScene scene = {nodes, blocks, grid};
    occluded[i] = bvh_any(scene, rays[i]) ? 1u : 0u;
}

// Work-items: n. Reads: probes [n], reach_mm < 0: not traced; triangles of the scene, for their body.
// Writes: hits [n]: on the line through the probe's point along its normal, within reach_mm to either side,
// the nearest triangle of the probe's body whose outward normal lies on the probe normal's side. t is signed
// [mm], positive below the plane (along -normal); STOKES_NONE without a hit.
// Both searches start a little beyond the plane, so that a surface in the plane itself is found.
__kernel void trace_probe(uint n, __global const BvhNode* nodes, __global const BvhBlock* blocks,
                          BvhGrid grid, __global const Triangle* triangles, __global const Probe* probes,
                          __global Hit* hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const Probe probe = probes[i];
    const BvhScene scene = {nodes, blocks, grid};
    const float size = fmax(fmax(fabs(probe.x), fabs(probe.y)), fabs(probe.z));
    const float margin = 0x1p-12f * probe.reach_mm + 0x1p-20f * size;
    Hit nearest = {probe.reach_mm, 0.0f, 0.0f, STOKES_NONE};
    for (int side = 0; side < 2 && probe.reach_mm >= 0.0f; ++side) {
        const float s = side == 0 ? 1.0f : -1.0f;  // first below the plane, then above it
        const float away = s * margin;
        const Ray ray = {probe.x + away * probe.nx,
                         probe.y + away * probe.ny,
                         probe.z + away * probe.nz,
                         0.0f,
                         -s * probe.nx,
                         -s * probe.ny,
                         -s * probe.nz,
                         fabs(nearest.t) + margin};
        const BvhFilter same_side = {side == 0 ? BVH_FRONT : BVH_BACK, probe.body, triangles};
        Hit hit = bvh_closest(scene, ray, same_side);
        hit.t = s * (hit.t - margin);
        const bool nearer = nearest.triangle == STOKES_NONE || fabs(hit.t) < fabs(nearest.t);
        if (hit.triangle != STOKES_NONE && nearer) nearest = hit;
    }
    hits[i] = nearest;
}
