// Stage 4 of a pass, model `paper` without power tables: every photon integrates eq. 3-5 itself (PHYSICS section 3).
// Exits have the same distribution as those that sample_exits draws from the tables without weights, and the same flux
// leaves there. All of them are drawn at random.
#include "lib/exit_points.clh"
#include "lib/integrated_distance.clh"
#include "lib/integrated_power.clh"
#include "lib/material.clh"
#include "shared/arguments.h"
#include "shared/material.h"
#include "shared/pass.h"

// Work-items: round.count, one an entry of its list.
// Reads: event_lists, points, rays (incident direction), materials, mixtures [media], mix_rows as mixtures refer to
// them. Writes: exits and probes at round.first_exit + i, as sample_exits does: a point of the tangent plane, or
// without
//   subsurface the entry itself.
__kernel void draw_exits(EventRound round, __global const PassConstants* pass, __global const MaterialRecord* materials,
                         __global const DistanceMixture* mixtures, __global const float* mix_rows,
                         __global const uint* event_lists, __global const SurfacePoint* points,
                         __global const Ray* rays, __global ExitPoint* exits, __global Probe* probes) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const uint path = event_lists[round.first_entry + i];
    const SurfacePoint point = points[path];
    const float3 entry = (float3)(point.x, point.y, point.z), normal = (float3)(point.nx, point.ny, point.nz);
    __global const MaterialRecord* material = &materials[point.material];
    PlanePoint p = {entry, 0.0f, 0.0f, 0.0f, 1.0f};
    float reach = -1.0f;
    if (has(material, STOKES_MATERIAL_SUBSURFACE)) {
        const DistanceMixture mixture = mixtures[material->medium];
        const float3 direction = (float3)(rays[path].dx, rays[path].dy, rays[path].dz);
        const float row = min(refraction_angle_deg(-dot(direction, normal), material->eta), mixture.theta_max_deg);
        const float r_mm = draw_distance(mixture, mix_rows + mixture.first, round.component, row, pass->seed,
                                         pass->pass, path, round.event);
        const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_EXIT + round.component);
        p = about_entry(entry, normal, r_mm, row, draw.b);
        reach = length(p.at - entry) + 8.0f * pass->offset_mm;
    }
    store_exit(p, reach, path, &point, &exits[round.first_exit + i], &probes[round.first_exit + i]);
}

// Work-items: round.count exits of round.component, from round.first_exit on.
// Reads: exits (r_mm, row: refraction angle [deg]), materials, media [media].
// Writes: power [exit]: T_F [mm], T_S [1] or T_M [1/mm^2] at the pass's wavelengths; nothing without subsurface.
__kernel void integrate_power(EventRound round, __global const MaterialRecord* materials,
                              __global const PassMedium* media, __global const ExitPoint* exits,
                              __global float16* exit_powers) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    __global const ExitPoint* exit_point = &exits[round.first_exit + i];
    __global const MaterialRecord* material = &materials[exit_point->material];
    if (!has(material, STOKES_MATERIAL_SUBSURFACE)) return;
    const uint medium = material->medium;
    const float r_mm = exit_point->r_mm;
    const float16 sigma_s = vload16(0, media[medium].sigma_s), sigma_a = vload16(0, media[medium].sigma_a);
    const float16 sigma_t = sigma_s + sigma_a;
    const RefractionAngle angle = refraction_of(exit_point->row);
    float16 result;
    if (round.component == STOKES_MAP_FLUORESCENCE)
        result = fluorescence_power16(sigma_t, r_mm, angle);
    else if (round.component == STOKES_MAP_SINGLE)
        result = single_power16(sigma_s, sigma_t, r_mm, angle);
    else
        result = multiple_power16(sigma_a, sigma_t, media[medium].dipole_a, r_mm);
    exit_powers[round.first_exit + i] = result;
}
