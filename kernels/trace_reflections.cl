// What camera rays meet in scenes with smooth surfaces, which mirror part of them (PHYSICS section 4).
#include "lib/bvh.clh"
#include "lib/contacts.clh"
#include "lib/fresnel.clh"
#include "lib/inline.clh"
#include "lib/rng.clh"
#include "lib/surface.clh"
#include "lib/surface_normal.clh"
#include "lib/tiles.clh"
#include "shared/arguments.h"
#include "shared/camera.h"
#include "shared/material.h"
#include "shared/pass.h"
#include "shared/ray.h"

// Reflections after which a ray sees black. Where it would meet nothing but surfaces of reflectance R the share R^65 of
// its light is lost: below 1e-10 for R = 0.7, 0.04 for R = 0.95, half a degree above a surface of index 1.5.
#define MOST_REFLECTIONS 64u

// Work-items: one per camera ray, in the order of lib/tiles.clh. Where a ray meets the front of a material with Fresnel
// reflection it is mirrored with the probability that reflectance gives, and traced on; otherwise, and
// everywhere else, it ends. A ray that ends on such a front carries no factor: seeing it by chance 1 - R stands for the
// transmittance; the rest is left to collect_points.
// Reads: the scene, pass (seed, pass, offset_mm). Reads and writes rays[width * height]: of a mirrored ray the last
// segment is left, which starts offset_mm above the surface.
// Reads and writes hits[width * height]: the nearest intersection along those, STOKES_NONE without one and after
// MOST_REFLECTIONS.
__kernel void trace_reflections(CameraRecord camera, __global const PassConstants* pass, RAY_SCENE_ARGUMENTS,
                                SURFACE_ARGUMENTS, __global Ray* rays, __global Hit* hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= camera.width * camera.height) return;
    const uint2 at = pixel_of_ray(i, camera.width, camera.height);
    const uint pixel = at.y * camera.width + at.x;
    const BvhScene scene = {bvh_nodes, bvh_blocks, bvh_grid};
    const BvhFilter all = {BVH_BOTH, 0u, 0, 0u, (float3)(0.0f)};
    Ray ray = rays[i];
    Hit hit = hits[i];
    for (uint reflections = 0u;; ++reflections) {
        if (reflections > 0u)
            hit = settled(scene, triangles, ray, bvh_closest(scene, ray, all), STOKES_NONE, pass->offset_mm);
        if (hit.triangle == STOKES_NONE) break;
        const Triangle t = triangles[hit.triangle];
        __global const MaterialRecord* material = &materials[shapes[t.shape].material];
        if (!may_mirror(material)) break;
        const float3 e1 = (float3)(t.e1x, t.e1y, t.e1z), e2 = (float3)(t.e2x, t.e2y, t.e2z);
        const float3 normal = triangle_normal(t);
        const float3 direction = (float3)(ray.dx, ray.dy, ray.dz);
        const float cos_in = min(-dot(direction, normal), 1.0f);
        if (!(cos_in > 0.0f)) break;
        // Event 0 is the place in the pixel.
        const Random4 draw = random4(pass->seed, pass->pass, pixel, reflections + 1u, RNG_CAMERA);
        if (!mirrors_camera_ray(material, cos_in, draw.a)) break;
        if (reflections == MOST_REFLECTIONS) {
            hit.triangle = STOKES_NONE;
            break;
        }
        const float3 position = (float3)(t.v0x, t.v0y, t.v0z) + hit.u * e1 + hit.v * e2;
        const float3 from = position + normal * pass->offset_mm;
        const float3 mirrored = normalize(reflect_at(direction, normal));
        ray = (Ray){from.x, from.y, from.z, 0.0f, mirrored.x, mirrored.y, mirrored.z, INFINITY};
    }
    rays[i] = ray;
    hits[i] = hit;
}
