// Light that falls straight from the lights onto the diffuse surfaces that the camera sees, by shadow rays.
#include "lib/bvh.clh"
#include "lib/film.clh"
#include "lib/inline.clh"
#include "lib/light_area.clh"
#include "lib/rng.clh"
#include "lib/sampling.clh"
#include "lib/texture.clh"
#include "shared/arguments.h"
#include "shared/gather.h"
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

// What a point is lit by along one shadow ray: factor times the light's row of the pass's emission is the irradiance
// [W mm^-2 nm^-1] where nothing lies on the ray; 0: it is dark.
typedef struct Shadow {
    Ray ray;
    float factor;
} Shadow;

// of a beam: its photons start at the section.
FORCE_INLINE Shadow shadow_of_beam(__global const LightRecord* light, float3 at, float3 normal, float3 from) {
    const float3 centre = (float3)(light->px, light->py, light->pz);
    const float3 direction = (float3)(light->dx, light->dy, light->dz);
    const float3 u = (float3)(light->ux, light->uy, light->uz), v = (float3)(light->vx, light->vy, light->vz);
    const float3 way = at - centre;
    const float x = dot(way, u) / dot(u, u), y = dot(way, v) / dot(v, v);
    const bool inside = light->kind == STOKES_LIGHT_BEAM_DISK ? x * x + y * y < 1.0f : fmax(fabs(x), fabs(y)) < 1.0f;
    const float cosine = -dot(direction, normal);
    Shadow shadow;
    shadow.factor = inside && dot(way, direction) >= 0.0f ? fmax(cosine, 0.0f) : 0.0f;
    shadow.ray =
        (Ray){from.x, from.y, from.z, 0.0f, -direction.x, -direction.y, -direction.z, dot(from - centre, direction)};
    return shadow;
}

// True where a point lies so near to a surface light that few of its points could bring nearly all the light.
FORCE_INLINE bool is_near(__global const LightRecord* light, float area, float3 at) {
    const float away = distance(at, (float3)(light->px, light->py, light->pz)) - light->ball_mm;
    return light->kind == STOKES_LIGHT_SURFACE && (away <= 0.0f || away * away < area);
}

// Irradiance per radiance of a direction that is drawn by a light's area, picked times in the mean, and where the light
// is near also by the cosine: the balance heuristic (Veach and Guibas 1995). At most pi where the light is near.
FORCE_INLINE float light_factor(float picked, float area, float squared, float cos_light, float cosine, bool near) {
    const float density = picked * squared / (area * cos_light);
    return cosine / (density + (near ? cosine * M_1_PI_F : 0.0f));
}

// of a point of a surface light, uniform in area: its photons start offset_mm above it, cosine-distributed.
FORCE_INLINE Shadow shadow_of_surface(__global const LightRecord* light, __global const float* light_areas,
                                      __global const Triangle* triangles, float2 u, float picked, float offset_mm,
                                      float3 at, float3 normal, float3 from) {
    const float area = light_areas[light->first_area + light->triangle_count - 1u];
    const LightPoint point = point_on_light(light, light_areas, triangles, u);
    const float3 front = point.normal, start = point.position + front * offset_mm;
    const float3 way = start - at;
    const float squared = dot(way, way), cosines = dot(way, normal), cos_light = -dot(way, front);
    Shadow shadow;
    shadow.factor = 0.0f;
    const float3 ray = start - from;
    const float length = sqrt(dot(ray, ray));
    shadow.ray = (Ray){from.x, from.y, from.z, 0.0f, ray.x / length, ray.y / length, ray.z / length, length};
    if (cosines > 0.0f && cos_light > 0.0f) {
        const float scale = rsqrt(squared);
        shadow.factor =
            light_factor(picked, area, squared, cos_light * scale, cosines * scale, is_near(light, area, at));
    }
    return shadow;
}

// How often a light is picked by a point, in the mean.
FORCE_INLINE float times_picked(__global const LightRecord* lights, uint light_count, uint light) {
    if (light_count <= MOST_LIGHTS) return 1.0f;
    const float before = light > 0u ? lights[light - 1u].cumulative_probability : 0.0f;
    return (float)MOST_LIGHTS * (lights[light].cumulative_probability - before);
}

