// The normal packing of kernels/lib/normal.clh, for test_normal.cpp.
#include "lib/normal.clh"

__kernel void pack_normals(__global const float4* normals, __global uint* packed, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i < n) packed[i] = pack_normal(normals[i].xyz);
}

__kernel void unpack_normals(__global const uint* packed, __global float4* normals, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i < n) normals[i] = (float4)(unpack_normal(packed[i]), 0.0f);
}

// Work-items: n / 16. Dot products of 16 coarse normals with the x, y and z axes.
__kernel void coarse_components(__global const uint* packed, __global float4* normals, uint n) {
    const uint first = (uint)get_global_id(0) * 16u;
    if (first >= n) return;
    const uint16 coarse = coarse_normals(vload16(0, packed + first));
    float x[16], y[16], z[16];
    vstore16(dot_coarse_normals(coarse, (float3)(1.0f, 0.0f, 0.0f)), 0, x);
    vstore16(dot_coarse_normals(coarse, (float3)(0.0f, 1.0f, 0.0f)), 0, y);
    vstore16(dot_coarse_normals(coarse, (float3)(0.0f, 0.0f, 1.0f)), 0, z);
    for (uint i = 0u; i < 16u; ++i) normals[first + i] = (float4)(x[i], y[i], z[i], 0.0f);
}
