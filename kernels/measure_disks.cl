// How much of the disk of the density estimate lies on the surface: near an edge part of it hangs in the air.
#include "lib/bvh.clh"
#include "lib/inline.clh"
#include "lib/rng.clh"
#include "lib/sampling.clh"
#include "lib/surface_normal.clh"
#include "shared/gather.h"
#include "shared/limits.h"
#include "shared/pass.h"

// True where a photon could count for the point at this place of its tangent disk: the surface of its body that is met
// first from above is within the height and the angle of shared/gather.h. Where another body is met before, its own
// front is looked for, and failing that its back, which counts where it is two-sided; but not where the other body
// stands on it.
FORCE_INLINE bool on_surface(BvhScene scene, __global const Triangle* triangles, uint body, float3 place, float3 normal,
                             float height) {
    const float3 from = place + normal * height;
    const Ray ray = {from.x, from.y, from.z, 0.0f, -normal.x, -normal.y, -normal.z, 2.0f * height};
    const BvhFilter all = {BVH_BOTH, 0u, 0};
    Hit hit = bvh_closest(scene, ray, all);
    if (hit.triangle == STOKES_NONE) return false;
    const uint other = triangles[hit.triangle].body;
    if (((other ^ body) & 255u) != 0u) {  // as the photons' bodies are told apart
        const BvhFilter front = {BVH_FRONT, body, triangles}, back = {BVH_BACK, body, triangles};
        const BvhFilter foot = {BVH_BACK, other, triangles};
        hit = bvh_closest(scene, ray, front);
        if (hit.triangle == STOKES_NONE) hit = bvh_closest(scene, ray, back);
        if (hit.triangle == STOKES_NONE) return false;
        const Hit standing = bvh_closest(scene, ray, foot);
        if (standing.triangle != STOKES_NONE && fabs(standing.t - hit.t) < 0.01f * height) return false;
    }
    return dot(seen_normal(triangles[hit.triangle], -normal), normal) > STOKES_GATHER_MIN_COSINE;
}

// Work-items: count, one a point. Reads: points, the scene, pass (seed, pass). radius_mm: of the pass.
// Multiplies GatherPoint.weight by how many random places of the disk it took until one was on the surface. When a
// share p of the disk is on the surface the mean of that is 1/p, so that the density estimate times it divides by the
// area that can hold photons, without bias (the mean of a geometric distribution; Booth 2007, "Unbiased Monte Carlo
// estimation of the reciprocal of an integral"). At most STOKES_GATHER_MOST_TRIALS.
__kernel void measure_disks(uint count, float radius_mm, __global const PassConstants* pass,
                            __global const BvhNode* nodes, __global const BvhBlock* blocks, BvhGrid grid,
                            __global const Triangle* triangles, __global GatherPoint* points) {
    const uint i = (uint)get_global_id(0);
    if (i >= count || points[i].maps == 0u) return;
    const GatherPoint point = points[i];
    const BvhScene scene = {nodes, blocks, grid};
    const float3 centre = (float3)(point.x, point.y, point.z);
    const float3 normal = (float3)(point.nx, point.ny, point.nz);
    const float radius = radius_mm * point.radius_factor;
    float3 s, t;
    tangent_frame(normal, &s, &t);
    uint trials = 0u;
    bool found = false;
    while (!found && trials < STOKES_GATHER_MOST_TRIALS) {
        const Random4 draw = random4(pass->seed, pass->pass, point.pixel, trials, RNG_DISK);
        const float2 at = radius * sqrt(draw.a) * unit_circle(draw.b);
        found = on_surface(scene, triangles, point.body, centre + s * at.x + t * at.y, normal,
                           STOKES_GATHER_MAX_HEIGHT * radius);
        ++trials;
    }
    points[i].weight = point.weight * (float)trials;
}
