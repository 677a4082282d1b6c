// Distances and look-ups one by one, for test_sample_distance.cpp and test_resample_tables.cpp.
#include "lib/power_table.clh"

__kernel void draw_distances(__global const float* mean_rows, __global const float* cumulative_rows, TableShape shape,
                             __global const float* theta_deg, __global const float* u, __global float* r_mm, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    r_mm[i] = sample_distance(mean_rows, cumulative_rows, shape, theta_deg[i], u[i]);
}

__kernel void look_up(__global const float16* table16, TableShape shape, __global const float* r_mm,
                      __global const float* theta_deg, __global float16* out, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    out[i] = power_table_at(table16, shape, r_mm[i], theta_deg[i]);
}
