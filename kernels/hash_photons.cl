// Sorts the photons of one map into the cells of a spatial hash: a counting sort in two levels, first into
// STOKES_HASH_BUCKETS runs of keys, then by key within each. Chunks of slots count and scatter apart from one
// another, so there are no atomics, and the order in a cell is the order of the slots whatever the device.
#include "lib/hash_grid.clh"
#include "shared/arguments.h"
#include "shared/photon.h"

// Work-items: slots. Reads heads[slots]. Writes keys[slots], STOKES_NONE for a slot without a photon.
__kernel void find_keys(uint slots, HashGrid hash_grid, __global const PhotonHead* map_heads, __global uint* keys) {
    const uint i = (uint)get_global_id(0);
    if (i >= slots) return;
    const uint key = grid_key(hash_grid, map_heads[i].x, map_heads[i].y, map_heads[i].z);
    keys[i] = map_heads[i].normal == STOKES_EMPTY_SLOT ? STOKES_NONE : key;
}

// Work-items: STOKES_HASH_CHUNKS. Chunk c counts its photons per bucket.
// Reads keys[slots]. Writes histograms[STOKES_HASH_CHUNKS][STOKES_HASH_BUCKETS].
__kernel void count_buckets(uint slots, HashGrid hash_grid, __global const uint* keys, __global uint* histograms) {
    const uint chunk = (uint)get_global_id(0);
    if (chunk >= STOKES_HASH_CHUNKS) return;
    __global uint* counts = histograms + chunk * STOKES_HASH_BUCKETS;
    for (uint b = 0u; b < STOKES_HASH_BUCKETS; ++b) counts[b] = 0u;
    const uint length = (slots + STOKES_HASH_CHUNKS - 1u) / STOKES_HASH_CHUNKS;
    const uint end = min(slots, (chunk + 1u) * length);
    for (uint i = chunk * length; i < end; ++i)
        if (keys[i] != STOKES_NONE) ++counts[keys[i] >> hash_grid.bucket_shift];
}

// Work-items: STOKES_HASH_BUCKETS / 16, a bucket a lane. Each bucket's counts become the number of its
// photons in earlier chunks. Updates histograms[STOKES_HASH_CHUNKS][STOKES_HASH_BUCKETS].
// Writes bucket_starts[1 + bucket] = photons of the bucket.
__kernel void scan_chunks(__global uint* histograms, __global uint* bucket_starts) {
    const uint first = (uint)get_global_id(0) * 16u;
    if (first >= STOKES_HASH_BUCKETS) return;
    uint16 sum = 0u;
    for (uint c = 0u; c < STOKES_HASH_CHUNKS; ++c) {
        __global uint* counts = histograms + c * STOKES_HASH_BUCKETS + first;
        const uint16 count = vload16(0, counts);
        vstore16(sum, 0, counts);
        sum += count;
    }
    vstore16(sum, 0, bucket_starts + 1u + first);
}

// Work-items: 1. Counts become starts: bucket_starts[0..STOKES_HASH_BUCKETS], the last one all photons.
__kernel void scan_buckets(__global uint* bucket_starts) {
    if (get_global_id(0) != 0) return;
    uint sum = 0u;
    bucket_starts[0] = 0u;
    for (uint b = 1u; b <= STOKES_HASH_BUCKETS; ++b) {
        sum += bucket_starts[b];
        bucket_starts[b] = sum;
    }
}

// Work-items: STOKES_HASH_CHUNKS. Chunk c writes its photons behind those of earlier chunks, bucket by
// bucket. Reads keys[slots], bucket_starts. Uses up histograms. Writes entries[photons] = (key, slot).
__kernel void scatter_slots(uint slots, HashGrid hash_grid, __global const uint* keys,
                            __global const uint* bucket_starts, __global uint* histograms, __global uint2* entries) {
    const uint chunk = (uint)get_global_id(0);
    if (chunk >= STOKES_HASH_CHUNKS) return;
    __global uint* next = histograms + chunk * STOKES_HASH_BUCKETS;
    for (uint b = 0u; b < STOKES_HASH_BUCKETS; ++b) next[b] += bucket_starts[b];
    const uint length = (slots + STOKES_HASH_CHUNKS - 1u) / STOKES_HASH_CHUNKS;
    const uint end = min(slots, (chunk + 1u) * length);
    for (uint i = chunk * length; i < end; ++i) {
        const uint key = keys[i];
        if (key != STOKES_NONE) entries[next[key >> hash_grid.bucket_shift]++] = (uint2)(key, i);
    }
}

// Work-items: STOKES_HASH_BUCKETS. Each bucket sorts its photons by key and finds where its cells start.
// Reads entries[photons], bucket_starts. Writes order[photons] = slot, cell_starts[keys + 1].
__kernel void sort_buckets(HashGrid hash_grid, __global const uint2* entries, __global const uint* bucket_starts,
                           __global uint* cell_starts, __global uint* order) {
    const uint bucket = (uint)get_global_id(0);
    if (bucket >= STOKES_HASH_BUCKETS) return;
    const uint first_key = min(bucket << hash_grid.bucket_shift, hash_grid.keys);
    const uint end_key = min((bucket + 1u) << hash_grid.bucket_shift, hash_grid.keys);
    const uint begin = bucket_starts[bucket], end = bucket_starts[bucket + 1u];
    // Counts, then starts, then, each moved on by its photons, ends: a cell's end is the next one's start.
    __global uint* ends = cell_starts + 1;
    if (bucket == 0u) cell_starts[0] = 0u;
    for (uint k = first_key; k < end_key; ++k) ends[k] = 0u;
    for (uint i = begin; i < end; ++i) ++ends[entries[i].x];
    uint sum = begin;
    for (uint k = first_key; k < end_key; ++k) {
        const uint count = ends[k];
        ends[k] = sum;
        sum += count;
    }
    for (uint i = begin; i < end; ++i) {
        const uint2 entry = entries[i];
        order[ends[entry.x]++] = entry.y;
    }
}

// Work-items: slots / 16, rounded up. Item i moves photons 16 i .. 16 i + 15 into cell order.
// Reads heads[slots], flux[slots] [W/nm], order[photons], cell_starts[keys] = photons.
// Writes positions: x, y and z [3][stride] [mm], normals[photons] and sorted_flux[photons]
// [W/nm].
__kernel void permute_photons(HashGrid hash_grid, __global const PhotonHead* map_heads,
                              __global const float16* map_flux, __global const uint* order,
                              __global const uint* cell_starts, __global float* positions, __global uint* normals,
                              __global float16* sorted_flux) {
    const uint photons = cell_starts[hash_grid.keys];
    const uint first = (uint)get_global_id(0) * 16u;
    if (first >= photons) return;
    const uint count = min(photons - first, 16u);
    for (uint i = 0u; i < count; ++i) {
        const uint slot = order[first + i];
        const PhotonHead head = map_heads[slot];
        positions[first + i] = head.x;
        positions[hash_grid.stride + first + i] = head.y;
        positions[2u * hash_grid.stride + first + i] = head.z;
        normals[first + i] = head.normal;
        sorted_flux[first + i] = map_flux[slot];
    }
}
