// Stage 3 of a pass: what happens to each photon where it landed, and the lists that the next stages work through.
#include "lib/first_collision.clh"
#include "lib/fresnel.clh"
#include "lib/inline.clh"
#include "lib/light_sum.clh"
#include "lib/retrace.clh"
#include "lib/rng.clh"
#include "lib/surface_normal.clh"
#include "shared/arguments.h"
#include "shared/material.h"
#include "shared/pass.h"
#include "shared/path.h"
#include "shared/ray.h"

// Where a ray meets a triangle: along the ray or from the corners, whichever has the smaller coordinates to round.
FORCE_INLINE float3 hit_position(Ray ray, Hit hit, __global const Triangle* tri) {
    const float3 origin = (float3)(ray.ox, ray.oy, ray.oz), direction = (float3)(ray.dx, ray.dy, ray.dz);
    const float3 v0 = (float3)(tri->v0x, tri->v0y, tri->v0z);
    const float3 e1 = (float3)(tri->e1x, tri->e1y, tri->e1z), e2 = (float3)(tri->e2x, tri->e2y, tri->e2z);
    const float3 from_corner = max(max(fabs(v0), fabs(e1)), fabs(e2));
    const float3 from_origin = max(fabs(origin), fabs(direction * hit.t));
    const bool along =
        max(max(from_origin.x, from_origin.y), from_origin.z) < max(max(from_corner.x, from_corner.y), from_corner.z);
    return along ? origin + direction * hit.t : v0 + e1 * hit.u + e2 * hit.v;
}

// True where light of this branch of a translucent material meets a fluorophore. Model `paper` and surface
// fluorescence: with probability c, PHYSICS STEP 1, the paper's section 3.3. Model `conserving`: at the first
// collision, with the probability of lib/first_collision.clh. Model `walk` decides at each collision below the surface.
FORCE_INLINE bool meets_fluorophore(__global const MaterialRecord* material, __global const float16* spectra,
                                    uint transport, Random4 draw) {
    if (material->medium == STOKES_NONE || transport == STOKES_TRANSPORT_PAPER)
        return draw.a < material->fluorescent_fraction;
    if (transport == STOKES_TRANSPORT_WALK || material->reradiation_row == STOKES_NONE) return false;
    __global const float16* sigma_t = &spectra[material->sigma_row];
    const float16 weights = collision_weights(*sigma_t, collision_way(sigma_t, draw.c, draw.d));
    return draw.a < uptake_probability(weights, uptake_of(material, spectra));
}

// True where some of the light of this flux meets a fluorophore below the surface, and some need not.
FORCE_INLINE bool has_branches(__global const MaterialRecord* material, __global const float16* spectra, float16 flux) {
    const float c = material->fluorescent_fraction;
    if (material->medium == STOKES_NONE || material->reradiation_row == STOKES_NONE || !(c > 0.0f)) return false;
    return sum16(flux * spectra[material->excitation_row]) > 0.0f;
}

// What a path does next where it meets the front of a surface at incidence cosine cos_in. branches: as in EventRound.
FORCE_INLINE uint choose_event(__global const MaterialRecord* material, __global const float16* spectra, uint transport,
                               bool branches, float cos_in, float16 flux, Random4 draw) {
    if (material->kind == STOKES_DIFFUSE) return STOKES_EVENT_DIFFUSE;
    if (material->kind != STOKES_TRANSLUCENT) return STOKES_EVENT_NONE;
    if (material->exit_scale > 0.0f && draw.b < external_reflectance(cos_in, material->eta))
        return STOKES_EVENT_SPECULAR;
    if (branches && has_branches(material, spectra, flux)) return STOKES_EVENT_BRANCHES;
    if (meets_fluorophore(material, spectra, transport, draw))
        return material->reradiation_row == STOKES_NONE ? STOKES_EVENT_NONE : STOKES_EVENT_FLUORESCENCE;
    return material->medium == STOKES_NONE ? STOKES_EVENT_NONE : STOKES_EVENT_ELASTIC;
}

// Where a path of this event is listed; transport: of the body below the surface.
FORCE_INLINE uint list_of(uint event, uint transport) {
    if (event == STOKES_EVENT_DIFFUSE) return STOKES_LIST_DIFFUSE;
    if (event >= STOKES_EVENT_FLUORESCENCE) return STOKES_LIST_BELOW(transport, event);
    return event == STOKES_EVENT_SPECULAR ? STOKES_LIST_NONE : STOKES_LIST_ENDED;
}

