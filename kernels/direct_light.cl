// Light that falls straight from the lights onto the diffuse surfaces that the camera sees, by shadow rays.
#include "lib/bvh.clh"
#include "lib/contacts.clh"
#include "lib/film.clh"
#include "lib/inline.clh"
#include "lib/lights.clh"
#include "lib/rng.clh"
#include "lib/sampling.clh"
#include "lib/texture.clh"
#include "shared/arguments.h"
#include "shared/gather.h"
#include "shared/layers.h"
#include "shared/light.h"
#include "shared/material.h"
#include "shared/pass.h"
#include "shared/photon.h"
#include "shared/ray.h"

// Lights that a point looks at; where there are more, as many are drawn.
#define MOST_LIGHTS 16u

// Additive recurrences from a random start (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
// Two numbers in [0, 1), independent for each pixel and event; over the passes of one pixel they fill the unit square
// evenly, by the plastic number. Each alone is uniform.
FORCE_INLINE float2 spread_over_passes(__global const PassConstants* pass, uint pixel, uint event) {
    const Random4 start = random4(pass->seed, 0u, pixel, event, RNG_DIRECT);
    const uint a = ((uint)(start.a * 0x1p24f) << 8) + 0xC13FA9A9u * pass->pass;
    const uint b = ((uint)(start.b * 0x1p24f) << 8) + 0x91E10DA5u * pass->pass;
    return (float2)(uniform_from_bits(a), uniform_from_bits(b));
}

// One number, whose step has no common measure with those two, so that it fills the cube with them: the third power of
// the inverse of the root of x^4 = x + 1.
FORCE_INLINE float spread_alone(__global const PassConstants* pass, uint pixel, uint event) {
    const Random4 start = random4(pass->seed, 0u, pixel, event, RNG_DIRECT);
    return uniform_from_bits(((uint)(start.a * 0x1p24f) << 8) + 0x8CB92BA7u * pass->pass);
}

// How often a light is picked by a point, in the mean.
FORCE_INLINE float times_picked(__global const LightRecord* lights, uint light_count, uint light) {
    if (light_count <= MOST_LIGHTS) return 1.0f;
    const float before = light > 0u ? lights[light - 1u].cumulative_probability : 0.0f;
    return (float)MOST_LIGHTS * (lights[light].cumulative_probability - before);
}

// Work-items: count, one a point. Adds what the lights bring straight to the points of diffuse surfaces:
// L = reflectance / pi * irradiance. All lights are looked at while they are few; of more, MOST_LIGHTS are drawn by
// their power, stratified.
//   A beam of flux Phi through a section of area A: E = Phi / A cos, without noise.
//   A surface light of radiance L: E = L cos cos' A / d^2, at one of its points.
//   Surface lights that are near are looked for in a direction of density cos / pi as well, one for all of them.
// Rays start offset_mm above the surface, as photons' do; whatever they meet blocks them.
// Reads points[count], the scene, lights, light_areas [mm^2, cumulative within a light], emission[lights]: radiance of
// surface lights [W mm^-2 sr^-1 nm^-1], irradiance across beams [W mm^-2 nm^-1]; spectra (row i: reflectance of
// material i, without its texture), textures, pass (seed, pass, offset_mm, to_x, to_y, to_z). Adds to
// film[STOKES_LAYER_COUNT][count] (X, Y, Z, 0) [cd/m^2], in the surface layer.
__kernel void add_direct_light(uint count, PASS_ARGUMENTS, RAY_SCENE_ARGUMENTS, __global const Triangle* triangles,
                               __global const ShapeRecord* shapes, LIGHT_ARGUMENTS,
                               __global const float16* light_radiance, __global const TextureRecord* texture_records,
                               __global const GatherPoint* gather_points, __global float4* film) {
    const uint i = (uint)get_global_id(0);
    if (i >= count || (gather_points[i].maps & (1u << STOKES_MAP_SURFACE)) == 0u) return;
    const GatherPoint point = gather_points[i];
    const BvhScene scene = {bvh_nodes, bvh_blocks, bvh_grid};
    const float3 at = (float3)(point.x, point.y, point.z), normal = (float3)(point.nx, point.ny, point.nz);
    const LitPoint to = {at, normal, at + normal * pass->offset_mm};
    const Lights of_scene = {lights, light_areas, triangles};
    const float16 reflected =
        M_1_PI_F * textured_reflectance(texture_records, spectra, point.material, point.luminance);
    const float pick = spread_alone(pass, point.pixel, 0u);
    float4 sum = 0.0f;
    bool near = light_count > MOST_LIGHTS;
    for (uint k = 0u; k < min(light_count, MOST_LIGHTS); ++k) {
        const uint l = light_count <= MOST_LIGHTS
                           ? k
                           : pick_light(lights, light_count, ((float)k + pick) * (1.0f / (float)MOST_LIGHTS));
        const float2 place = draws_a_place(&lights[l]) ? spread_over_passes(pass, point.pixel, 2u + k) : 0.0f;
        const Shadow shadow = shadow_of(of_scene, l, place, times_picked(lights, light_count, l), pass->offset_mm, to);
        near |= shadow.near;
        if (!(shadow.factor > 0.0f)) continue;
        const float4 lit = film_value(light_radiance[l] * reflected, pass);
        if (lit.x + lit.y + lit.z > 0.0f && !bvh_any(scene, shadow.ray)) sum += shadow.factor * lit;
    }
    if (near) {
        const float2 u = spread_over_passes(pass, point.pixel, 1u);
        const float3 d = cosine_direction(normal, u.x, u.y);
        const BvhFilter all = {BVH_BOTH, 0u, 0, 0u, (float3)(0.0f)};
        const Ray ray = {to.from.x, to.from.y, to.from.z, 0.0f, d.x, d.y, d.z, INFINITY};
        const Hit hit = settled(scene, triangles, ray, bvh_closest(scene, ray, all), STOKES_NONE, pass->offset_mm);
        const uint l = hit.triangle == STOKES_NONE ? STOKES_NONE : shapes[triangles[hit.triangle].shape].light;
        if (l != STOKES_NONE)
            sum += factor_where_met(of_scene, l, hit.triangle, hit.t, d, times_picked(lights, light_count, l), to) *
                   film_value(light_radiance[l] * reflected, pass);
    }
    film[STOKES_LAYER_SURFACE * count + point.pixel] += sum;
}
