// Stage 3 of a pass: what happens to each photon where it landed, and the lists that the next stages work through.
#include "lib/fresnel.clh"
#include "lib/inline.clh"
#include "lib/light_sum.clh"
#include "lib/retrace.clh"
#include "lib/rng.clh"
#include "lib/surface.clh"
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

// Where a path of this event is listed; transport: of the material.
FORCE_INLINE uint list_of(uint event, uint transport) {
    if (event == STOKES_EVENT_DIFFUSE) return STOKES_LIST_DIFFUSE;
    if (event >= STOKES_EVENT_FLUORESCENCE) return STOKES_LIST_BELOW(transport, event);
    return event == STOKES_EVENT_SPECULAR ? STOKES_LIST_NONE : STOKES_LIST_ENDED;
}

// Where a path is listed whose ray runs in the medium of a body of model `walk`: it walks on from where the ray starts.
FORCE_INLINE uint walk_on(__global const BodyRecord* bodies, uint body, __global const MaterialRecord* materials,
                          Ray ray, __global SurfacePoint* point) {
    const uint material = bodies[body].material;
    *point = (SurfacePoint){ray.ox, ray.oy, ray.oz, material, -ray.dx, -ray.dy, -ray.dz, body};
    return list_of(STOKES_EVENT_ELASTIC, materials[material].transport);
}

// Work-items: round.count, one an entry of list.
// Reads: list [round.count], hits, flux [W/nm, paths], triangles, shapes, materials, bodies, spectra (excitation,
//   sigma_t).
// Writes: points [paths], departures (the body that is met), entry_lists [round.count]: STOKES_LIST_*, ledgers (paths
//   that end here), rays (specular reflection; a mirrored path goes on with the flux it has), met_bodies [bodies]: 1
//   for each whose front a path meets, where the round notes them.
// Light that meets the back of a surface is absorbed, unless it is two-sided.
__kernel void classify_photons(EventRound round, PASS_ARGUMENTS, SURFACE_ARGUMENTS, __global const BodyRecord* bodies,
                               __global const uint* list, PATH_ARGUMENTS, __global const Hit* hits,
                               __global SurfacePoint* points, __global uchar* entry_lists, __global uint* met_bodies) {
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
    __global Departure* departure = &departures[path];
    if (departure->inside != STOKES_NONE && (departure->arrives == 0u || hit.triangle == STOKES_NONE)) {
        departure->body = departure->inside;
        if (round.notes_bodies != 0u) met_bodies[departure->inside] = 1u;
        entry_lists[i] = (uchar)walk_on(bodies, departure->inside, materials, rays[path], &points[path]);
        return;
    }
    departure->arrives = 0u;
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
    departure->body = tri->body;
    points[path] =
        (SurfacePoint){position.x, position.y, position.z, material, normal.x, normal.y, normal.z, tri->body};

    const float cos_in = min(-dot(direction, normal), 1.0f);
    if (round.notes_bodies != 0u && cos_in > 0.0f) met_bodies[tri->body] = 1u;
    const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_BRANCH);
    const uint kind = cos_in > 0.0f
                          ? photon_event(&materials[material], spectra, round.branches != 0u, cos_in, flux[path], draw)
                          : STOKES_EVENT_NONE;
    if (kind == STOKES_EVENT_SPECULAR) {
        ledger->reflections += 1u;
        continue_path(&rays[path], &departures[path], ledger, &round, pass->offset_mm, position, normal,
                      reflect_at(direction, normal), total);
        if (round.last != 0u) return;
    } else if (kind == STOKES_EVENT_NONE) {
        const bool behind = !(cos_in > 0.0f) && materials[material].kind == STOKES_TRANSLUCENT;
        add_light(&ledger->absorbed, total);
        ledger->fate = behind ? STOKES_FATE_BEHIND : STOKES_FATE_ABSORBED;
    }
    entry_lists[i] = (uchar)list_of(kind, materials[material].transport);
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
