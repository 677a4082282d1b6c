// Stage 4 of a pass, below translucent surfaces: exits are sampled, put onto the real surface, stored in the maps
// F, S and M, and the paths go on. Kugita et al., section 3.3 and PHYSICS section 3, model `paper`.
#include "lib/inline.clh"
#include "lib/normal.clh"
#include "lib/power_table.clh"
#include "lib/retrace.clh"
#include "shared/material.h"
#include "shared/photon.h"

// Refraction angle [deg] of light that arrives at incidence cosine cos_in, by Snell's law.
FORCE_INLINE float refraction_angle_deg(float cos_in, float eta) {
    const float sin_in = sqrt(max(0.0f, 1.0f - cos_in * cos_in));
    return asin(min(sin_in / eta, 1.0f)) * 57.2957795f;
}

// The power table of a component, at the pass's wavelengths; one where light leaves where it came in.
FORCE_INLINE float16 power_kept(__global const MaterialRecord* material, uint component,
                          __global const TableShape* table_shapes, __global const float16* table16, float r_mm,
                          float row) {
    if (material->medium == STOKES_NONE) return (float16)(1.0f);
    return power_table_at(table16, table_shapes[material->medium * 3u + component], r_mm, row);
}

// Emitted flux of eq. 1-2: the re-radiation matrix times the flux. rows: one row an excitation wavelength; each
// includes conversion, excitation, emission, the pair weight and the Stokes rule.
FORCE_INLINE float16 reradiate(__global const float16* rows, float16 f) {
    float16 out = rows[0] * f.s0 + rows[1] * f.s1 + rows[2] * f.s2 + rows[3] * f.s3;
    out += rows[4] * f.s4 + rows[5] * f.s5 + rows[6] * f.s6 + rows[7] * f.s7;
    out += rows[8] * f.s8 + rows[9] * f.s9 + rows[10] * f.sa + rows[11] * f.sb;
    return out + rows[12] * f.sc + rows[13] * f.sd + rows[14] * f.se + rows[15] * f.sf;
}

// The pair weight in the re-radiation rows, (N-1)/(n-1), is that of light re-radiated once: given one wavelength in the
// set, another is in it with probability (n-1)/(N-1). The k-th wavelength after it is there with probability
// (n-k)/(N-k), given those before. Stokes' rule makes them all different.
FORCE_INLINE float chain_weight(float wavelengths, uint conversions) {
    const float k = (float)(conversions + 1u);
    const float n = (float)STOKES_WAVELENGTHS;
    return k < n ? (wavelengths - k) / (n - k) * (n - 1.0f) / (wavelengths - 1.0f) : 0.0f;
}

// Work-items: round.count, one an entry of list.
// Reads: list, points, rays (incident direction), materials, table_shapes [3 a medium], mean_rows and
//   cumulative_rows of the distance samplers.
// Writes: exits and probes at round.first_exit + i: a point of the tangent plane at distance r from the entry, r
//   drawn from the component's table, azimuth uniform (STEP 2 and 3). Without subsurface: the entry itself.
__kernel void sample_exits(EventRound round, __global const PassConstants* pass, __global const uint* list,
                           __global const SurfacePoint* points, __global const Ray* rays,
                           __global const MaterialRecord* materials, __global const TableShape* table_shapes,
                           __global const float* mean_rows, __global const float* cumulative_rows,
                           __global ExitPoint* exits, __global Probe* probes) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const uint path = list[i];
    const SurfacePoint point = points[path];
    const float3 normal = (float3)(point.nx, point.ny, point.nz);
    __global const MaterialRecord* material = &materials[point.material];
    ExitPoint exit_point = {point.x,  point.y, point.z, 0.0f,           point.nx, point.ny,
                            point.nz, 0.0f,    path,    point.material, 0.0f,     0.0f};
    Probe probe = {point.x, point.y, point.z, -1.0f, point.nx, point.ny, point.nz, STOKES_NONE};
    if (material->medium != STOKES_NONE) {
        const float cos_in = -(rays[path].dx * normal.x + rays[path].dy * normal.y + rays[path].dz * normal.z);
        const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_EXIT + round.component);
        exit_point.row = refraction_angle_deg(cos_in, material->eta);
        exit_point.r_mm = sample_distance(mean_rows, cumulative_rows,
                                          table_shapes[material->medium * 3u + round.component], exit_point.row,
                                          draw.a);
        float3 s, t;
        tangent_frame(normal, &s, &t);
        const float2 at = exit_point.r_mm * unit_circle(draw.b);
        const float3 on_plane = (float3)(point.x, point.y, point.z) + at.x * s + at.y * t;
        probe = (Probe){on_plane.x, on_plane.y, on_plane.z, exit_point.r_mm + 8.0f * pass->offset_mm,
                        normal.x,   normal.y,   normal.z,   point.body};
    }
    exits[round.first_exit + i] = exit_point;
    probes[round.first_exit + i] = probe;
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
    const float3 e1 = (float3)(tri->e1x, tri->e1y, tri->e1z);
    const float3 e2 = (float3)(tri->e2x, tri->e2y, tri->e2z);
    const float3 position = (float3)(tri->v0x, tri->v0y, tri->v0z) + e1 * hit.u + e2 * hit.v;
    const float3 normal = normalize(cross(e1, e2));
    exits[i].x = position.x;
    exits[i].y = position.y;
    exits[i].z = position.z;
    exits[i].nx = normal.x;
    exits[i].ny = normal.y;
    exits[i].nz = normal.z;
}

