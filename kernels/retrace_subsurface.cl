// Stage 4 of a pass, below translucent surfaces: paths go on from one of the exits that deposit_exits stored. STEP 4 of
// PHYSICS section 3, model `paper`, and of section 4, model `conserving`.
#include "lib/branches.clh"
#include "lib/inline.clh"
#include "lib/light_sum.clh"
#include "lib/reradiation.clh"
#include "lib/retrace.clh"
#include "lib/surface.clh"
#include "shared/arguments.h"
#include "shared/material.h"
#include "shared/photon.h"

// What was to leave where there is no surface.
FORCE_INLINE float2 missed_light(const ExitPoint* exit_point) {
    return exit_point->found != 0u ? (float2)(0.0f) : light_in(exit_point->kept);
}

// Model `paper`. Work-items: round.count exits of the fluorescence component.
// Reads: exits, materials, spectra (excitation), exit_flux: what left there.
// Writes: flux, rays, ledgers. An F photon is traced on with the flux that left (STEP 4), roulette below
// ROULETTE_SHARE of the flux it was emitted with.
__kernel void retrace_fluorescence(EventRound round, PASS_ARGUMENTS, __global const MaterialRecord* materials,
                                   __global const ExitPoint* exits, __global const float16* exit_flux, PATH_ARGUMENTS) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const ExitPoint exit_point = exits[round.first_exit + i];
    const uint path = exit_point.path;
    __global const MaterialRecord* material = &materials[exit_point.material];
    if (!takes_branch(&round, pass, path, material)) return;
    __global PathLedger* ledger = &ledgers[path];
    const float16 arriving = flux[path];
    const float2 incident = light_of(arriving, pass);
    const float2 kept = light_in(exit_point.kept), converted = light_in(exit_point.event_light);
    if (!(within_limit(kept.x, ledger) && within_limit(converted.x, ledger))) {
        add_light(&ledger->dropped, incident);
        end_path(&rays[path], ledger, STOKES_FATE_OVERFLOW);
        return;
    }
    const float2 taken_up = light_of(arriving * spectra[material->excitation_row], pass);
    // A weighted exit is kept, absorbed and created with its weight, whose mean is one; what that is off by is chance.
    const float2 weighted = converted * exit_point.scale, in_medium = weighted - kept;
    add_light(&ledger->roulette, converted - weighted);
    add_light(&ledger->absorbed, incident - taken_up + max(in_medium, 0.0f));
    add_light(&ledger->created, max(-in_medium, 0.0f));
    add_light(&ledger->stokes_loss, taken_up - converted);

    if (exit_point.found == 0u) {
        add_light(&ledger->dropped, kept);
        end_path(&rays[path], ledger, STOKES_FATE_MISSED_EXIT);
        return;
    }
    const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_RETRACE);
    const float survival = min(kept.x / (16.0f * ROULETTE_SHARE * ledger->reference_flux), 1.0f);
    if (!(draw.a < survival)) {
        add_light(&ledger->roulette, kept);
        end_path(&rays[path], ledger, STOKES_FATE_ABSORBED);
        return;
    }
    const float16 carried = exit_flux[round.first_exit + i] / (survival * branch_share(material, &round));
    const float2 going_on = light_of(carried, pass);
    add_light(&ledger->roulette, kept - going_on);
    ledger->conversions += 1u;
    ledger->history = with_leader(ledger->history, ledger->leader);
    flux[path] = carried;
    continue_diffuse(&rays[path], &departures[path], ledger, &round, pass->offset_mm,
                     (float3)(exit_point.x, exit_point.y, exit_point.z),
                     (float3)(exit_point.nx, exit_point.ny, exit_point.nz), going_on, draw.b, draw.c);
}

// Model `paper`. Work-items: round.count elastic events; their single-scattering exits start at round.first_exit, the
// multiple ones at round.second_exit.
// Reads: exits, materials. Writes: flux, rays, ledgers.
// STEP 4: an S or M photon is traced on with probability flux kept / flux in, and the incident flux. At most one of
// the two goes on: S with probability s = kept_S/in, M with m = kept_M/in; where s + m exceeds one, the
// probabilities are divided and the flux multiplied by it, so that each has the same expectation.
__kernel void retrace_elastic(EventRound round, __global const PassConstants* pass,
                              __global const MaterialRecord* materials, __global const ExitPoint* exits,
                              PATH_ARGUMENTS) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const ExitPoint single = exits[round.first_exit + i];
    const ExitPoint multiple = exits[round.second_exit + i];
    const uint path = single.path;
    if (!takes_branch(&round, pass, path, &materials[single.material])) return;
    __global PathLedger* ledger = &ledgers[path];
    const float16 arriving = flux[path];
    const float2 incident = light_of(arriving, pass);
    const float2 kept = light_in(single.kept) + light_in(multiple.kept);
    if (!within_limit(kept.x, ledger)) {
        add_light(&ledger->dropped, incident);
        end_path(&rays[path], ledger, STOKES_FATE_OVERFLOW);
        return;
    }
    // As above, of both exits together: with both weights what they would keep without.
    const float2 weighted = multiple.scale * light_in(single.kept) + single.scale * light_in(multiple.kept);
    const float2 in_medium = single.scale * multiple.scale * incident - weighted;
    add_light(&ledger->roulette, incident - kept - in_medium);
    add_light(&ledger->absorbed, max(in_medium, 0.0f));
    add_light(&ledger->created, max(-in_medium, 0.0f));
    const float2 missed = missed_light(&single) + missed_light(&multiple);
    add_light(&ledger->dropped, missed);

    const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_RETRACE);
    const float at = draw.a * max(incident.x, kept.x);
    const bool ended = !(at < kept.x);
    const ExitPoint chosen = at < single.kept.energy ? single : multiple;
    if (ended || chosen.found == 0u) {
        add_light(&ledger->roulette, kept - missed);
        end_path(&rays[path], ledger, ended ? STOKES_FATE_ABSORBED : STOKES_FATE_MISSED_EXIT);
        return;
    }
    const float16 carried = arriving * max(kept.x / incident.x, 1.0f);
    const float2 going_on = light_of(carried, pass);
    add_light(&ledger->roulette, kept - missed - going_on);
    flux[path] = carried;
    continue_diffuse(&rays[path], &departures[path], ledger, &round, pass->offset_mm,
                     (float3)(chosen.x, chosen.y, chosen.z), (float3)(chosen.nx, chosen.ny, chosen.nz), going_on,
                     draw.b, draw.c);
}

