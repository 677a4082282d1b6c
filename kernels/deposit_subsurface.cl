// Stage 4 of a pass, below translucent surfaces: exits are sampled, put onto the real surface, stored in the maps
// F, S and M, and the paths go on. Kugita et al., section 3.3 and PHYSICS section 3, model `paper`; PHYSICS section 4,
// model `conserving`.
#include "lib/exit_points.clh"
#include "lib/first_collision.clh"
#include "lib/fresnel.clh"
#include "lib/inline.clh"
#include "lib/light_sum.clh"
#include "lib/normal.clh"
#include "lib/power_table.clh"
#include "lib/reradiation.clh"
#include "lib/retrace.clh"
#include "shared/material.h"
#include "shared/photon.h"

// Optical lengths beyond this let nothing through: exp(-40) = 4e-18.
#define OPAQUE_DEPTH 40.0f

// What was to leave where there is no surface.
FORCE_INLINE float2 missed_light(const ExitPoint* exit_point) {
    return exit_point->r_mm < 0.0f ? light_in(exit_point->kept) : (float2)(0.0f);
}

// Model `paper`: at distance r from the entry, r drawn from the component's table, azimuth uniform (STEP 2 and 3).
FORCE_INLINE PlanePoint paper_exit(float3 entry, float3 normal, float3 direction, float eta, TableShape shape,
                                   __global const float* mean_rows, __global const float* cumulative_rows,
                                   Random4 draw) {
    const float row = refraction_angle_deg(-dot(direction, normal), eta);
    const float r_mm = sample_distance(mean_rows, cumulative_rows, shape, row, draw.a);
    return about_entry(entry, normal, r_mm, row, draw.b);
}

// Model `conserving`: about the foot of the first collision, which lies way_mm along the refracted ray. Direct: where a
// ray from there meets the surface whose direction is uniform among those that can leave; its density over solid angle
// is 1/(2 pi (1 - critical)), that of the source's light 1/(4 pi). Scattered: distance drawn from the table.
FORCE_INLINE PlanePoint conserving_exit(float3 entry, float3 normal, float3 direction,
                                        __global const MaterialRecord* material,
                                        __global const float16* spectra, uint sampler, TableShape shape,
                                        __global const float* mean_rows, __global const float* cumulative_rows,
                                        Random4 branch, Random4 draw) {
    __global const float16* sigma_t = &spectra[material->sigma_row];
    const float3 within = refract_into(direction, normal, material->eta);
    PlanePoint p;
    p.way_mm = collision_way(sigma_t, branch.c, branch.d);
    const float depth = max(-dot(within, normal), 0.0f) * p.way_mm;
    const float3 foot = entry + within * p.way_mm + normal * depth;
    if (sampler == STOKES_SAMPLER_DIRECT) {
        const bool fresnel = material->exit_scale > 0.0f;
        const float critical = fresnel ? sqrt(1.0f - 1.0f / (material->eta * material->eta)) : 0.0f;
        const float mu = max(critical + (1.0f - critical) * draw.a, 1e-6f);
        const float transmitted = fresnel ? 1.0f - internal_reflectance(mu, material->eta) : 1.0f;
        p.row = depth / mu;
        p.r_mm = p.row * sqrt(max(1.0f - mu * mu, 0.0f));
        p.scale = 0.5f * (1.0f - critical) * transmitted;
        if (p.row * least16(*sigma_t) > OPAQUE_DEPTH) p.r_mm = p.scale = 0.0f;
    } else {
        p.row = depth;
        p.r_mm = sample_distance(mean_rows, cumulative_rows, shape, depth, draw.a);
        const float density = distance_density(mean_rows, cumulative_rows, shape, depth, p.r_mm);
        p.scale = density > 0.0f ? 1.0f / density : 0.0f;
    }
    float3 s, t;
    tangent_frame(normal, &s, &t);
    const float2 at = p.r_mm * unit_circle(draw.b);
    p.at = foot + at.x * s + at.y * t;
    return p;
}

