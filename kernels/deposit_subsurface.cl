// Stage 4 of a pass, below translucent surfaces: exits are sampled, put onto the real surface and stored in the maps
// F, S and M. Kugita et al., section 3.3 and PHYSICS section 3, model `paper`; PHYSICS section 4, model `conserving`.
#include "lib/branches.clh"
#include "lib/exit_points.clh"
#include "lib/first_collision.clh"
#include "lib/fresnel.clh"
#include "lib/inline.clh"
#include "lib/light_sum.clh"
#include "lib/low_discrepancy.clh"
#include "lib/normal.clh"
#include "lib/power_table.clh"
#include "lib/reradiation.clh"
#include "lib/retrace.clh"
#include "lib/surface_normal.clh"
#include "shared/arguments.h"
#include "shared/material.h"
#include "shared/photon.h"

// Optical lengths beyond this let nothing through: exp(-40) = 4e-18.
#define OPAQUE_DEPTH 40.0f

// Model `paper`: at distance r from the entry, azimuth uniform (STEP 2 and 3). r is drawn from the component's table,
// or, from drawn_rows on, from another density, and what leaves is weighted with the table's over that.
FORCE_INLINE PlanePoint paper_exit(float3 entry, float3 normal, float3 direction, float eta, TableShape shape,
                                   __global const float* mean_rows, __global const float* cumulative_rows,
                                   uint drawn_rows, Random4 draw) {
    const float row = refraction_angle_deg(-dot(direction, normal), eta);
    const float r_mm = sample_distance(mean_rows + drawn_rows, cumulative_rows + drawn_rows, shape, row, draw.a);
    PlanePoint p = about_entry(entry, normal, r_mm, row, draw.b);
    if (drawn_rows > 0u) {
        const float drawn = distance_density(mean_rows + drawn_rows, cumulative_rows + drawn_rows, shape, row, r_mm);
        if (drawn > 0.0f) p.scale = distance_density(mean_rows, cumulative_rows, shape, row, r_mm) / drawn;
    }
    return p;
}

