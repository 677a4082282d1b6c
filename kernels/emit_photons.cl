// Stage 1 of a pass: photons leave the lights.
#include "lib/emission.clh"
#include "lib/inline.clh"
#include "lib/light_sum.clh"
#include "lib/lights.clh"
#include "lib/rng.clh"
#include "shared/arguments.h"
#include "shared/light.h"
#include "shared/pass.h"
#include "shared/path.h"
#include "shared/ray.h"

// Writes the state of a path that starts along a ray; inside: as in LightRecord; photon_flux: of one of its light's
// photons. What the ray leaves out of that has escaped.
FORCE_INLINE void start_path(uint path, EmittedRay ray, uint inside, float16 photon_flux,
                             __global const PassConstants* pass, PATH_ARGUMENTS, __global uint* list) {
    const float16 start = photon_flux * ray.share;
    const float2 total = light_of(start, pass);
    const float2 passing = ray.passing > 0.0f ? light_of(photon_flux * ray.passing, pass) : (float2)(0.0f);
    const bool dark = !(total.x > 0.0f);
    rays[path] = (Ray){ray.origin.x,    ray.origin.y,    ray.origin.z,    0.0f,
                       ray.direction.x, ray.direction.y, ray.direction.z, dark ? -1.0f : INFINITY};
    departures[path] = (Departure){ray.normal.x, ray.normal.y, ray.normal.z, ray.body, inside, 0u, {0u, 0u}};
    flux[path] = start;
    const LightSum none = {0.0f, 0.0f};
    const uint ended = passing.x > 0.0f ? STOKES_FATE_ESCAPED : STOKES_FATE_ABSORBED;
    ledgers[path] = (PathLedger){{total.x + passing.x, total.y + passing.y},
                                 none,
                                 none,
                                 {passing.x, passing.y},
                                 none,
                                 none,
                                 none,
                                 none,
                                 dark ? ended : STOKES_FATE_ALIVE,
                                 0u,
                                 dark ? 0u : 1u,
                                 total.x / 16.0f,
                                 0u,
                                 0u,
                                 0u,
                                 STOKES_NONE};
    list[path] = path;
}

// Work-items: pass->photons, one a path.
// Reads: pass (seed, pass, photons, offset_mm), lights [lights], light_areas [triangles of all surface lights,
//   cumulative mm^2 within a light], triangles [triangles], photon_flux [lights]: flux of one photon of that light
//   [W/nm], which includes 1/(photons * probability of the light).
// Writes: rays, departures, flux [W/nm], ledgers, list [paths].
// A light is chosen by its probability; a surface emits cosine-distributed from a point uniform in area, a beam
// emits parallel light from a point uniform over its cross-section.
__kernel void emit_photons(__global const PassConstants* pass, LIGHT_ARGUMENTS, __global const Triangle* triangles,
                           __global const float16* photon_flux, PATH_ARGUMENTS, __global uint* list) {
    const uint path = (uint)get_global_id(0);
    if (path >= pass->photons) return;
    const Random4 at = random4(pass->seed, pass->pass, path, 0u, RNG_EMIT_POSITION);
    const Random4 to = random4(pass->seed, pass->pass, path, 0u, RNG_EMIT_DIRECTION);
    const uint light_index = pick_light(lights, light_count, at.a);
    const EmittedRay start = emitted_ray((Lights){lights, light_areas, triangles}, light_index, pass->offset_mm,
                                         (float4)(at.b, at.c, to.a, to.b));
    start_path(path, start, lights[light_index].inside, photon_flux[light_index], pass, rays, departures, flux, ledgers,
               list);
}

// Work-items: pass->photons, one a path.
// Reads: cells [cell_count], first_photons [cell_count + 1]: the photons of cell c are first_photons[c] to
//   first_photons[c + 1] - 1, one at least; the rest as emit_photons.
// Writes: as emit_photons, and event_samples [paths]; flux times the cell's probability over the share of the photons
// that
//   start in it.
// The photons of a cell lie on it as the points of a low-discrepancy sequence that goes on from pass to pass.
__kernel void emit_stratified(__global const PassConstants* pass, EMISSION_ARGUMENTS,
                              __global const LightRecord* lights, __global const float* light_areas,
                              __global const Triangle* triangles, __global const float16* photon_flux, PATH_ARGUMENTS,
                              __global uint* list, __global EventSample* event_samples) {
    const uint path = (uint)get_global_id(0);
    if (path >= pass->photons) return;
    const uint c = cell_of_photon(first_photons, cell_count, path);
    const uint light = cells[c].light;
    const SequencePoint point = point_of_photon(pass, &cells[c], c, path - first_photons[c]);
    const uint2 words = words_of_event(point, lights[light].dimensions);
    event_samples[path] = (EventSample){words.x, words.y};
    const float4 place = place_of_point(point, &cells[c], lights[light].dimensions);
    const EmittedRay start = emitted_ray((Lights){lights, light_areas, triangles}, light, pass->offset_mm, place);
    const uint count = first_photons[c + 1u] - first_photons[c];
    const float weight = cells[c].probability * (float)pass->photons / (float)count;
    start_path(path, start, lights[light].inside, photon_flux[light] * weight, pass, rays, departures, flux, ledgers,
               list);
}

// Work-items: pass->photons, one a path. Reads as emit_stratified. Writes: where that starts them: cell_of_path [paths]
// and places [paths] in the cube of the cell's light.
__kernel void find_places(__global const PassConstants* pass, EMISSION_ARGUMENTS, __global const LightRecord* lights,
                          __global uint* cell_of_path, __global float4* places) {
    const uint path = (uint)get_global_id(0);
    if (path >= pass->photons) return;
    const uint c = cell_of_photon(first_photons, cell_count, path);
    cell_of_path[path] = c;
    places[path] = place_of_point(point_of_photon(pass, &cells[c], c, path - first_photons[c]), &cells[c],
                                  lights[cells[c].light].dimensions);
}

// Work-items: count. Reads: targets [count], lights, light_areas, triangles, light: which one, places_on_light [count]:
// in [0, 1]^2, where on a light with a surface the photon starts. Writes: places [count] in the light's cube, from
// which photons go through the targets, but for what lies between, and densities [count]: that share of all the light's
// photons which goes through the front of a surface there [1/mm^2]; 0: none does.
__kernel void find_emission_places(uint count, uint light, __global const LightRecord* lights,
                                   __global const float* light_areas, __global const Triangle* triangles,
                                   __global const EmissionTarget* targets, __global const float2* places_on_light,
                                   __global float4* places, __global float* densities) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    const EmissionTarget target = targets[i];
    const EmissionPlace found =
        emission_place((Lights){lights, light_areas, triangles}, light, places_on_light[i],
                       (float3)(target.x, target.y, target.z), (float3)(target.nx, target.ny, target.nz));
    places[i] = clamp(found.place, 0.0f, 1.0f);
    densities[i] = found.density;
}
