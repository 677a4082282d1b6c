// How much of the disk of the density estimate lies on the surface: near an edge part of it hangs in the air.
#include "lib/bvh.clh"
#include "lib/contacts.clh"
#include "lib/inline.clh"
#include "lib/pixel_places.clh"
#include "lib/rng.clh"
#include "lib/sampling.clh"
#include "lib/surface_normal.clh"
#include "shared/arguments.h"
#include "shared/gather.h"
#include "shared/limits.h"
#include "shared/pass.h"

// Series of trials after a first trial that failed. The prisms and sectors have about 4 % less variance with 8, and 6
// to 10 % more with 2; none of them takes longer.
#define LOW_DISCREPANCY_SERIES 4u

// True where a photon could count for the point at this place of its tangent disk: the surface of its body that is met
// first from above is within the height and the angle of shared/gather.h. Where another body is met before, its own
// front is looked for, and failing that its back, which counts where it is two-sided; but not where the other body
// stands on it.
FORCE_INLINE bool on_surface(BvhScene scene, __global const Triangle* triangles, uint body, float3 place, float3 normal,
                             float height, float offset_mm) {
    const float3 from = place + normal * height;
    const Ray ray = {from.x, from.y, from.z, 0.0f, -normal.x, -normal.y, -normal.z, 2.0f * height};
    const BvhFilter all = {BVH_BOTH, 0u, 0, 0u, (float3)(0.0f)};
    Hit hit = bvh_closest(scene, ray, all);
    if (hit.triangle == STOKES_NONE) return false;
    const uint other = triangles[hit.triangle].body;
    if (((other ^ body) & 255u) != 0u) {  // as the photons' bodies are told apart
        const BvhFilter front = {BVH_FRONT, body, triangles, 0u, (float3)(0.0f)},
                        back = {BVH_BACK, body, triangles, 0u, (float3)(0.0f)};
        const BvhFilter foot = {BVH_BACK, other, triangles, 0u, (float3)(0.0f)};
        hit = bvh_closest(scene, ray, front);
        if (hit.triangle == STOKES_NONE) hit = bvh_closest(scene, ray, back);
        if (hit.triangle == STOKES_NONE) return false;
        const Hit standing = bvh_closest(scene, ray, foot);
        if (standing.triangle != STOKES_NONE && fabs(standing.t - hit.t) < 0.01f * height) return false;
    }
    // Photons are stored on the surface that ranks highest.
    hit = settled(scene, triangles, ray, hit, STOKES_NONE, offset_mm);
    if (((triangles[hit.triangle].body ^ body) & 255u) != 0u) return false;
    return dot(facing_normal(triangles[hit.triangle], -normal), normal) > STOKES_GATHER_MIN_COSINE;
}

typedef struct Disk {
    float3 centre, normal, s, t;
    float radius;
    uint body;
} Disk;

// place: uniform in the unit square.
FORCE_INLINE bool is_on_surface(BvhScene scene, __global const Triangle* triangles, Disk disk, float2 place,
                                float offset_mm) {
    const float2 at = disk.radius * sqrt(place.x) * unit_circle(place.y);
    return on_surface(scene, triangles, disk.body, disk.centre + disk.s * at.x + disk.t * at.y, disk.normal,
                      STOKES_GATHER_MAX_HEIGHT * disk.radius, offset_mm);
}

// Work-items: count, one a point. Reads: points, the scene, pass (seed, pass, low_discrepancy_pixels). radius_mm: of
// the pass. Multiplies GatherPoint.weight by an estimate of 1/p, p the share of the disk that is on the surface: so the
// density estimate divides by the area that can hold photons, without bias. How many random places of the disk it takes
// until one is on the surface has the mean 1/p (a geometric distribution; Booth 2007, "Unbiased Monte Carlo estimation
// of the reciprocal of an integral"). With low_discrepancy_pixels one place is tried first. The place is
// low-discrepancy over the passes, together with that of the ray in its pixel. Where the place is not on the surface,
// the mean of LOW_DISCREPANCY_SERIES such series is added to 1, because 1/p = 1 + (1 - p)/p. Otherwise there is one
// series, with the same mean. A series has at most STOKES_GATHER_MOST_TRIALS places.
__kernel void measure_disks(uint count, float radius_mm, __global const PassConstants* pass, RAY_SCENE_ARGUMENTS,
                            __global const Triangle* triangles, __global GatherPoint* gather_points) {
    const uint i = (uint)get_global_id(0);
    if (i >= count || gather_points[i].maps == 0u) return;
    const GatherPoint point = gather_points[i];
    const BvhScene scene = {bvh_nodes, bvh_blocks, bvh_grid};
    Disk disk;
    disk.centre = (float3)(point.x, point.y, point.z);
    disk.normal = (float3)(point.nx, point.ny, point.nz);
    disk.radius = radius_mm * point.radius_factor;
    disk.body = point.body;
    tangent_frame(disk.normal, &disk.s, &disk.t);
    if (is_on_surface(scene, triangles, disk, place_on_disk(pass, point.pixel), pass->offset_mm)) return;
    const uint series = pass->low_discrepancy_pixels != 0u ? LOW_DISCREPANCY_SERIES : 1u;
    uint trials = 0u;
    for (uint k = 0u; k < series; ++k) {
        bool found = false;
        for (uint trial = 1u; trial < STOKES_GATHER_MOST_TRIALS && !found; ++trial) {
            ++trials;
            const Random4 draw = random4(pass->seed, pass->pass, point.pixel, trials, RNG_DISK);
            found = is_on_surface(scene, triangles, disk, (float2)(draw.a, draw.b), pass->offset_mm);
        }
    }
    gather_points[i].weight = point.weight * (1.0f + (float)trials / (float)series);
}
