// Stage 3 of a pass: what happens to each photon where it landed, and the lists that the next stages work through.
#include "lib/fresnel.clh"
#include "lib/inline.clh"
#include "lib/light_sum.clh"
#include "lib/retrace.clh"
#include "lib/rng.clh"
#include "lib/surface.clh"
#include "lib/surface_normal.clh"
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

// Work-items: round.count, one an entry of list.
// Reads: list [round.count], hits, flux [W/nm, paths], triangles, shapes, materials, spectra (excitation, sigma_t).
// Writes: points [paths], kinds [round.count]: STOKES_EVENT_*, ledgers (paths that end here), rays (specular
//   reflection; a mirrored path goes on with the flux it has).
// Light that meets the back of a surface is absorbed, unless it is two-sided.
__kernel void classify_photons(EventRound round, __global const PassConstants* pass, __global const uint* list,
                               __global Ray* rays, __global const Hit* hits, __global const float16* flux,
                               __global const Triangle* triangles, __global const MaterialRecord* materials,
                               __global const ShapeRecord* shapes, __global const float16* spectra,
                               __global SurfacePoint* points, __global PathLedger* ledgers, __global uchar* kinds) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const uint path = list[i];
    kinds[i] = (uchar)STOKES_EVENT_NONE;
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
    const uint kind = cos_in > 0.0f
                          ? photon_event(&materials[material], spectra, round.branches != 0u, cos_in, flux[path], draw)
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
    kinds[i] = (uchar)kind;
}

// Work-items: chunks of chunk_size list entries.
// Reads: kinds [count]. Writes: chunk_counts [chunks]: entries of each kind in the chunk.
__kernel void count_lists(uint count, uint chunk_size, __global const uchar* kinds, __global ListCounts* chunk_counts) {
    const uint chunk = (uint)get_global_id(0);
    const uint first = chunk * chunk_size;
    if (first >= count) return;
    const uint last = min(first + chunk_size, count);
    uint alive = 0u, diffuse = 0u, fluorescence = 0u, elastic = 0u, branches = 0u;
    for (uint i = first; i < last; ++i) {
        const uint kind = (uint)kinds[i];
        alive += (uint)(kind != STOKES_EVENT_NONE);
        diffuse += (uint)(kind == STOKES_EVENT_DIFFUSE);
        fluorescence += (uint)(kind == STOKES_EVENT_FLUORESCENCE);
        elastic += (uint)(kind == STOKES_EVENT_ELASTIC);
        branches += (uint)(kind == STOKES_EVENT_BRANCHES);
    }
    chunk_counts[chunk] = (ListCounts){alive, diffuse, fluorescence, elastic, branches};
}

// Work-items: 1. Turns chunk_counts [chunks] into where each chunk's entries start; writes totals [1].
__kernel void scan_lists(uint chunks, __global ListCounts* chunk_counts, __global ListCounts* totals) {
    if (get_global_id(0) != 0) return;
    ListCounts sum = {0u, 0u, 0u, 0u, 0u};
    for (uint chunk = 0u; chunk < chunks; ++chunk) {
        const ListCounts here = chunk_counts[chunk];
        chunk_counts[chunk] = sum;
        sum.alive += here.alive;
        sum.diffuse += here.diffuse;
        sum.fluorescence += here.fluorescence;
        sum.elastic += here.elastic;
        sum.branches += here.branches;
    }
    totals[0] = sum;
}

// Work-items: chunks of chunk_size list entries.
// Reads: list, kinds [count], chunk_counts [chunks] from scan_lists.
// Writes: the paths of each kind in list order: alive, diffuse, fluorescence, elastic, branches.
__kernel void write_lists(uint count, uint chunk_size, __global const uint* list, __global const uchar* kinds,
                          __global const ListCounts* chunk_counts, __global uint* alive, __global uint* diffuse,
                          __global uint* fluorescence, __global uint* elastic, __global uint* branches) {
    const uint chunk = (uint)get_global_id(0);
    const uint first = chunk * chunk_size;
    if (first >= count) return;
    const uint last = min(first + chunk_size, count);
    ListCounts at = chunk_counts[chunk];
    for (uint i = first; i < last; ++i) {
        const uint kind = (uint)kinds[i];
        if (kind == STOKES_EVENT_NONE) continue;
        const uint path = list[i];
        alive[at.alive++] = path;
        if (kind == STOKES_EVENT_DIFFUSE)
            diffuse[at.diffuse++] = path;
        else if (kind == STOKES_EVENT_FLUORESCENCE)
            fluorescence[at.fluorescence++] = path;
        else if (kind == STOKES_EVENT_ELASTIC)
            elastic[at.elastic++] = path;
        else if (kind == STOKES_EVENT_BRANCHES)
            branches[at.branches++] = path;
    }
}