// First light whose cumulative probability exceeds u.
FORCE_INLINE uint pick_light(__global const LightRecord* lights, uint light_count, float u) {
    uint low = 0u, high = light_count - 1u;
    while (low < high) {
        const uint middle = (low + high) / 2u;
        if (lights[middle].cumulative_probability > u)
            high = middle;
        else
            low = middle + 1u;
    }
    return low;
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
// film[STOKES_MAP_COUNT][count] (X, Y, Z, 0) [cd/m^2], in the surface layer.
__kernel void add_direct_light(uint count, PASS_ARGUMENTS, RAY_SCENE_ARGUMENTS, __global const Triangle* triangles,
                               __global const ShapeRecord* shapes, LIGHT_ARGUMENTS,
                               __global const float16* light_radiance, __global const TextureRecord* texture_records,
                               __global const GatherPoint* gather_points, __global float4* film) {
    const uint i = (uint)get_global_id(0);
    if (i >= count || (gather_points[i].maps & (1u << STOKES_MAP_SURFACE)) == 0u) return;
    const GatherPoint point = gather_points[i];
    const BvhScene scene = {bvh_nodes, bvh_blocks, bvh_grid};
    const float3 at = (float3)(point.x, point.y, point.z), normal = (float3)(point.nx, point.ny, point.nz);
    const float3 from = at + normal * pass->offset_mm;
    const float16 reflected =
        M_1_PI_F * textured_reflectance(texture_records, spectra, point.material, point.luminance);
    const float pick = spread_alone(pass, point.pixel, 0u);
    float4 sum = 0.0f;
    bool near = light_count > MOST_LIGHTS;
    for (uint k = 0u; k < min(light_count, MOST_LIGHTS); ++k) {
        const uint l = light_count <= MOST_LIGHTS
                           ? k
                           : pick_light(lights, light_count, ((float)k + pick) * (1.0f / (float)MOST_LIGHTS));
        const float picked = times_picked(lights, light_count, l);
        __global const LightRecord* light = &lights[l];
        Shadow shadow;
        if (light->kind == STOKES_LIGHT_SURFACE) {
            near |= is_near(light, light_areas[light->first_area + light->triangle_count - 1u], at);
            shadow = shadow_of_surface(light, light_areas, triangles, spread_over_passes(pass, point.pixel, 2u + k),
                                       picked, pass->offset_mm, at, normal, from);
        } else {
            shadow = shadow_of_beam(light, at, normal, from);
            shadow.factor /= picked;
        }
        if (!(shadow.factor > 0.0f)) continue;
        const float4 lit = film_value(light_radiance[l] * reflected, pass);
        if (lit.x + lit.y + lit.z > 0.0f && !bvh_any(scene, shadow.ray)) sum += shadow.factor * lit;
    }
    if (near) {
        const float2 u = spread_over_passes(pass, point.pixel, 1u);
        const float3 d = cosine_direction(normal, u.x, u.y);
        const BvhFilter all = {BVH_BOTH, 0u, 0};
        const Hit hit = bvh_closest(scene, (Ray){from.x, from.y, from.z, 0.0f, d.x, d.y, d.z, INFINITY}, all);
        const uint l = hit.triangle == STOKES_NONE ? STOKES_NONE : shapes[triangles[hit.triangle].shape].light;
        if (l != STOKES_NONE) {
            __global const LightRecord* light = &lights[l];
            __global const Triangle* tri = &triangles[hit.triangle];
            const float area = light_areas[light->first_area + light->triangle_count - 1u];
            const float3 front =
                normalize(cross((float3)(tri->e1x, tri->e1y, tri->e1z), (float3)(tri->e2x, tri->e2y, tri->e2z)));
            const float cos_light = -dot(d, front);
            if (cos_light > 0.0f && is_near(light, area, at))
                sum += light_factor(times_picked(lights, light_count, l), area, hit.t * hit.t, cos_light,
                                    fmax(dot(d, normal), 0.0f), true) *
                       film_value(light_radiance[l] * reflected, pass);
        }
    }
    film[STOKES_MAP_SURFACE * count + point.pixel] += sum;
}