// Work-items: round.count, one an entry of list.
// Reads: list, points, rays (incident direction), materials, spectra (sigma_t), table_shapes [3 a medium], mean_rows and
//   cumulative_rows of the distance samplers.
// Writes: exits and probes at round.first_exit + i: a point of the tangent plane, as round.sampler has it. Without
//   subsurface: the entry itself, from which nothing leaves scattered.
__kernel void sample_exits(EventRound round, __global const PassConstants* pass, __global const uint* list,
                           __global const SurfacePoint* points, __global const Ray* rays,
                           __global const MaterialRecord* materials, __global const float16* spectra,
                           __global const TableShape* table_shapes, __global const float* mean_rows,
                           __global const float* cumulative_rows, __global ExitPoint* exits,
                           __global Probe* probes) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const uint path = list[i];
    const SurfacePoint point = points[path];
    const float3 entry = (float3)(point.x, point.y, point.z), normal = (float3)(point.nx, point.ny, point.nz);
    __global const MaterialRecord* material = &materials[point.material];
    PlanePoint p = {entry, 0.0f, 0.0f, 0.0f, round.sampler == STOKES_SAMPLER_SCATTERED ? 0.0f : 1.0f};
    float reach = -1.0f;
    if (material->medium != STOKES_NONE) {
        const float3 direction = (float3)(rays[path].dx, rays[path].dy, rays[path].dz);
        const TableShape shape = table_shapes[material->medium * 3u + round.component];
        const uint stream = RNG_EXIT + (round.sampler == STOKES_SAMPLER_SCATTERED ? 3u : 0u) + round.component;
        const Random4 draw = random4(pass->seed, pass->pass, path, round.event, stream);
        if (round.sampler == STOKES_SAMPLER_PAPER) {
            p = paper_exit(entry, normal, direction, material->eta, shape, mean_rows, cumulative_rows, draw);
        } else {
            const Random4 branch = random4(pass->seed, pass->pass, path, round.event, RNG_BRANCH);
            p = conserving_exit(entry, normal, direction, material, spectra, round.sampler, shape, mean_rows,
                                cumulative_rows, branch, draw);
        }
        reach = length(p.at - entry) + 8.0f * pass->offset_mm;
    }
    store_exit(p, reach, path, &point, &exits[round.first_exit + i], &probes[round.first_exit + i]);
}

// Work-items: count exits. Reads: probes, hits of trace_probe, triangles.
// Writes: position and normal of exits; r_mm made negative where the probe found no surface.
__kernel void place_exits(uint count, __global const Probe* probes, __global const Hit* hits,
                          __global const Triangle* triangles, __global ExitPoint* exits) {
    const uint i = (uint)get_global_id(0);
    if (i >= count || probes[i].body == STOKES_NONE) return;
    const Hit hit = hits[i];
    if (hit.triangle == STOKES_NONE) {
        exits[i].r_mm = -fmax(exits[i].r_mm, FLT_MIN);
        return;
    }
    __global const Triangle* tri = &triangles[hit.triangle];
    const float3 normal = normalize(cross((float3)(tri->e1x, tri->e1y, tri->e1z),
                                          (float3)(tri->e2x, tri->e2y, tri->e2z)));
    const float3 position = (float3)(probes[i].x, probes[i].y, probes[i].z) -
                            hit.t * (float3)(probes[i].nx, probes[i].ny, probes[i].nz);
    exits[i].x = position.x;
    exits[i].y = position.y;
    exits[i].z = position.z;
    exits[i].nx = normal.x;
    exits[i].ny = normal.y;
    exits[i].nz = normal.z;
}

// The light of a first collision: what it takes up and what it sends on.
typedef struct Collision {
    float16 taken_up, sent_on;  // [W/nm]
} Collision;

// Model `conserving`, and surface fluorescence. flux arrives; each wavelength is weighted for the way and for the branch
// that were drawn (lib/first_collision.clh). The re-radiation rows include the excitation E. leader: of reemit().
FORCE_INLINE Collision collide(__global const MaterialRecord* material, __global const float16* spectra,
                               __global const PassConstants* pass, bool fluorescent, float way_mm, float16 flux,
                               LightHistory light, __private uint* leader) {
    Collision result;
    if (material->medium == STOKES_NONE) {
        result.taken_up = flux * spectra[material->excitation_row];
        result.sent_on = reemit(&spectra[material->reradiation_row], flux, pass, light, leader);
        return result;
    }
    const float16 weighted = flux * collision_weights(spectra[material->sigma_row], way_mm);
    const float16 uptake = uptake_of(material, spectra);
    const float p = uptake_probability(collision_weights(spectra[material->sigma_row], way_mm), uptake);
    if (fluorescent) {
        const float share = p > 0.0f ? 1.0f / p : 0.0f;
        result.taken_up = weighted * uptake * share;
        result.sent_on =
            reemit(&spectra[material->reradiation_row], weighted * (material->fluorescent_fraction * share), pass,
                   light, leader);
    } else {
        result.taken_up = weighted * (1.0f - uptake) * (p < 1.0f ? 1.0f / (1.0f - p) : 0.0f);
        result.sent_on = result.taken_up * spectra[material->sigma_row + 1u];
    }
    return result;
}