// Work-items: round.count, one an entry of list.
// Reads: list [round.count], hits, flux [W/nm, paths], triangles, shapes, materials, spectra (excitation, sigma_t).
// Writes: points [paths], entry_lists [round.count]: STOKES_LIST_*, ledgers (paths that end here), rays (specular
//   reflection; a mirrored path goes on with the flux it has).
// Light that meets the back of a surface is absorbed, unless it is two-sided.
__kernel void classify_photons(EventRound round, PASS_ARGUMENTS, SURFACE_ARGUMENTS, __global const uint* list,
                               PATH_ARGUMENTS, __global const Hit* hits, __global SurfacePoint* points,
                               __global uchar* entry_lists) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const uint path = list[i];
    entry_lists[i] = (uchar)STOKES_LIST_ENDED;
    __global PathLedger* ledger = &ledgers[path];
    if (ledger->fate != STOKES_FATE_ALIVE) return;
    const float2 total = light_of(flux[path], pass);
    if (!(total.x < INFINITY)) {
        ledger->fate = STOKES_FATE_OVERFLOW;
        return;
    }
    const Hit hit = hits[path];
    if (hit.triangle == STOKES_NONE) {
        add_light(&ledger->escaped, total);
        ledger->fate = STOKES_FATE_ESCAPED;
        return;
    }
    __global const Triangle* tri = &triangles[hit.triangle];
    const float3 direction = (float3)(rays[path].dx, rays[path].dy, rays[path].dz);
    const float3 normal = facing_normal(*tri, direction);
    const float3 position = hit_position(rays[path], hit, tri);
    const uint material = shapes[tri->shape].material;
    points[path] =
        (SurfacePoint){position.x, position.y, position.z, material, normal.x, normal.y, normal.z, tri->body};

    const float cos_in = min(-dot(direction, normal), 1.0f);
    const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_BRANCH);
    const uint kind = cos_in > 0.0f ? choose_event(&materials[material], spectra, pass->transport, round.branches != 0u,
                                                   cos_in, flux[path], draw)
                                    : STOKES_EVENT_NONE;
    if (kind == STOKES_EVENT_SPECULAR) {
        ledger->reflections += 1u;
        continue_path(&rays[path], ledger, &round, pass->offset_mm, position, normal, reflect_at(direction, normal),
                      total);
        if (round.last != 0u) return;
    } else if (kind == STOKES_EVENT_NONE) {
        add_light(&ledger->absorbed, total);
        ledger->fate = STOKES_FATE_ABSORBED;
    }
    entry_lists[i] =
        (uchar)list_of(kind, materials[material].medium == STOKES_NONE && pass->transport == STOKES_TRANSPORT_WALK
                                 ? STOKES_TRANSPORT_CONSERVING
                                 : pass->transport);
}

// Work-items: chunks of chunk_size list entries.
// Reads: entry_lists [count]. Writes: chunk_counts [chunks]: entries of each list in the chunk.
__kernel void count_lists(uint count, uint chunk_size, __global const uchar* entry_lists,
                          __global ListCounts* chunk_counts) {
    const uint chunk = (uint)get_global_id(0);
    const uint first = chunk * chunk_size;
    if (first >= count) return;
    ListCounts counts = {0u, {0u}, {0u}, {0u}};
    for (uint i = first; i < min(first + chunk_size, count); ++i) {
        const uint list = (uint)entry_lists[i];
        counts.alive += (uint)(list != STOKES_LIST_ENDED);
        if (list < STOKES_LIST_COUNT) counts.count[list] += 1u;
    }
    chunk_counts[chunk] = counts;
}

// Work-items: 1. Reads and writes chunk_counts [chunks]: alive and first become where the chunk's entries start. Writes
// totals [1]. The lists stand one behind the other.
__kernel void scan_lists(uint chunks, __global ListCounts* chunk_counts, __global ListCounts* totals) {
    if (get_global_id(0) != 0) return;
    ListCounts sum = {0u, {0u}, {0u}, {0u}};
    for (uint chunk = 0u; chunk < chunks; ++chunk)
        for (uint list = 0u; list < STOKES_LIST_COUNT; ++list) sum.count[list] += chunk_counts[chunk].count[list];
    for (uint list = 1u; list < STOKES_LIST_COUNT; ++list)
        sum.first[list] = sum.first[list - 1u] + sum.count[list - 1u];
    ListCounts at = sum;
    for (uint chunk = 0u; chunk < chunks; ++chunk) {
        const uint alive = chunk_counts[chunk].alive;
        chunk_counts[chunk].alive = at.alive;
        at.alive += alive;
        for (uint list = 0u; list < STOKES_LIST_COUNT; ++list) {
            chunk_counts[chunk].first[list] = at.first[list];
            at.first[list] += chunk_counts[chunk].count[list];
        }
    }
    sum.alive = at.alive;
    totals[0] = sum;
}

// Work-items: chunks of chunk_size list entries.
// Reads: list, entry_lists [count], chunk_counts [chunks] from scan_lists.
// Writes: next_alive: the paths that go on; event_lists: those of each list, both in the order of list.
__kernel void write_lists(uint count, uint chunk_size, __global const uint* list, __global const uchar* entry_lists,
                          __global const ListCounts* chunk_counts, __global uint* next_alive,
                          __global uint* event_lists) {
    const uint chunk = (uint)get_global_id(0);
    const uint first = chunk * chunk_size;
    if (first >= count) return;
    ListCounts at = chunk_counts[chunk];
    for (uint i = first; i < min(first + chunk_size, count); ++i) {
        const uint into = (uint)entry_lists[i];
        if (into == STOKES_LIST_ENDED) continue;
        next_alive[at.alive++] = list[i];
        if (into < STOKES_LIST_COUNT) event_lists[at.first[into]++] = list[i];
    }
}
