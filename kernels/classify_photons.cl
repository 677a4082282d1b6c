// Stage 3 of a pass: what happens to each photon where it landed, and the lists that the next stages work through.
#include "lib/inline.clh"
#include "lib/rng.clh"
#include "lib/sampling.clh"
#include "shared/material.h"
#include "shared/pass.h"
#include "shared/path.h"
#include "shared/ray.h"

// What a path does next: PHYSICS STEP 1 for translucent materials, the paper's section 3.3.
FORCE_INLINE uint choose_event(__global const MaterialRecord* material, float u) {
    if (material->kind == STOKES_DIFFUSE) return STOKES_EVENT_DIFFUSE;
    if (material->kind != STOKES_TRANSLUCENT) return STOKES_EVENT_NONE;
    if (u < material->fluorescent_fraction)
        return material->reradiation_row == STOKES_NONE ? STOKES_EVENT_NONE : STOKES_EVENT_FLUORESCENCE;
    return material->medium == STOKES_NONE ? STOKES_EVENT_NONE : STOKES_EVENT_ELASTIC;
}

// Work-items: round.count, one an entry of list.
// Reads: list [round.count], rays, hits, flux [W/nm, paths], triangles, shapes, materials.
// Writes: points [paths], kinds [round.count]: STOKES_EVENT_*, ledgers (paths that end here).
// Light that meets the back of a surface is absorbed.
__kernel void classify_photons(EventRound round, __global const PassConstants* pass, __global const uint* list,
                               __global const Ray* rays, __global const Hit* hits, __global const float16* flux,
                               __global const Triangle* triangles, __global const MaterialRecord* materials,
                               __global const ShapeRecord* shapes, __global SurfacePoint* points,
                               __global PathLedger* ledgers, __global uchar* kinds) {
    const uint i = (uint)get_global_id(0);
    if (i >= round.count) return;
    const uint path = list[i];
    kinds[i] = (uchar)STOKES_EVENT_NONE;
    if (ledgers[path].fate != STOKES_FATE_ALIVE) return;
    const float total = sum16(flux[path]);
    if (!(total < INFINITY)) {
        ledgers[path].fate = STOKES_FATE_OVERFLOW;
        return;
    }
    const Hit hit = hits[path];
    if (hit.triangle == STOKES_NONE) {
        ledgers[path].escaped += total;
        ledgers[path].fate = STOKES_FATE_ESCAPED;
        return;
    }
    __global const Triangle* tri = &triangles[hit.triangle];
    const float3 e1 = (float3)(tri->e1x, tri->e1y, tri->e1z);
    const float3 e2 = (float3)(tri->e2x, tri->e2y, tri->e2z);
    const float3 normal = normalize(cross(e1, e2));
    const float3 position = (float3)(tri->v0x, tri->v0y, tri->v0z) + e1 * hit.u + e2 * hit.v;
    const uint material = shapes[tri->shape].material;
    points[path] = (SurfacePoint){position.x, position.y, position.z, material,
                                  normal.x,   normal.y,   normal.z,   tri->body};

    const bool front = rays[path].dx * normal.x + rays[path].dy * normal.y + rays[path].dz * normal.z < 0.0f;
    const Random4 draw = random4(pass->seed, pass->pass, path, round.event, RNG_BRANCH);
    const uint kind = front ? choose_event(&materials[material], draw.a) : STOKES_EVENT_NONE;
    if (kind == STOKES_EVENT_NONE) {
        ledgers[path].absorbed += total;
        ledgers[path].fate = STOKES_FATE_ABSORBED;
    }
    kinds[i] = (uchar)kind;
}

// Work-items: chunks of chunk_size list entries.
// Reads: kinds [count]. Writes: chunk_counts [chunks]: entries of each kind in the chunk.
__kernel void count_lists(uint count, uint chunk_size, __global const uchar* kinds,
                          __global ListCounts* chunk_counts) {
    const uint chunk = (uint)get_global_id(0);
    const uint first = chunk * chunk_size;
    if (first >= count) return;
    const uint last = min(first + chunk_size, count);
    uint diffuse = 0u, fluorescence = 0u, elastic = 0u;
    for (uint i = first; i < last; ++i) {
        const uint kind = (uint)kinds[i];
        diffuse += (uint)(kind == STOKES_EVENT_DIFFUSE);
        fluorescence += (uint)(kind == STOKES_EVENT_FLUORESCENCE);
        elastic += (uint)(kind == STOKES_EVENT_ELASTIC);
    }
    chunk_counts[chunk] = (ListCounts){diffuse + fluorescence + elastic, diffuse, fluorescence, elastic};
}

// Work-items: 1. Turns chunk_counts [chunks] into where each chunk's entries start; writes totals [1].
__kernel void scan_lists(uint chunks, __global ListCounts* chunk_counts, __global ListCounts* totals) {
    if (get_global_id(0) != 0) return;
    ListCounts sum = {0u, 0u, 0u, 0u};
    for (uint chunk = 0u; chunk < chunks; ++chunk) {
        const ListCounts here = chunk_counts[chunk];
        chunk_counts[chunk] = sum;
        sum.alive += here.alive;
        sum.diffuse += here.diffuse;
        sum.fluorescence += here.fluorescence;
        sum.elastic += here.elastic;
    }
    totals[0] = sum;
}

// Work-items: chunks of chunk_size list entries.
// Reads: list, kinds [count], chunk_counts [chunks] from scan_lists.
// Writes: the paths of each kind in list order: alive, diffuse, fluorescence, elastic.
__kernel void write_lists(uint count, uint chunk_size, __global const uint* list, __global const uchar* kinds,
                          __global const ListCounts* chunk_counts, __global uint* alive, __global uint* diffuse,
                          __global uint* fluorescence, __global uint* elastic) {
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
        else
            elastic[at.elastic++] = path;
    }
}
