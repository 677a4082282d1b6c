// Keys and runs of kernels/lib/hash_grid.clh, for test_hash_photons.cpp.
#include "lib/hash_grid.clh"

__kernel void find_runs(__global const float4* queries, uint n, HashGrid grid, __global uint4* begins,
                        __global uint4* ends) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const KeyRuns runs = key_runs(grid, queries[i].x, queries[i].y, queries[i].z);
    begins[i] = runs.begin;
    ends[i] = runs.end;
}