// What the events of a list did with their light.
typedef struct EventAccount {
    float2 taken_up, absorbed, stokes_loss, kept, missed;  // energy and photons
    bool sound;                                            // all of it within_limit()
} EventAccount;

FORCE_INLINE EventAccount account_of(uint event, const ExitGroups* groups, uint exits_each,
                                     __global const ExitPoint* exits, __global const PathLedger* ledger) {
    const float2 none = (float2)(0.0f);
    EventAccount a = {none, none, none, none, none, true};
    for (uint g = 0u; g < groups->count; ++g) {
        const uint first = groups->first_exit[g] + event * exits_each;
        const bool direct = (g & 1u) == 0u;
        const float2 light = light_in(exits[first].event_light);
        const float2 lost = direct ? -light : light;  // taken up less sent on
        a.sound = a.sound && within_limit(light.x, ledger);
        a.taken_up += direct ? none : light;
        a.absorbed += direct ? light : none;
        if (groups->component[g] == STOKES_MAP_FLUORESCENCE)
            a.stokes_loss += lost;
        else
            a.absorbed += lost;
        for (uint k = 0u; k < exits_each; ++k) {
            const ExitPoint exit_point = exits[first + k];
            a.kept += light_in(exit_point.kept);
            a.missed += missed_light(&exit_point);
        }
    }
    a.absorbed -= a.kept;
    a.sound = a.sound && within_limit(a.kept.x, ledger);
    return a;
}

// Model `conserving`. Work-items: round.count events of one branch or, with round.branches, of both.
// Reads: exits of all groups, materials, exit_flux: what left there.
// Writes: flux, rays, ledgers.
// STEP 4 of PHYSICS section 4: a photon is traced on with what was stored. At most one exit goes on, each with
// probability kept/in, its flux divided by that; where these exceed one together, they are divided by their sum.
__kernel void retrace_exits(EventRound round, ExitGroups groups, __global const PassConstants* pass,
                            __global const MaterialRecord* materials, __global const ExitPoint* exits,
                            __global const float16* exit_flux, PATH_ARGUMENTS) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const uint path = exits[groups.first_exit[0] + i * round.exits].path;
    __global PathLedger* ledger = &ledgers[path];
    __global const MaterialRecord* material = &materials[exits[groups.first_exit[0] + i * round.exits].material];
    const float2 incident = light_of(flux[path], pass);
    const EventAccount a = account_of(i, &groups, round.exits, exits, ledger);
    if (!a.sound) {
        add_light(&ledger->dropped, incident);
        end_path(&rays[path], ledger, STOKES_FATE_OVERFLOW);
        return;
    }
    // On the surface what is not taken up is absorbed; below it, the rest met another branch, or another way.
    add_light(has(material, STOKES_MATERIAL_SUBSURFACE) ? &ledger->roulette : &ledger->absorbed, incident - a.taken_up);
    add_light(&ledger->stokes_loss, a.stokes_loss);
    add_light(&ledger->absorbed, a.absorbed);
    add_light(&ledger->dropped, a.missed);

    const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_RETRACE);
    const float at = draw.a * max(incident.x, a.kept.x);
    uint group = 0u, entry = STOKES_NONE;
    float before = 0.0f;
    for (uint g = 0u; g < groups.count; ++g)
        for (uint k = 0u; k < round.exits; ++k) {
            before += exits[groups.first_exit[g] + i * round.exits + k].kept.energy;
            if (entry == STOKES_NONE && at < before) {
                group = g;
                entry = i * round.exits + k;
            }
        }
    const bool ended = entry == STOKES_NONE;
    const ExitPoint chosen = exits[groups.first_exit[group] + (ended ? i * round.exits : entry)];
    if (ended || chosen.found == 0u) {
        add_light(&ledger->roulette, a.kept - a.missed);
        end_path(&rays[path], ledger, ended ? STOKES_FATE_ABSORBED : STOKES_FATE_MISSED_EXIT);
        return;
    }
    const float raised = max(incident.x, a.kept.x) / chosen.kept.energy * exit_weight(material, draw.b);
    const float16 carried = raised * exit_flux[groups.first_exit[group] + entry];
    const float2 going_on = light_of(carried, pass);
    add_light(&ledger->roulette, a.kept - a.missed - going_on);
    if (groups.component[group] == STOKES_MAP_FLUORESCENCE) {
        ledger->conversions += 1u;
        ledger->history = with_leader(ledger->history, ledger->leader);
    }
    flux[path] = carried;
    continue_diffuse(&rays[path], &departures[path], ledger, &round, pass->offset_mm,
                     (float3)(chosen.x, chosen.y, chosen.z), (float3)(chosen.nx, chosen.ny, chosen.nz), going_on,
                     draw.b, draw.c);
}
