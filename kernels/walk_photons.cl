// Stage 4 of a pass, model `walk`: light below translucent surfaces by random walks, collision by collision, with no
// tables. PHYSICS section 5.
//
// A body is the half-space below a flat sheet, or what a closed mesh encloses. Light moves in straight lines to the
// next collision, or to the surface, which reflects it or lets it out. At a collision the fluorophore takes it up with
// probability c E (at the first one below this entry only, where the pass says so) and re-emits it, else it scatters
// with the medium's albedo; both are isotropic.
//
// All sixteen wavelengths take one path, drawn as one of them, the hero, would: its collisions and its fluorophore.
// Each is weighted by the density with which it would have taken the path itself over the mean of those densities:
// mean one, at most the number of wavelengths that carry light, each of which is the hero equally often. All other
// chances depend on what is the same whichever wavelength led. When light is re-emitted, the balance and the hero start
// anew: where light goes on from there does not depend on how it came, so that the estimates multiply.
//
// Deep in a half-space a walk would take long to return, without loss infinitely long in the mean. There the light that
// is still to leave, as a function of the place where it scatters, satisfies (laplace - kappa^2) u = 0 but for terms of
// order exp(-depth), kappa a property of the albedo: u at the centre of a sphere is its mean over the sphere times
// x / sinh x, x = kappa radius (Muller 1956, walks on spheres). So a walk at depth z goes on at a place that is uniform
// on the sphere that ends DEEP mean free paths below the surface; the density is that of all wavelengths alike.
#include "lib/bvh.clh"
#include "lib/first_collision.clh"
#include "lib/fresnel.clh"
#include "lib/inline.clh"
#include "lib/light_sum.clh"
#include "lib/normal.clh"
#include "lib/retrace.clh"
#include "lib/rng.clh"
#include "lib/sampling.clh"
#include "shared/material.h"
#include "shared/photon.h"

// Flights below the surface after which a path is cut and counted; also the share of a round in the random numbers,
// 2^32 / WALK_STEPS rounds at most.
#ifndef WALK_STEPS
#define WALK_STEPS 0x100000u
#endif

// Mean free paths, of the wavelength with the longest, between the surface and the spheres of the deep: exp(-10) = 5e-5
// of a small correction. Spheres are at least as large as this.
#define DEEP 10.0f

typedef struct Interior {
    float16 sigma_t;  // [1/mm]
    float16 albedo;
    float16 uptake;   // c E, zero without a fluorophore
    float least;      // smallest sigma_t [1/mm]
} Interior;

// At a collision `scattered` the light is an isotropic source. Places and directions: of the world, or below a flat
// sheet relative to the entry in the frame (tangent, other tangent, depth).
typedef struct Walker {
    float3 at, direction;  // [mm], unit length
    float16 flux;          // without weights; each wavelength stands for flux * weights [W/nm]
    float16 weights;
    float lit;             // wavelengths that may be the hero
    uint hero;
    bool scattered;
    uint collisions;
    uint turns;            // collisions, and internal reflections after the first of them
    uint conversions;      // re-emissions
    float2 absorbed, stokes_loss;
} Walker;

// Begins the balance: each wavelength that has light is the hero equally often.
FORCE_INLINE void choose_hero(__private Walker* walker, float u) {
    const float16 lit = walker->flux > 0.0f ? (float16)(1.0f) : (float16)(0.0f);
    float lamps[STOKES_WAVELENGTHS];
    vstore16(lit, 0, lamps);
    walker->weights = lit;
    walker->lit = sum16(lit);
    float ahead = floor(u * walker->lit);
    walker->hero = 0u;
    for (uint k = 0u; k < STOKES_WAVELENGTHS; ++k) {
        if (ahead >= 0.0f) walker->hero = lamps[k] > 0.0f ? k : walker->hero;
        ahead -= lamps[k];
    }
}

// To mean one over those wavelengths. The hero's own is never small: light is not where its leader hardly goes.
FORCE_INLINE float16 balanced(float16 weights, float lit) { return weights * (lit / max(sum16(weights), FLT_MIN)); }

FORCE_INLINE float value_at(__global const float16* row, uint wavelength) {
    return ((__global const float*)row)[wavelength];
}

// The fluorophore takes up and re-emits. rows: as for reradiate; scale: c times the weight of this conversion.
FORCE_INLINE void convert(__private Walker* walker, float16 uptake, __global const float16* rows, float c, float chain,
                          __global const PassConstants* pass, float u) {
    const float16 weights = balanced(walker->weights * uptake, walker->lit);
    const float share = walker->lit / max(sum16(walker->weights * uptake), FLT_MIN);
    const float16 sent_on = reradiate(rows, walker->flux * walker->weights * (c * share)) * chain;
    walker->stokes_loss += light_of(walker->flux * weights, pass) - light_of(sent_on, pass);
    walker->flux = sent_on;
    walker->conversions += 1u;
    choose_hero(walker, u);
}