// Work-items: round.count exits of round.component, from round.first_exit on.
// Reads: materials, spectra (re-radiation, excitation, sigma_t, albedo), table_shapes and table16: the tables at the
//   pass's wavelengths, or with STOKES_SAMPLER_INTEGRATED what integrate_power wrote for each exit; flux of the
//   arriving photons [W/nm].
// Writes: the map's slot round.first_slot + i: flux that leaves there (`paper`: eq. 3, 4 or 5), ExitPoint.kept and
//   .event_light, ledgers (stored, dropped deposits, the leader of re-emitted light).
__kernel void deposit_exits(EventRound round, __global const PassConstants* pass,
                            __global const MaterialRecord* materials, __global const float16* spectra,
                            __global const TableShape* table_shapes, __global const float16* table16,
                            __global ExitPoint* exits, __global const float16* flux, __global PathLedger* ledgers,
                            __global PhotonHead* heads, __global float16* map_flux) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    __global ExitPoint* exit_point = &exits[round.first_exit + i];
    __global const MaterialRecord* material = &materials[exit_point->material];
    __global PathLedger* ledger = &ledgers[exit_point->path];
    const bool found = exit_point->r_mm >= 0.0f;
    const bool fluorescent = round.component == STOKES_MAP_FLUORESCENCE;
    LightHistory light = {ledger->conversions, ledger->history, 0.0f};
    if (fluorescent && pass->stratified != 0u)  // the same for both exits of an event
        light.u = random4(pass->seed, pass->pass, exit_point->path, round.event, RNG_REEMIT).a;
    uint leader = STOKES_NONE;

    float16 leaving = flux[exit_point->path];
    float2 event_light = (float2)(0.0f);
    if (round.sampler == STOKES_SAMPLER_PAPER || round.sampler == STOKES_SAMPLER_INTEGRATED) {
        if (fluorescent) {
            leaving = reemit(&spectra[material->reradiation_row], leaving, pass, light, &leader);
            event_light = light_of(leaving, pass);
        }
    } else {
        const Collision collision =
            collide(material, spectra, pass, fluorescent, exit_point->way_mm, leaving, light, &leader);
        event_light = light_of(
            round.sampler == STOKES_SAMPLER_DIRECT ? collision.sent_on : collision.taken_up, pass);
        leaving = collision.sent_on * exit_point->scale;
    }
    if (material->medium != STOKES_NONE && round.sampler == STOKES_SAMPLER_DIRECT)
        leaving *= exp(-spectra[material->sigma_row] * exit_point->row);
    else if (material->medium != STOKES_NONE && round.sampler == STOKES_SAMPLER_INTEGRATED)
        leaving *= table16[round.first_exit + i];
    else if (material->medium != STOKES_NONE)
        leaving *= power_table_at(table16, table_shapes[material->medium * 3u + round.component],
                                  fabs(exit_point->r_mm), exit_point->row);
    if (fluorescent) ledger->leader = leader;
    const float2 kept = light_of(leaving, pass);
    exit_point->kept = (LightSum){kept.x, kept.y};
    exit_point->event_light = (LightSum){event_light.x, event_light.y};

    const bool sound = found && within_limit(kept.x, ledger);
    const uint slot = round.first_slot + i;
    if (slot < round.slot_limit) {
        const float3 normal = (float3)(exit_point->nx, exit_point->ny, exit_point->nz);
        heads[slot] = (PhotonHead){exit_point->x, exit_point->y, exit_point->z,
                                   kept.x > 0.0f && sound ? pack_normal(normal) : STOKES_EMPTY_SLOT};
        map_flux[slot] = leaving;
    }
    if (!found)
        ledger->missed_exits += (uint)(kept.x > 0.0f);
    else if (slot < round.slot_limit && sound)
        add_light(&ledger->stored, kept);
}

