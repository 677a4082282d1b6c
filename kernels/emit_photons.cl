// Stage 1 of a pass: photons leave the lights.
#include "lib/inline.clh"
#include "lib/light_area.clh"
#include "lib/light_sum.clh"
#include "lib/rng.clh"
#include "lib/sampling.clh"
#include "shared/light.h"
#include "shared/pass.h"
#include "shared/path.h"
#include "shared/ray.h"

// Work-items: pass->photons, one a path.
// Reads: lights [lights], light_areas [triangles of all surface lights, cumulative mm^2 within a light],
//   triangles [triangles], photon_flux [lights]: flux of one photon of that light [W/nm], which includes
//   1/(photons * probability of the light).
// Writes: rays, flux [W/nm], ledgers, list [paths].
// A light is chosen by its probability; a surface emits cosine-distributed from a point uniform in area, a beam
// emits parallel light from a point uniform over its cross-section.
__kernel void emit_photons(__global const PassConstants* pass, uint light_count, __global const LightRecord* lights,
                           __global const float* light_areas, __global const Triangle* triangles,
                           __global const float16* photon_flux, __global Ray* rays, __global float16* flux,
                           __global PathLedger* ledgers, __global uint* list) {
    const uint path = (uint)get_global_id(0);
    if (path >= pass->photons) return;
    const Random4 at = random4(pass->seed, pass->pass, path, 0u, RNG_EMIT_POSITION);
    const Random4 to = random4(pass->seed, pass->pass, path, 0u, RNG_EMIT_DIRECTION);
    uint light_index = 0u;
    while (light_index + 1u < light_count && at.a >= lights[light_index].cumulative_probability) ++light_index;
    __global const LightRecord* light = &lights[light_index];

    float3 origin, direction;
    if (light->kind == STOKES_LIGHT_SURFACE) {
        const uint k = pick_area(light_areas, light->first_area, light->triangle_count, at.b);
        __global const Triangle* tri = &triangles[light->first_triangle + k];
        const float3 e1 = (float3)(tri->e1x, tri->e1y, tri->e1z);
        const float3 e2 = (float3)(tri->e2x, tri->e2y, tri->e2z);
        const float3 normal = normalize(cross(e1, e2));
        const float2 uv = uniform_triangle(at.c, at.d);
        origin = (float3)(tri->v0x, tri->v0y, tri->v0z) + e1 * uv.x + e2 * uv.y + normal * pass->offset_mm;
        direction = cosine_direction(normal, to.a, to.b);
    } else {
        float2 uv;
        if (light->kind == STOKES_LIGHT_BEAM_DISK) {
            uv = sqrt(at.c) * unit_circle(at.d);
        } else {
            uv = 2.0f * (float2)(at.c, at.d) - 1.0f;
        }
        origin = (float3)(light->px, light->py, light->pz) + (float3)(light->ux, light->uy, light->uz) * uv.x +
                 (float3)(light->vx, light->vy, light->vz) * uv.y;
        direction = (float3)(light->dx, light->dy, light->dz);
    }

    const float16 start = photon_flux[light_index];
    const float2 total = light_of(start, pass);
    const bool dark = !(total.x > 0.0f);
    rays[path] = (Ray){origin.x,    origin.y,    origin.z,    0.0f,
                       direction.x, direction.y, direction.z, dark ? -1.0f : INFINITY};
    flux[path] = start;
    const LightSum none = {0.0f, 0.0f};
    ledgers[path] = (PathLedger){{total.x, total.y}, none, none, none, none, none, none, none,
                                 dark ? STOKES_FATE_ABSORBED : STOKES_FATE_ALIVE, 0u, dark ? 0u : 1u, total.x / 16.0f,
                                 0u, 0u, 0u, STOKES_NONE};
    list[path] = path;
}