// Work-items: round.count exits of round.component, from round.first_exit on.
// Reads: materials, spectra (re-radiation), table_shapes and table16: the power tables at the pass's wavelengths, flux
//   of the arriving photons [W/nm].
// Writes: the map's slot round.first_slot + i: flux that leaves there (eq. 3, 4 or 5), ExitPoint.kept and
//   .converted, ledgers (stored, dropped deposits).
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

    float16 leaving = flux[exit_point->path];
    if (round.component == STOKES_MAP_FLUORESCENCE) {
        leaving = reradiate(&spectra[material->reradiation_row], leaving) *
                  chain_weight(pass->wavelengths, ledger->conversions);
        exit_point->converted = sum16(leaving);
    }
    leaving *= power_kept(material, round.component, table_shapes, table16, fabs(exit_point->r_mm), exit_point->row);
    const float kept = sum16(leaving);
    exit_point->kept = kept;

    const bool sound = found && within_limit(kept, ledger);
    const uint slot = round.first_slot + i;
    if (slot < round.slot_limit) {
        const float3 normal = (float3)(exit_point->nx, exit_point->ny, exit_point->nz);
        heads[slot] = (PhotonHead){exit_point->x, exit_point->y, exit_point->z,
                                   kept > 0.0f && sound ? pack_normal(normal) : STOKES_EMPTY_SLOT};
        map_flux[slot] = leaving;
    }
    if (!found)
        ledger->missed_exits += 1u;
    else if (slot < round.slot_limit && sound)
        ledger->stored += kept;
}

// Work-items: round.count exits of the fluorescence component.
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
    const float16 incident = flux[path];
    if (!(within_limit(exit_point.kept, ledger) && within_limit(exit_point.converted, ledger))) {
        ledger->dropped += sum16(incident);
        end_path(&rays[path], ledger, STOKES_FATE_OVERFLOW);
        return;
    }
    const float taken_up = sum16(incident * spectra[materials[exit_point.material].excitation_row]);
    const float in_medium = exit_point.converted - exit_point.kept;
    ledger->absorbed += sum16(incident) - taken_up + max(in_medium, 0.0f);
    ledger->created += max(-in_medium, 0.0f);
    ledger->stokes_loss += taken_up - exit_point.converted;

    const uint slot = round.first_slot + i;
    const bool found = exit_point.r_mm >= 0.0f;
    if (!found || slot >= round.slot_limit) {
        ledger->dropped += exit_point.kept;
        end_path(&rays[path], ledger, found ? STOKES_FATE_MAP_FULL : STOKES_FATE_MISSED_EXIT);
        return;
    }
    const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_RETRACE);
    const float survival = min(exit_point.kept / (16.0f * ROULETTE_SHARE * ledger->reference_flux), 1.0f);
    if (!(draw.a < survival)) {
        ledger->roulette += exit_point.kept;
        end_path(&rays[path], ledger, STOKES_FATE_ABSORBED);
        return;
    }
    const float16 carried = map_flux[slot] / survival;
    const float carried_sum = sum16(carried);
    ledger->roulette += exit_point.kept - carried_sum;
    ledger->conversions += 1u;
    flux[path] = carried;
    go_on(&rays[path], ledger, &round, pass->offset_mm, (float3)(exit_point.x, exit_point.y, exit_point.z),
          (float3)(exit_point.nx, exit_point.ny, exit_point.nz), carried_sum, draw.b, draw.c);
}

// Work-items: round.count elastic events; their single-scattering exits start at round.first_exit, the multiple
// ones at round.second_exit.
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
    const float16 incident = flux[path];
    const float incident_sum = sum16(incident);
    const float kept = single.kept + multiple.kept;
    if (!within_limit(kept, ledger)) {
        ledger->dropped += incident_sum;
        end_path(&rays[path], ledger, STOKES_FATE_OVERFLOW);
        return;
    }
    ledger->absorbed += max(incident_sum - kept, 0.0f);
    ledger->created += max(kept - incident_sum, 0.0f);
    const float missed =
        (single.r_mm < 0.0f ? single.kept : 0.0f) + (multiple.r_mm < 0.0f ? multiple.kept : 0.0f);
    ledger->dropped += missed;

    const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_RETRACE);
    const float at = draw.a * max(incident_sum, kept);
    const bool ended = !(at < kept);
    const ExitPoint chosen = at < single.kept ? single : multiple;
    if (ended || chosen.r_mm < 0.0f) {
        ledger->roulette += kept - missed;
        end_path(&rays[path], ledger, ended ? STOKES_FATE_ABSORBED : STOKES_FATE_MISSED_EXIT);
        return;
    }
    const float16 carried = incident * max(kept / incident_sum, 1.0f);
    const float carried_sum = sum16(carried);
    ledger->roulette += kept - missed - carried_sum;
    flux[path] = carried;
    go_on(&rays[path], ledger, &round, pass->offset_mm, (float3)(chosen.x, chosen.y, chosen.z),
          (float3)(chosen.nx, chosen.ny, chosen.nz), carried_sum, draw.b, draw.c);
}