// Model `paper`. Work-items: round.count exits of the fluorescence component.
// Reads: exits, materials, spectra (excitation), map_flux: what deposit_exits stored.
// Writes: flux, rays, ledgers. An F photon is traced on with the flux that left (STEP 4), roulette below
// ROULETTE_SHARE of the flux it was emitted with.
__kernel void retrace_fluorescence(EventRound round, __global const PassConstants* pass,
                                   __global const ExitPoint* exits, __global const MaterialRecord* materials,
                                   __global const float16* spectra, __global const float16* map_flux,
                                   __global Ray* rays, __global float16* flux, __global PathLedger* ledgers) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const ExitPoint exit_point = exits[round.first_exit + i];
    const uint path = exit_point.path;
    __global PathLedger* ledger = &ledgers[path];
    const float16 arriving = flux[path];
    const float2 incident = light_of(arriving, pass);
    const float2 kept = light_in(exit_point.kept), converted = light_in(exit_point.event_light);
    if (!(within_limit(kept.x, ledger) && within_limit(converted.x, ledger))) {
        add_light(&ledger->dropped, incident);
        end_path(&rays[path], ledger, STOKES_FATE_OVERFLOW);
        return;
    }
    const float2 taken_up = light_of(arriving * spectra[materials[exit_point.material].excitation_row], pass);
    const float2 in_medium = converted - kept;
    add_light(&ledger->absorbed, incident - taken_up + max(in_medium, 0.0f));
    add_light(&ledger->created, max(-in_medium, 0.0f));
    add_light(&ledger->stokes_loss, taken_up - converted);

    const uint slot = round.first_slot + i;
    const bool found = exit_point.r_mm >= 0.0f;
    if (!found || slot >= round.slot_limit) {
        add_light(&ledger->dropped, kept);
        end_path(&rays[path], ledger, found ? STOKES_FATE_MAP_FULL : STOKES_FATE_MISSED_EXIT);
        return;
    }
    const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_RETRACE);
    const float survival = min(kept.x / (16.0f * ROULETTE_SHARE * ledger->reference_flux), 1.0f);
    if (!(draw.a < survival)) {
        add_light(&ledger->roulette, kept);
        end_path(&rays[path], ledger, STOKES_FATE_ABSORBED);
        return;
    }
    const float16 carried = map_flux[slot] / survival;
    const float2 going_on = light_of(carried, pass);
    add_light(&ledger->roulette, kept - going_on);
    ledger->conversions += 1u;
    ledger->history = with_leader(ledger->history, ledger->leader);
    flux[path] = carried;
    go_on(&rays[path], ledger, &round, pass->offset_mm, (float3)(exit_point.x, exit_point.y, exit_point.z),
          (float3)(exit_point.nx, exit_point.ny, exit_point.nz), going_on, draw.b, draw.c);
}

// Model `paper`. Work-items: round.count elastic events; their single-scattering exits start at round.first_exit, the
// multiple ones at round.second_exit.
// Reads: exits. Writes: flux, rays, ledgers.
// STEP 4: an S or M photon is traced on with probability flux kept / flux in, and the incident flux. At most one of
// the two goes on: S with probability s = kept_S/in, M with m = kept_M/in; where s + m exceeds one, the
// probabilities are divided and the flux multiplied by it, so that each has the same expectation.
__kernel void retrace_elastic(EventRound round, __global const PassConstants* pass, __global const ExitPoint* exits,
                              __global Ray* rays, __global float16* flux, __global PathLedger* ledgers) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const ExitPoint single = exits[round.first_exit + i];
    const ExitPoint multiple = exits[round.second_exit + i];
    const uint path = single.path;
    __global PathLedger* ledger = &ledgers[path];
    const float16 arriving = flux[path];
    const float2 incident = light_of(arriving, pass);
    const float2 kept = light_in(single.kept) + light_in(multiple.kept);
    if (!within_limit(kept.x, ledger)) {
        add_light(&ledger->dropped, incident);
        end_path(&rays[path], ledger, STOKES_FATE_OVERFLOW);
        return;
    }
    add_light(&ledger->absorbed, max(incident - kept, 0.0f));
    add_light(&ledger->created, max(kept - incident, 0.0f));
    const float2 missed = missed_light(&single) + missed_light(&multiple);
    add_light(&ledger->dropped, missed);

    const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_RETRACE);
    const float at = draw.a * max(incident.x, kept.x);
    const bool ended = !(at < kept.x);
    const ExitPoint chosen = at < single.kept.energy ? single : multiple;
    if (ended || chosen.r_mm < 0.0f) {
        add_light(&ledger->roulette, kept - missed);
        end_path(&rays[path], ledger, ended ? STOKES_FATE_ABSORBED : STOKES_FATE_MISSED_EXIT);
        return;
    }
    const float16 carried = arriving * max(kept.x / incident.x, 1.0f);
    const float2 going_on = light_of(carried, pass);
    add_light(&ledger->roulette, kept - missed - going_on);
    flux[path] = carried;
    go_on(&rays[path], ledger, &round, pass->offset_mm, (float3)(chosen.x, chosen.y, chosen.z),
          (float3)(chosen.nx, chosen.ny, chosen.nz), going_on, draw.b, draw.c);
}