// kappa of the deep in units of sigma_t: the root of a atanh(kappa) = kappa by its series about a = 1 (Case, de Hoffmann
// and Placzek 1953), to 5e-6 for a > 0.8; below that no light gets deep.
FORCE_INLINE float16 deep_decay(float16 albedo) {
    const float16 d = 1.0f - albedo;
    const float16 tail = 12.0f / 175.0f + d * (2.0f / 125.0f - d * (166.0f / 67375.0f));
    return sqrt(3.0f * d) * (1.0f - d * (0.4f + d * tail));
}

// x / sinh x.
FORCE_INLINE float16 sphere_transmission(float16 x) {
    const float16 x2 = x * x;
    const float16 decline = exp(-x);
    return x < 0.5f ? 1.0f / (1.0f + x2 * (1.0f / 6.0f + x2 * (1.0f / 120.0f + x2 / 5040.0f)))
                    : 2.0f * x * decline / (1.0f - decline * decline);
}

// In the deep of a half-space: moves the light in walker->direction to the surface of its sphere, from where it is
// scattered again; false where it is not deep. What a fluorophore could take up has to walk: one of the two goes on,
// by chance, in proportion to its light. acts: whether there is a fluorophore to take light up.
FORCE_INLINE bool dive(__private Walker* walker, __private const Interior* interior, bool acts,
                       __global const PassConstants* pass, float u) {
    if (!(walker->at.z * interior->least > 2.0f * DEEP)) return false;
    if (acts) {
        const float16 takers = interior->uptake > 0.0f ? walker->flux : (float16)(0.0f);
        const float stays = sum16(takers * walker->weights);
        const float share = stays / sum16(walker->flux * walker->weights);
        const bool walks = u < share;
        if (walks) walker->flux = takers / share;
        else if (share > 0.0f) walker->flux = (walker->flux - takers) / (1.0f - share);
        if (walks) return false;
    }
    const float radius = walker->at.z - DEEP / interior->least;
    const float16 kept = sphere_transmission(deep_decay(interior->albedo) * interior->sigma_t * radius);
    walker->absorbed += light_of(walker->flux * walker->weights * (1.0f - kept), pass);
    walker->flux *= kept;
    walker->at += walker->direction * radius;
    walker->turns += 1u;
    return true;
}

// Where a ray from within a closed mesh leaves it; STOKES_NONE where there is no surface. The start may lie outside by
// its rounding, which back_mm exceeds.
FORCE_INLINE Hit find_way_out(const BvhScene scene, float3 at, float3 direction, float back_mm,
                              __global const Triangle* triangles, uint body) {
    const Ray ray = {at.x, at.y, at.z, -back_mm, direction.x, direction.y, direction.z, INFINITY};
    const BvhFilter backs = {BVH_BACK, body, triangles};
    return bvh_closest(scene, ray, backs);
}

// Whether a sheet of this body faces the normal within reach_mm of a point of its plane.
FORCE_INLINE bool sheet_reaches(const BvhScene scene, float3 at, float3 normal, float reach_mm,
                                __global const Triangle* triangles, uint body) {
    const float3 from = at + normal * reach_mm;
    const Ray ray = {from.x, from.y, from.z, 0.0f, -normal.x, -normal.y, -normal.z, 2.0f * reach_mm};
    const BvhFilter fronts = {BVH_FRONT, body, triangles};
    return bvh_closest(scene, ray, fronts).triangle != STOKES_NONE;
}

// Fills one map's slot: with the photon, or where another map has it with none.
FORCE_INLINE void fill_slot(__global PhotonHead* heads, __global float16* map_flux, uint slot, uint limit, bool here,
                            PhotonHead head, float16 leaving) {
    if (slot >= limit) return;
    const PhotonHead none = {0.0f, 0.0f, 0.0f, STOKES_EMPTY_SLOT};
    heads[slot] = here ? head : none;
    map_flux[slot] = here ? leaving : (float16)(0.0f);
}