// Model `conserving`: about the foot of the first collision, which lies way_mm along the refracted ray. Direct: where a
// ray from there meets the surface whose direction is uniform among those that can leave; its density over solid angle
// is 1/(2 pi (1 - critical)), that of the source's light 1/(4 pi). Scattered: distance drawn from the table.
FORCE_INLINE PlanePoint conserving_exit(float3 entry, float3 normal, float3 direction,
                                        __global const MaterialRecord* material, __global const float16* spectra,
                                        uint sampler, TableShape shape, __global const float* mean_rows,
                                        __global const float* cumulative_rows, Random4 branch, Random4 draw) {
    __global const float16* sigma_t = &spectra[material->sigma_row];
    const float3 within = refract_into(direction, normal, material->eta);
    PlanePoint p;
    p.way_mm = collision_way(sigma_t, branch.c, branch.d);
    const float depth = max(-dot(within, normal), 0.0f) * p.way_mm;
    const float3 foot = entry + within * p.way_mm + normal * depth;
    if (sampler == STOKES_SAMPLER_DIRECT) {
        const bool fresnel = has(material, STOKES_MATERIAL_FRESNEL);
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

// The k-th of an event's draws of a distance, or direction, and an azimuth: a lattice over both, moved at random. The
// first coordinate is stratified; the second, a golden ratio further each time, nearly so.
FORCE_INLINE Random4 stratified(Random4 first, uint k, uint count) {
    Random4 draw = first;
    draw.a += (float)k / (float)count;
    draw.b += (float)k * 0.618033989f;
    draw.a -= floor(draw.a);
    draw.b -= floor(draw.b);
    return draw;
}

// The draw of a photon's first event that goes with the place where it started: a is its distance or direction, b its
// azimuth. Each stream scrambles it for itself. Two exits of one event, single and multiple or direct and scattered,
// have their distances from different coordinates (turned), so that pairs of distances are even too.
FORCE_INLINE Random4 low_discrepancy_draw(EventSample words, uint seed, uint stream, bool turned) {
    const uint a = turned ? words.second : words.first, b = turned ? words.first : words.second;
    Random4 draw = {0.0f, 0.0f, 0.0f, 0.0f};
    draw.a = uniform_from_word(owen_scramble(a, dimension_seed(~seed, 2u * stream)));
    draw.b = uniform_from_word(owen_scramble(b, dimension_seed(~seed, 2u * stream + 1u)));
    return draw;
}

// Work-items: round.count, one an entry of its list.
// Reads: event_lists, points, rays (incident direction), materials, spectra (sigma_t), table_shapes [3 a medium],
// mean_rows and
//   cumulative_rows of the distance samplers, event_samples [paths] where pass->low_discrepancy_exits has them.
// Writes: exits and probes at round.first_exit + i round.exits and on: round.exits points of the tangent plane, as
//   round.sampler has it. Without subsurface: the entry itself, once, from which nothing leaves scattered.
__kernel void sample_exits(EventRound round, PASS_ARGUMENTS, __global const MaterialRecord* materials, TABLE_ARGUMENTS,
                           __global const uint* event_lists, __global const SurfacePoint* points,
                           __global const Ray* rays, __global const EventSample* event_samples,
                           __global ExitPoint* exits, __global Probe* probes) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const uint path = event_lists[round.first_entry + i];
    const SurfacePoint point = points[path];
    const float3 entry = (float3)(point.x, point.y, point.z), normal = (float3)(point.nx, point.ny, point.nz);
    __global const MaterialRecord* material = &materials[point.material];
    const uint first = round.first_exit + i * round.exits;
    if (!has(material, STOKES_MATERIAL_SUBSURFACE)) {
        for (uint k = 0u; k < round.exits; ++k) {
            const float scale = round.sampler == STOKES_SAMPLER_SCATTERED || k > 0u ? 0.0f : 1.0f;
            store_exit((PlanePoint){entry, 0.0f, 0.0f, 0.0f, scale}, -1.0f, path, &point, &exits[first + k],
                       &probes[first + k]);
        }
        return;
    }
    const float3 direction = (float3)(rays[path].dx, rays[path].dy, rays[path].dz);
    const TableShape shape = table_shapes[material->medium * 3u + round.component];
    const uint stream = RNG_EXIT + (round.sampler == STOKES_SAMPLER_SCATTERED ? 3u : 0u) + round.component;
    const bool turned = round.sampler == STOKES_SAMPLER_SCATTERED || round.component == STOKES_MAP_MULTIPLE;
    const Random4 first_draw = round.event == 0u && pass->low_discrepancy_exits != 0u
                                   ? low_discrepancy_draw(event_samples[path], pass->seed, stream, turned)
                                   : random4(pass->seed, pass->pass, path, round.event, stream);
    const Random4 branch = random4(pass->seed, pass->pass, path, round.event, RNG_BRANCH);
    for (uint k = 0u; k < round.exits; ++k) {
        const Random4 draw = stratified(first_draw, k, round.exits);
        PlanePoint p;
        if (round.sampler == STOKES_SAMPLER_PAPER) {
            p = paper_exit(entry, normal, direction, material->eta, shape, mean_rows, cumulative_rows, round.drawn_rows,
                           draw);
        } else {
            p = conserving_exit(entry, normal, direction, material, spectra, round.sampler, shape, mean_rows,
                                cumulative_rows, branch, draw);
            p.scale /= (float)round.exits;
        }
        const float reach = length(p.at - entry) + 8.0f * pass->offset_mm;
        store_exit(p, reach, path, &point, &exits[first + k], &probes[first + k]);
    }
}

// Work-items: count exits. Reads: probes, hits of trace_probe, triangles.
// Writes: position and normal of exits; found = 0 where the probe found no surface.
__kernel void place_exits(uint count, __global const Triangle* triangles, __global const Probe* probes,
                          __global const Hit* probe_hits, __global ExitPoint* exits) {
    const uint i = (uint)get_global_id(0);
    if (i >= count || probes[i].body == STOKES_NONE) return;
    const Hit hit = probe_hits[i];
    if (hit.triangle == STOKES_NONE) {
        exits[i].found = 0u;
        return;
    }
    const float3 normal = triangle_normal(triangles[hit.triangle]);
    const float3 position =
        (float3)(probes[i].x, probes[i].y, probes[i].z) - hit.t * (float3)(probes[i].nx, probes[i].ny, probes[i].nz);
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

// Model `conserving`, and surface fluorescence. flux arrives; each wavelength is weighted for the way that was drawn
// and has its own probability of the branch, over that of drawing the branch where one was drawn
// (lib/first_collision.clh). both: no branch was drawn. The re-radiation rows include the excitation E. leader: of
// reemit().
FORCE_INLINE Collision collide(__global const MaterialRecord* material, __global const float16* spectra,
                               __global const PassConstants* pass, bool fluorescent, bool both, float way_mm,
                               float16 flux, LightHistory light, __private uint* leader) {
    Collision result;
    if (!has(material, STOKES_MATERIAL_SUBSURFACE)) {
        result.taken_up = flux * spectra[material->excitation_row];
        result.sent_on = reemit(&spectra[material->reradiation_row], flux, pass, light, leader);
        return result;
    }
    const float16 weights = collision_weights(spectra[material->sigma_row], way_mm);
    const float16 weighted = flux * weights;
    const float16 uptake = uptake_of(material, spectra);
    const float fluorescing = uptake_probability(weights, uptake);
    const float p = both ? 1.0f : fluorescent ? fluorescing : 1.0f - fluorescing;
    const float share = p > 0.0f ? 1.0f / p : 0.0f;
    if (fluorescent) {
        result.taken_up = weighted * uptake * share;
        result.sent_on = reemit(&spectra[material->reradiation_row],
                                weighted * (material->fluorescent_fraction * share), pass, light, leader);
    } else {
        result.taken_up = weighted * (1.0f - uptake) * share;
        result.sent_on = result.taken_up * spectra[material->sigma_row + 1u];
    }
    return result;
}

// The light of an event of one branch.
typedef struct EventLight {
    float16 sent_on;     // to the exits: what they let through leaves [W/nm]
    float2 event_light;  // for ExitPoint
} EventLight;

FORCE_INLINE EventLight event_light_of(__global const MaterialRecord* material, __global const float16* spectra,
                                       __global const PassConstants* pass, const EventRound* round, float way_mm,
                                       float16 arriving, LightHistory light, __private uint* leader) {
    const bool fluorescent = round->component == STOKES_MAP_FLUORESCENCE;
    if (round->sampler == STOKES_SAMPLER_PAPER || round->sampler == STOKES_SAMPLER_INTEGRATED) {
        if (!fluorescent) return (EventLight){arriving, (float2)(0.0f)};
        const float16 emitted = reemit(&spectra[material->reradiation_row], arriving, pass, light, leader);
        return (EventLight){emitted, light_of(emitted, pass)};
    }
    const Collision collision =
        collide(material, spectra, pass, fluorescent, round->branches != 0u, way_mm, arriving, light, leader);
    const bool direct = round->sampler == STOKES_SAMPLER_DIRECT;
    return (EventLight){collision.sent_on, light_of(direct ? collision.sent_on : collision.taken_up, pass)};
}

// What the way to an exit lets through, at the pass's wavelengths; the exit's scale not included.
FORCE_INLINE float16 let_through(const ExitPoint* exit_point, uint exit_index, const EventRound* round,
                                 __global const MaterialRecord* material, __global const float16* spectra,
                                 __global const TableShape* table_shapes, __global const float16* table16) {
    if (!has(material, STOKES_MATERIAL_SUBSURFACE)) return (float16)(1.0f);
    if (round->sampler == STOKES_SAMPLER_DIRECT) return exp(-spectra[material->sigma_row] * exit_point->row);
    if (round->sampler == STOKES_SAMPLER_INTEGRATED) return table16[exit_index];
    return power_table_at(table16, table_shapes[material->medium * 3u + round->component], exit_point->r_mm,
                          exit_point->row);
}

// Work-items: round.count events; their round.exits exits of round.component each stand from round.first_exit on.
// Reads: materials, spectra (re-radiation, excitation, sigma_t, albedo), table_shapes and table16: the tables at the
//   pass's wavelengths, or with STOKES_SAMPLER_INTEGRATED what integrate_power wrote for each exit; flux of the
//   arriving photons [W/nm]; points [paths], for the body that they entered.
// Writes: the map's slots from round.first_slot on, one an exit: flux that leaves there (`paper`: eq. 3, 4 or 5),
//   exit_flux, the same by exit, which the path takes along; ExitPoint.kept and .event_light, ledgers (stored, dropped
//   deposits, the leader of re-emitted light).
__kernel void deposit_exits(EventRound round, PASS_ARGUMENTS, __global const MaterialRecord* materials,
                            __global const TableShape* table_shapes, __global const float16* table16,
                            __global const SurfacePoint* points, __global const float16* flux,
                            __global PathLedger* ledgers, __global ExitPoint* exits, __global float16* exit_flux,
                            MAP_ARGUMENTS) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const uint first = round.first_exit + i * round.exits;
    const uint path = exits[first].path;
    __global const MaterialRecord* material = &materials[exits[first].material];
    const uint body = points[path].body;
    __global PathLedger* ledger = &ledgers[path];
    const bool fluorescent = round.component == STOKES_MAP_FLUORESCENCE;
    LightHistory light = {ledger->conversions, ledger->history, 0.0f};
    if (fluorescent && pass->stratified != 0u)  // the same for all exits of an event
        light.u = random4(pass->seed, pass->pass, path, round.event, RNG_REEMIT).a;
    uint leader = STOKES_NONE;
    const EventLight event =
        event_light_of(material, spectra, pass, &round, exits[first].way_mm, flux[path], light, &leader);
    if (fluorescent) ledger->leader = leader;
    const float share = branch_share(material, &round);

    for (uint k = 0u; k < round.exits; ++k) {
        const ExitPoint exit_point = exits[first + k];
        const bool found = exit_point.found != 0u;
        const float16 leaving = event.sent_on * exit_point.scale *
                                let_through(&exit_point, first + k, &round, material, spectra, table_shapes, table16);
        const float2 kept = light_of(leaving, pass);
        exits[first + k].kept = (LightSum){kept.x, kept.y};
        exits[first + k].event_light = (LightSum){event.event_light.x, event.event_light.y};

        const bool sound = found && within_limit(kept.x, ledger);
        const uint slot = round.first_slot + i * round.exits + k;
        if (slot < round.slot_limit) {
            const float3 normal = (float3)(exit_point.nx, exit_point.ny, exit_point.nz);
            map_heads[slot] =
                (PhotonHead){exit_point.x, exit_point.y, exit_point.z,
                             kept.x * share > 0.0f && sound ? pack_normal(normal, body) : STOKES_EMPTY_SLOT};
            map_flux[slot] = leaving * share;
        }
        exit_flux[first + k] = leaving * share;
        if (!found)
            ledger->missed_exits += (uint)(kept.x > 0.0f);
        else if (slot < round.slot_limit && sound)
            add_light(&ledger->stored, kept * share);
    }
}