// Model `conserving`. Work-items: round.count events of one branch; their direct exits start at round.first_exit, the
// scattered ones at round.second_exit.
// Reads: exits, materials, first_flux and second_flux: the maps that deposit_exits stored them in.
// Writes: flux, rays, ledgers.
// STEP 4 of PHYSICS section 4: a photon is traced on with what was stored. At most one of the two goes on, direct with
// probability d = kept_D/in, scattered with s = kept_S/in, its flux divided by that; where d + s exceeds one, the
// probabilities are divided by it.
__kernel void retrace_exits(EventRound round, __global const PassConstants* pass, __global const ExitPoint* exits,
                            __global const MaterialRecord* materials, __global const float16* first_flux,
                            __global const float16* second_flux, __global Ray* rays, __global float16* flux,
                            __global PathLedger* ledgers) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const ExitPoint direct = exits[round.first_exit + i];
    const ExitPoint scattered = exits[round.second_exit + i];
    const uint path = direct.path;
    __global PathLedger* ledger = &ledgers[path];
    __global const MaterialRecord* material = &materials[direct.material];
    const bool fluorescent = round.component == STOKES_MAP_FLUORESCENCE;
    const float2 incident = light_of(flux[path], pass);
    const float2 sent_on = light_in(direct.event_light), taken_up = light_in(scattered.event_light);
    const float2 kept = light_in(direct.kept) + light_in(scattered.kept);
    if (!(within_limit(kept.x, ledger) && within_limit(sent_on.x, ledger) && within_limit(taken_up.x, ledger))) {
        add_light(&ledger->dropped, incident);
        end_path(&rays[path], ledger, STOKES_FATE_OVERFLOW);
        return;
    }
    // On the surface what is not taken up is absorbed; below it, the rest met another branch.
    add_light(material->medium == STOKES_NONE ? &ledger->absorbed : &ledger->roulette, incident - taken_up);
    add_light(fluorescent ? &ledger->stokes_loss : &ledger->absorbed, taken_up - sent_on);
    add_light(&ledger->absorbed, sent_on - kept);
    const float2 missed = missed_light(&direct) + missed_light(&scattered);
    add_light(&ledger->dropped, missed);

    const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_RETRACE);
    const float at = draw.a * max(incident.x, kept.x);
    const bool ended = !(at < kept.x), first = at < direct.kept.energy;
    const ExitPoint chosen = first ? direct : scattered;
    if (ended || chosen.r_mm < 0.0f) {
        add_light(&ledger->roulette, kept - missed);
        end_path(&rays[path], ledger, ended ? STOKES_FATE_ABSORBED : STOKES_FATE_MISSED_EXIT);
        return;
    }
    const uint slot = (first ? round.first_slot : round.second_slot) + i;
    if (slot >= (first ? round.slot_limit : round.second_limit)) {
        add_light(&ledger->dropped, kept - missed);
        end_path(&rays[path], ledger, STOKES_FATE_MAP_FULL);
        return;
    }
    const float raised = max(incident.x, kept.x) / chosen.kept.energy * exit_weight(material, draw.b);
    const float16 carried = (first ? first_flux[slot] : second_flux[slot]) * raised;
    const float2 going_on = light_of(carried, pass);
    add_light(&ledger->roulette, kept - missed - going_on);
    if (fluorescent) {
        ledger->conversions += 1u;
        ledger->history = with_leader(ledger->history, ledger->leader);
    }
    flux[path] = carried;
    go_on(&rays[path], ledger, &round, pass->offset_mm, (float3)(chosen.x, chosen.y, chosen.z),
          (float3)(chosen.nx, chosen.ny, chosen.nz), going_on, draw.b, draw.c);
}
