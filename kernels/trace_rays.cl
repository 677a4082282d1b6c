// Rays and probes against the scene's bounding volume hierarchy (lib/bvh.clh).
#include "lib/bvh.clh"
#include "shared/arguments.h"
#ifndef STOKES_BVH_SCALAR
#include "lib/bvh_packet.clh"
#endif
#include "lib/probe.clh"

// Work-items: n. Reads: list [n] indices of rays; rays, segments [mm]; t_max < t_min: not
// traced. Writes: hits at the rays' indices: the nearest intersection, STOKES_NONE without one.
__kernel void trace_closest(uint n, RAY_SCENE_ARGUMENTS, __global const uint* list, __global const Ray* rays,
                            __global Hit* hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const BvhScene scene = {bvh_nodes, bvh_blocks, bvh_grid};
    const BvhFilter all = {BVH_BOTH, 0u, 0, 0u, (float3)(0.0f)};
    const uint j = list[i];
    hits[j] = bvh_closest(scene, rays[j], all);
}

// Work-items: n. Reads and writes as trace_closest, for rays [n] and hits [n] in place of a list.
__kernel void trace_closest_all(uint n, RAY_SCENE_ARGUMENTS, __global const Ray* rays, __global Hit* hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const BvhScene scene = {bvh_nodes, bvh_blocks, bvh_grid};
    const BvhFilter all = {BVH_BOTH, 0u, 0, 0u, (float3)(0.0f)};
    hits[i] = bvh_closest(scene, rays[i], all);
}

#ifndef STOKES_BVH_SCALAR
// Sixteen rays as they lie in memory, by component; first 16 rays, from their start.
FORCE_INLINE Ray16 load_rays(__global const Ray* rays) {
    __global const float* at = (__global const float*)rays;
    const float16 a = vload16(0, at), b = vload16(1, at), c = vload16(2, at), d = vload16(3, at);
    const float16 e = vload16(4, at), f = vload16(5, at), g = vload16(6, at), h = vload16(7, at);
    return (Ray16){(float16)(a.s08, b.s08, c.s08, d.s08, e.s08, f.s08, g.s08, h.s08),
                   (float16)(a.s19, b.s19, c.s19, d.s19, e.s19, f.s19, g.s19, h.s19),
                   (float16)(a.s2a, b.s2a, c.s2a, d.s2a, e.s2a, f.s2a, g.s2a, h.s2a),
                   (float16)(a.s3b, b.s3b, c.s3b, d.s3b, e.s3b, f.s3b, g.s3b, h.s3b),
                   (float16)(a.s4c, b.s4c, c.s4c, d.s4c, e.s4c, f.s4c, g.s4c, h.s4c),
                   (float16)(a.s5d, b.s5d, c.s5d, d.s5d, e.s5d, f.s5d, g.s5d, h.s5d),
                   (float16)(a.s6e, b.s6e, c.s6e, d.s6e, e.s6e, f.s6e, g.s6e, h.s6e),
                   (float16)(a.s7f, b.s7f, c.s7f, d.s7f, e.s7f, f.s7f, g.s7f, h.s7f)};
}

// Work-items: one per sixteen rays, the last one takes what is left. Reads and writes as trace_closest_all, the same
// bits; rays that start and go side by side are traced together.
__kernel void trace_packets(uint n, RAY_SCENE_ARGUMENTS, __global const Ray* rays, __global Hit* hits) {
    const uint first = (uint)get_global_id(0) * BVH_PACKET;
    if (first >= n) return;
    const BvhScene scene = {bvh_nodes, bvh_blocks, bvh_grid};
    if (first + BVH_PACKET <= n) {
        const Ray16 packet = load_rays(rays + first);
        Hit16 found;
        if (bvh_closest16(scene, &packet, &found)) {
            __global float* out = (__global float*)(hits + first);
            const float16 t = found.t, u = found.u, v = found.v, i = as_float16(found.triangle);
            vstore16((float16)(t.s0, u.s0, v.s0, i.s0, t.s1, u.s1, v.s1, i.s1, t.s2, u.s2, v.s2, i.s2, t.s3, u.s3, v.s3,
                               i.s3),
                     0, out);
            vstore16((float16)(t.s4, u.s4, v.s4, i.s4, t.s5, u.s5, v.s5, i.s5, t.s6, u.s6, v.s6, i.s6, t.s7, u.s7, v.s7,
                               i.s7),
                     1, out);
            vstore16((float16)(t.s8, u.s8, v.s8, i.s8, t.s9, u.s9, v.s9, i.s9, t.sa, u.sa, v.sa, i.sa, t.sb, u.sb, v.sb,
                               i.sb),
                     2, out);
            vstore16((float16)(t.sc, u.sc, v.sc, i.sc, t.sd, u.sd, v.sd, i.sd, t.se, u.se, v.se, i.se, t.sf, u.sf, v.sf,
                               i.sf),
                     3, out);
            return;
        }
    }
    const BvhFilter all = {BVH_BOTH, 0u, 0, 0u, (float3)(0.0f)};
    for (uint i = first; i < min(first + BVH_PACKET, n); ++i) hits[i] = bvh_closest(scene, rays[i], all);
}
#endif

// Work-items: n. Reads: rays [n], as trace_closest. Writes: occluded [n], 1 where anything lies on the
// segment, else 0.
__kernel void trace_any(uint n, RAY_SCENE_ARGUMENTS, __global const Ray* rays, __global uint* occluded) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const BvhScene scene = {bvh_nodes, bvh_blocks, bvh_grid};
    occluded[i] = bvh_any(scene, rays[i]) ? 1u : 0u;
}

// Work-items: n. Reads: probes [n], triangles of the scene, for their body. Writes: hits [n], as probe_surface has
// them.
__kernel void trace_probe(uint n, RAY_SCENE_ARGUMENTS, __global const Triangle* triangles, __global const Probe* probes,
                          __global Hit* probe_hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const BvhScene scene = {bvh_nodes, bvh_blocks, bvh_grid};
    probe_hits[i] = probe_surface(scene, triangles, probes[i]);
}
