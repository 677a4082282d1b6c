// What rays meet where bodies touch or surfaces lie in one place (lib/contacts.clh); part of stage 2 of a pass, in
// scenes that have such places.
#include "lib/contacts.clh"
#include "shared/arguments.h"
#include "shared/pass.h"

// Work-items: n. Reads: list [n] indices of paths, departures, the scene, triangles, bodies, pass (offset_mm). Reads
// and writes hits of trace_closest, and rays: one that meets something within its offset starts there.
__kernel void settle_photons(uint n, __global const PassConstants* pass, RAY_SCENE_ARGUMENTS,
                             __global const Triangle* triangles, __global const BodyRecord* bodies,
                             __global const uint* list, __global Ray* rays, __global const Departure* departures,
                             __global Hit* hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const uint path = list[i];
    const Ray ray = rays[path];
    if (!(ray.t_min <= ray.t_max)) return;
    const BvhScene scene = {bvh_nodes, bvh_blocks, bvh_grid};
    const Departure from = departures[path];
    if (from.body != STOKES_NONE && from.arrives == 0u && (bodies[from.body].flags & STOKES_BODY_TOUCHES) != 0u) {
        const bool solid = (bodies[from.body].flags & STOKES_BODY_SOLID) != 0u;
        float3 at;
        const Hit hit = touched(scene, triangles, ray, from, solid, pass->offset_mm, &at);
        if (hit.triangle != STOKES_NONE) {
            rays[path] = (Ray){at.x, at.y, at.z, 0.0f, ray.dx, ray.dy, ray.dz, ray.t_max};
            hits[path] = hit;
            return;
        }
    }
    hits[path] = settled(scene, triangles, ray, hits[path], STOKES_NONE, pass->offset_mm);
}

// Work-items: n. Reads: rays [n], the scene, triangles, pass (offset_mm). Reads and writes hits [n] of
// trace_closest_all.
__kernel void settle_hits(uint n, __global const PassConstants* pass, RAY_SCENE_ARGUMENTS,
                          __global const Triangle* triangles, __global const Ray* rays, __global Hit* hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const BvhScene scene = {bvh_nodes, bvh_blocks, bvh_grid};
    hits[i] = settled(scene, triangles, rays[i], hits[i], STOKES_NONE, pass->offset_mm);
}