// Work-items: round.count, one an entry of list: photons that go below a surface.
// Reads: list, points (entry; its material is that of the whole body), rays (incident direction), bodies
//   [STOKES_BODY_*], the scene, materials, spectra (excitation, re-radiation, sigma_t, albedo).
// Writes: slot slots.first[m] + i of each map m: the flux that leaves [W/nm], in one of them at most: F if it was
//   re-emitted; else S if it scattered once and went straight out, or did not scatter at all (light through a thin
//   mesh); else M. rays, flux, ledgers.
// A flat body lets light out in the tangent plane of its entry, where the sheet is; else it is a missed exit. The path
// goes on with what was stored, roulette below ROULETTE_SHARE of what it was emitted with; in a direction of the same
// law as `conserving` has, so that the two differ by what happens below the surface alone.
// Ledger: absorbed and stokes_loss are what collisions take in the mean; whatever the weights and the roulette add and
// take stands in roulette.
__kernel void walk_photons(EventRound round, WalkSlots slots, __global const PassConstants* pass,
                           __global const uint* list, __global const SurfacePoint* points, __global const uint* bodies,
                           __global const BvhNode* nodes, __global const BvhBlock* blocks, BvhGrid grid,
                           __global const Triangle* triangles, __global const MaterialRecord* materials,
                           __global const float16* spectra, __global Ray* rays, __global float16* flux,
                           __global PathLedger* ledgers, __global PhotonHead* fluorescence_heads,
                           __global float16* fluorescence_flux, __global PhotonHead* single_heads,
                           __global float16* single_flux, __global PhotonHead* multiple_heads,
                           __global float16* multiple_flux) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const uint path = list[i];
    const SurfacePoint point = points[path];
    __global const MaterialRecord* material = &materials[point.material];
    __global PathLedger* ledger = &ledgers[path];
    const BvhScene scene = {nodes, blocks, grid};
    const bool flat = bodies[point.body] == STOKES_BODY_FLAT;
    const float3 entry = (float3)(point.x, point.y, point.z), entry_normal = (float3)(point.nx, point.ny, point.nz);
    float3 tangent_s, tangent_t;
    tangent_frame(entry_normal, &tangent_s, &tangent_t);

    const float16 arriving = flux[path];
    const float2 incident = light_of(arriving, pass);
    Interior interior;
    interior.sigma_t = spectra[material->sigma_row];
    interior.albedo = spectra[material->sigma_row + 1u];
    interior.uptake = uptake_of(material, spectra);
    interior.least = least16(interior.sigma_t);
    const float3 within = refract_into((float3)(rays[path].dx, rays[path].dy, rays[path].dz), entry_normal, material->eta);
    Walker walker;
    walker.at = flat ? (float3)(0.0f) : entry;
    walker.direction = flat ? (float3)(dot(within, tangent_s), dot(within, tangent_t), max(-dot(within, entry_normal), 0.0f))
                            : within;
    walker.flux = arriving;
    walker.scattered = false;
    walker.collisions = walker.turns = walker.conversions = 0u;
    walker.absorbed = walker.stokes_loss = (float2)(0.0f);

    float3 normal = (float3)(0.0f, 0.0f, -1.0f);  // outward, where the walker is on the surface
    uint fate = incident.x > 0.0f ? STOKES_FATE_ALIVE : STOKES_FATE_ABSORBED;
    for (uint step = 0u; fate == STOKES_FATE_ALIVE; ++step) {
        if (step == WALK_STEPS) {
            fate = STOKES_FATE_EVENT_LIMIT;
            break;
        }
        const uint event = round.event * WALK_STEPS + step;
        const Random4 draw = random4(pass->seed, pass->pass, path, event, RNG_WALK);
        const Random4 way = random4(pass->seed, pass->pass, path, event, RNG_WALK + 1u);
        const bool acts = material->reradiation_row != STOKES_NONE &&
                          (walker.collisions == 0u || pass->first_collision_only == 0u);
        if (step == 0u) choose_hero(&walker, way.d);
        if (walker.scattered) {
            walker.direction = sphere_direction(way.a, way.b);
            if (flat && dive(&walker, &interior, acts, pass, way.c)) continue;
        }

        const float sigma_hero = value_at(&spectra[material->sigma_row], walker.hero);
        const float free_way = -log(1.0f - draw.a) / sigma_hero;
        float to_surface = flat && walker.direction.z < 0.0f ? walker.at.z / -walker.direction.z : INFINITY;
        Hit hit;
        if (!flat) {
            hit = find_way_out(scene, walker.at, walker.direction, pass->offset_mm, triangles, point.body);
            if (hit.triangle == STOKES_NONE) {
                fate = STOKES_FATE_MISSED_EXIT;
                break;
            }
            to_surface = max(hit.t, 0.0f);
        }

        const bool collides = free_way < to_surface;
        const float flight = collides ? free_way : to_surface;
        // The hero's own exponent is taken out: what remains cannot overflow, whatever it does to the others.
        float16 weights = walker.weights * exp((sigma_hero - interior.sigma_t) * flight);
        if (collides) weights *= interior.sigma_t;
        walker.weights = balanced(weights, walker.lit);
        walker.at += walker.direction * flight;

        if (!collides) {
            if (flat) {
                walker.at.z = 0.0f;
            } else {
                __global const Triangle* tri = &triangles[hit.triangle];
                const float3 e1 = (float3)(tri->e1x, tri->e1y, tri->e1z), e2 = (float3)(tri->e2x, tri->e2y, tri->e2z);
                walker.at = (float3)(tri->v0x, tri->v0y, tri->v0z) + e1 * hit.u + e2 * hit.v;
                normal = normalize(cross(e1, e2));
            }
            const float mu = clamp(dot(walker.direction, normal), 0.0f, 1.0f);
            if (!(material->exit_scale > 0.0f && draw.b < internal_reflectance(mu, material->eta))) break;
            walker.direction = reflect_at(walker.direction, normal);
            walker.scattered = false;
            walker.turns += (uint)(walker.collisions > 0u);
            continue;
        }

        walker.scattered = true;
        walker.collisions += 1u;
        walker.turns += 1u;
        if (acts && draw.c < material->fluorescent_fraction * value_at(&spectra[material->excitation_row], walker.hero)) {
            const uint before = min(ledger->conversions + walker.conversions, (uint)STOKES_WAVELENGTHS - 1u);
            convert(&walker, interior.uptake, &spectra[material->reradiation_row], material->fluorescent_fraction,
                    pass->chain[before], pass, way.d);
        } else {
            if (acts) walker.weights = balanced(walker.weights * (1.0f - interior.uptake), walker.lit);
            walker.absorbed += light_of(walker.flux * walker.weights * (1.0f - interior.albedo), pass);
            walker.flux *= interior.albedo;
        }

        // Roulette below ROULETTE_SHARE of what came in.
        const float alive = sum16(walker.flux * walker.weights);
        const float survival = alive / (ROULETTE_SHARE * incident.x);
        if (!(alive < INFINITY))
            fate = STOKES_FATE_OVERFLOW;
        else if (!(draw.d < survival))
            fate = STOKES_FATE_ABSORBED;
        else if (survival < 1.0f)
            walker.flux /= survival;
    }

    const float16 leaving = walker.flux * walker.weights;
    const float2 kept = fate == STOKES_FATE_ABSORBED ? (float2)(0.0f) : light_of(leaving, pass);
    if (fate == STOKES_FATE_ALIVE && !within_limit(kept.x, ledger)) fate = STOKES_FATE_OVERFLOW;
    const float3 position = flat ? entry + walker.at.x * tangent_s + walker.at.y * tangent_t : walker.at;
    if (flat) normal = entry_normal;
    if (flat && fate == STOKES_FATE_ALIVE &&
        !sheet_reaches(scene, position, normal, 8.0f * pass->offset_mm, triangles, point.body))
        fate = STOKES_FATE_MISSED_EXIT;

    const uint component = walker.conversions > 0u ? STOKES_MAP_FLUORESCENCE
                           : walker.turns > 1u     ? STOKES_MAP_MULTIPLE
                                                   : STOKES_MAP_SINGLE;
    const bool out = fate == STOKES_FATE_ALIVE && kept.x > 0.0f;
    const PhotonHead head = {position.x, position.y, position.z, out ? pack_normal(normal) : STOKES_EMPTY_SLOT};
    fill_slot(fluorescence_heads, fluorescence_flux, slots.first[0] + i, slots.limit[0],
              out && component == STOKES_MAP_FLUORESCENCE, head, leaving);
    fill_slot(single_heads, single_flux, slots.first[1] + i, slots.limit[1], out && component == STOKES_MAP_SINGLE, head,
              leaving);
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
    const bool stored = slots.first[component] + i < slots.limit[component];
    if (out && !stored) fate = STOKES_FATE_MAP_FULL;
    if (fate != STOKES_FATE_ALIVE || !out) {
        if (fate == STOKES_FATE_MISSED_EXIT) ledger->missed_exits += 1u;
        if (fate != STOKES_FATE_ALIVE && fate != STOKES_FATE_ABSORBED) add_light(&ledger->dropped, kept);
        end_path(&rays[path], ledger, fate == STOKES_FATE_ALIVE ? STOKES_FATE_ABSORBED : fate);
        return;
    }
    add_light(&ledger->stored, kept);
    ledger->conversions += walker.conversions;
    const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_RETRACE);
    const float survival = min(kept.x / (16.0f * ROULETTE_SHARE * ledger->reference_flux), 1.0f);
    if (!(draw.a < survival)) {
        add_light(&ledger->roulette, kept);
        end_path(&rays[path], ledger, STOKES_FATE_ABSORBED);
        return;
    }
    const float16 carried = leaving * (exit_weight(material, draw.b) / survival);
    const float2 going_on = light_of(carried, pass);
    add_light(&ledger->roulette, kept - going_on);
    flux[path] = carried;
    go_on(&rays[path], ledger, &round, pass->offset_mm, position, normal, going_on, draw.b, draw.c);
}
