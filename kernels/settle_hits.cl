// What rays meet where bodies touch or surfaces lie in one place (lib/contacts.clh); part of stage 2 of a pass, in
// scenes that have such places.
#include "lib/contacts.clh"
#include "shared/arguments.h"
#include "shared/pass.h"

// What a scene's bodies are near to.
typedef struct Neighbours {
    __global const Triangle* triangles;
    __global const BodyRecord* bodies;
    __global const ContactRegion* regions;
} Neighbours;

// Whether another body may be near to a place of a body's surface.
FORCE_INLINE bool may_touch(Neighbours near, uint body, float3 at) {
    const BodyRecord record = near.bodies[body];
    if ((record.flags & STOKES_BODY_TOUCHES) == 0u) return false;
    for (uint i = 0u; i < record.region_count; ++i) {
        const ContactRegion r = near.regions[record.first_region + i];
        if (at.x >= r.low_x && at.x <= r.high_x && at.y >= r.low_y && at.y <= r.high_y && at.z >= r.low_z &&
            at.z <= r.high_z)
            return true;
    }
    return false;
}

// settled() of lib/contacts.clh where the hit may have a neighbour.
FORCE_INLINE Hit settled_near(BvhScene scene, Neighbours near, Ray ray, Hit hit, float offset_mm) {
    if (hit.triangle == STOKES_NONE) return hit;
    const Triangle t = near.triangles[hit.triangle];
    const float3 at =
        (float3)(t.v0x, t.v0y, t.v0z) + hit.u * (float3)(t.e1x, t.e1y, t.e1z) + hit.v * (float3)(t.e2x, t.e2y, t.e2z);
    if ((t.flags & STOKES_TRIANGLE_CONTESTED) == 0u || !may_touch(near, t.body, at)) return hit;
    return settled(scene, near.triangles, ray, hit, STOKES_NONE, offset_mm);
}

// Work-items: n. Reads: list [n] indices of paths, departures, the scene, triangles, bodies, contact_regions, pass
// (offset_mm). Reads rays and writes hits as trace_closest; a ray that meets something within its offset starts there,
// and has arrived, whatever medium it runs in. Writes departures: light may leave the medium where it leaves a surface.
__kernel void trace_photons(uint n, __global const PassConstants* pass, RAY_SCENE_ARGUMENTS,
                            __global const Triangle* triangles, __global const BodyRecord* bodies,
                            __global const ContactRegion* contact_regions, __global const uint* list,
                            __global Ray* rays, __global Departure* departures, __global Hit* hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const uint path = list[i];
    const Ray ray = rays[path];
    const BvhScene scene = {bvh_nodes, bvh_blocks, bvh_grid};
    const Departure from = departures[path];
    const Neighbours near = {triangles, bodies, contact_regions};
    if (from.body != STOKES_NONE && from.arrives == 0u && ray.t_min <= ray.t_max &&
        may_touch(near, from.body, (float3)(ray.ox, ray.oy, ray.oz))) {
        const bool solid = (bodies[from.body].flags & STOKES_BODY_SOLID) != 0u;
        if (from.inside != STOKES_NONE && leaves_both(scene, triangles, ray, from, pass->offset_mm))
            departures[path].inside = bodies[from.inside].inside;
        float3 at;
        const Hit hit = touched(scene, triangles, ray, from, solid, pass->offset_mm, &at);
        if (hit.triangle != STOKES_NONE) {
            rays[path] = (Ray){at.x, at.y, at.z, 0.0f, ray.dx, ray.dy, ray.dz, ray.t_max};
            hits[path] = hit;
            departures[path].arrives = (uint)(departures[path].inside != STOKES_NONE);
            return;
        }
    }
    const BvhFilter all = {BVH_BOTH, 0u, 0, 0u, (float3)(0.0f)};
    hits[path] = settled_near(scene, near, ray, bvh_closest(scene, ray, all), pass->offset_mm);
}

// Work-items: n. Reads: rays [n], the scene, triangles, bodies, contact_regions, pass (offset_mm). Reads and writes
// hits [n] of trace_closest_all.
__kernel void settle_hits(uint n, __global const PassConstants* pass, RAY_SCENE_ARGUMENTS,
                          __global const Triangle* triangles, __global const BodyRecord* bodies,
                          __global const ContactRegion* contact_regions, __global const Ray* rays, __global Hit* hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const BvhScene scene = {bvh_nodes, bvh_blocks, bvh_grid};
    const Neighbours near = {triangles, bodies, contact_regions};
    hits[i] = settled_near(scene, near, rays[i], hits[i], pass->offset_mm);
}
