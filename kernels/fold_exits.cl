// Exits of model `conserving` that lie beyond an edge: the tangent plane is folded round it.
#include "lib/bvh.clh"
#include "lib/inline.clh"
#include "lib/probe.clh"
#include "lib/surface_normal.clh"
#include "shared/arguments.h"
#include "shared/pass.h"
#include "shared/path.h"
#include "shared/ray.h"

// Edges that are gone round at most.
#define MOST_FOLDS 4

// Work-items: count exits, of which those that found no surface are looked after.
// Reads: probes: their point of the tangent plane; the scene. Writes: exits, found = 1 where there is one.
// A point of the plane that lies beyond the edge by x comes to lie on the face behind the edge, at x from it, as a
// sheet of paper does when it is folded down: light that would have left beyond the edge leaves through that face. The
// edge is found by a ray that comes back from the point towards the entry, a little below the plane.
__kernel void fold_exits(uint count, __global const PassConstants* pass, RAY_SCENE_ARGUMENTS,
                         __global const Triangle* triangles, __global const Probe* probes, __global ExitPoint* exits) {
    const uint i = (uint)get_global_id(0);
    if (i >= count || exits[i].found != 0u) return;
    const BvhScene scene = {bvh_nodes, bvh_blocks, bvh_grid};
    const uint body = probes[i].body;
    const BvhFilter front = {BVH_FRONT, body, triangles, 0u, (float3)(0.0f)};
    const float least = 16.0f * pass->offset_mm;
    float3 from = (float3)(exits[i].x, exits[i].y, exits[i].z);
    float3 normal = (float3)(probes[i].nx, probes[i].ny, probes[i].nz);
    float3 at = (float3)(probes[i].x, probes[i].y, probes[i].z);
    for (int fold = 0; fold < MOST_FOLDS; ++fold) {
        const float way = length(from - at);
        if (!(way > least)) return;
        const float3 back = (from - at) / way;
        const float lowered = least + 0.01f * way;
        const float3 start = at - normal * lowered;
        const Ray ray = {start.x, start.y, start.z, 0.0f, back.x, back.y, back.z, way};
        const Hit edge = bvh_closest(scene, ray, front);
        if (edge.triangle == STOKES_NONE) return;
        const float3 face = triangle_normal(triangles[edge.triangle]);
        const float3 down = face * dot(normal, face) - normal;
        const float steepness = length(down);
        if (!(steepness > 1e-3f)) return;
        from = start + back * edge.t;
        at = from + down * (max(edge.t - lowered, 0.0f) / steepness);
        normal = face;
        const Probe probe = {at.x, at.y, at.z, edge.t + least, face.x, face.y, face.z, body};
        const Hit hit = probe_surface(scene, triangles, probe);
        if (hit.triangle == STOKES_NONE) continue;
        const float3 position = at - hit.t * face;
        const float3 outward = triangle_normal(triangles[hit.triangle]);
        exits[i].x = position.x;
        exits[i].y = position.y;
        exits[i].z = position.z;
        exits[i].nx = outward.x;
        exits[i].ny = outward.y;
        exits[i].nz = outward.z;
        exits[i].found = 1u;
        return;
    }
}
