// Stage 4 of a pass, model `walk`, below translucent surfaces: light enters, walks collision by collision, with no
// tables, and leaves; it is stored in the maps F, S or M, and the paths go on. PHYSICS section 5.
#include "lib/light_sum.clh"
#include "lib/normal.clh"
#include "lib/retrace.clh"
#include "lib/surface.clh"
#include "lib/walk.clh"
#include "shared/arguments.h"
#include "shared/photon.h"

// Fills one map's slot: with the photon, or where it is in another map or nowhere, with none.
FORCE_INLINE void fill_slot(__global PhotonHead* heads, __global float16* map_flux, uint slot, uint limit, bool here,
                            PhotonHead head, float16 leaving) {
    if (slot >= limit) return;
    const PhotonHead none = {0.0f, 0.0f, 0.0f, STOKES_EMPTY_SLOT};
    heads[slot] = here ? head : none;
    map_flux[slot] = here ? leaving : (float16)(0.0f);
}

// Work-items: round.count, one an entry of its list: photons that go below a surface.
// Reads: event_lists, points (entry; its material is that of the whole body), rays (incident direction), departures
//   (whether the walk starts within the body, where the ray starts), bodies, the scene, materials, spectra (excitation,
//   re-radiation, sigma_t, albedo).
// Writes: slot slots.first[m] + i of each map m: the flux that leaves [W/nm], in one of them at most: F if it was
//   re-emitted; else S if it scattered once and went straight out, or did not scatter at all (light through a thin
//   mesh); else M. rays, flux, ledgers.
// Light that comes to what lies within the body is not stored: its ray goes on there, and starts in the body's medium
// again where it leaves that.
// A flat body lets light out in the tangent plane of its entry, where the sheet is; else it is a missed exit. The path
// goes on with what was stored, roulette below ROULETTE_SHARE of what it was emitted with; in a direction of the same
// law as `conserving` has, so that the two differ by what happens below the surface alone.
// Ledger: absorbed and stokes_loss are what collisions take, roulette is what the weights and the roulette add and
// take.
__kernel void walk_photons(EventRound round, WalkSlots slots, PASS_ARGUMENTS, RAY_SCENE_ARGUMENTS,
                           __global const Triangle* triangles, __global const MaterialRecord* materials,
                           __global const BodyRecord* bodies, __global const uint* event_lists,
                           __global const SurfacePoint* points, PATH_ARGUMENTS, __global PhotonHead* fluorescence_heads,
                           __global float16* fluorescence_flux, __global PhotonHead* single_heads,
                           __global float16* single_flux, __global PhotonHead* multiple_heads,
                           __global float16* multiple_flux) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const uint path = event_lists[round.first_entry + i];
    const SurfacePoint point = points[path];
    __global const MaterialRecord* material = &materials[point.material];
    __global PathLedger* ledger = &ledgers[path];
    const float2 incident = light_of(flux[path], pass);
    Body body = {spectra[material->sigma_row],
                 spectra[material->sigma_row + 1u],
                 uptake_of(material, spectra),
                 least16(spectra[material->sigma_row]),
                 (bodies[point.body].flags & STOKES_BODY_FLAT) != 0u,
                 (bodies[point.body].flags & STOKES_BODY_HOLLOW) != 0u,
                 point.body,
                 (float3)(point.x, point.y, point.z),
                 (float3)(point.nx, point.ny, point.nz),
                 (float3)(0.0f),
                 (float3)(0.0f),
                 material,
                 spectra,
                 {bvh_nodes, bvh_blocks, bvh_grid},
                 triangles,
                 pass};
    tangent_frame(body.normal, &body.tangent_s, &body.tangent_t);

    const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_RETRACE);
    const float3 direction = (float3)(rays[path].dx, rays[path].dy, rays[path].dz);
    const bool within = departures[path].inside == point.body;
    Walker walker = within ? start_walk(&body, direction, flux[path], ledger->history, draw.d)
                           : enter(&body, direction, flux[path], ledger->history, draw.d);
    uint fate = incident.x > 0.0f ? walk(&walker, &body, path, round.event * WALK_STEPS, ledger->conversions,
                                         ROULETTE_SHARE * incident.x)
                                  : STOKES_FATE_ABSORBED;
    const float16 leaving = walker.flux * walker.weights;
    const float2 kept = fate == STOKES_FATE_ABSORBED ? (float2)(0.0f) : light_of(leaving, pass);
    const float3 normal = body.flat ? body.normal : walker.normal;
    const float3 position =
        body.flat ? body.entry + walker.at.x * body.tangent_s + walker.at.y * body.tangent_t : walker.at;
    const uint component = walker.conversions > 0u ? STOKES_MAP_FLUORESCENCE
                           : walker.turns > 1u     ? STOKES_MAP_MULTIPLE
                                                   : STOKES_MAP_SINGLE;
    if (fate == STOKES_FATE_ALIVE) {
        const bool missed = body.flat && !sheet_reaches(&body, position);
        fate = !within_limit(kept.x, ledger) ? STOKES_FATE_OVERFLOW
               : !(kept.x > 0.0f)            ? STOKES_FATE_ABSORBED
               : missed                      ? STOKES_FATE_MISSED_EXIT
                                             : STOKES_FATE_ALIVE;
    }

    const bool out = fate == STOKES_FATE_ALIVE && !walker.met;
    const PhotonHead head = {position.x, position.y, position.z,
                             out ? pack_normal(normal, point.body) : STOKES_EMPTY_SLOT};
    fill_slot(fluorescence_heads, fluorescence_flux, slots.first[0] + i, slots.limit[0],
              out && component == STOKES_MAP_FLUORESCENCE, head, leaving);
    fill_slot(single_heads, single_flux, slots.first[1] + i, slots.limit[1], out && component == STOKES_MAP_SINGLE,
              head, leaving);
    fill_slot(multiple_heads, multiple_flux, slots.first[2] + i, slots.limit[2],
              out && component == STOKES_MAP_MULTIPLE, head, leaving);

    if (fate == STOKES_FATE_OVERFLOW) {
        add_light(&ledger->dropped, incident);
        end_path(&rays[path], ledger, fate);
        return;
    }
    add_light(&ledger->absorbed, walker.absorbed);
    add_light(&ledger->stokes_loss, walker.stokes_loss);
    add_light(&ledger->roulette, incident - walker.absorbed - walker.stokes_loss - kept);
    if (fate != STOKES_FATE_ALIVE) {
        ledger->missed_exits += (uint)(fate == STOKES_FATE_MISSED_EXIT);
        add_light(&ledger->dropped, kept);
        end_path(&rays[path], ledger, fate);
        return;
    }
    if (out && slots.first[component] + i < slots.limit[component]) add_light(&ledger->stored, kept);
    const float survival = min(kept.x / (16.0f * ROULETTE_SHARE * ledger->reference_flux), 1.0f);
    if (!(draw.a < survival)) {
        add_light(&ledger->roulette, kept);
        end_path(&rays[path], ledger, STOKES_FATE_ABSORBED);
        return;
    }
    const float16 carried = leaving * ((walker.met ? 1.0f : exit_weight(material, draw.b)) / survival);
    const float2 going_on = light_of(carried, pass);
    add_light(&ledger->roulette, kept - going_on);
    ledger->conversions += walker.conversions;
    ledger->history = walker.history;
    flux[path] = carried;
    departures[path].inside = walker.met ? point.body : bodies[point.body].inside;
    departures[path].arrives = (uint)walker.met;
    if (walker.met) {  // its ray finds once more what it has come to
        continue_path(&rays[path], &departures[path], ledger, &round, 0.0f, walker.at, walker.direction,
                      walker.direction, going_on);
        rays[path].t_min = -pass->offset_mm;
        return;
    }
    continue_diffuse(&rays[path], &departures[path], ledger, &round, pass->offset_mm, position, normal, going_on,
                     draw.b, draw.c);
}
