// Rays and probes against the scene's bounding volume hierarchy (lib/bvh.clh).
#include "lib/bvh.clh"
#include "lib/probe.clh"

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

// Work-items: n. Reads: probes [n], triangles of the scene, for their body. Writes: hits [n], as probe_surface has them.
__kernel void trace_probe(uint n, __global const BvhNode* nodes, __global const BvhBlock* blocks,
                          BvhGrid grid, __global const Triangle* triangles, __global const Probe* probes,
                          __global Hit* hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const BvhScene scene = {nodes, blocks, grid};
    hits[i] = probe_surface(scene, triangles, probes[i]);
}
