// The normal packing of kernels/lib/normal.clh, for test_normal.cpp.
#include "lib/normal.clh"

__kernel void pack_normals(__global const float4* normals, __global const uint* bodies, __global uint* packed, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i < n) packed[i] = pack_normal(normals[i].xyz, bodies[i]);
}

// Work-items: n / 16. Dot products of 16 normals with the x, y and z axes, and whether they are of the body.
__kernel void packed_components(__global const uint* packed, uint body, __global float4* normals, uint n) {
    const uint first = (uint)get_global_id(0) * 16u;
    if (first >= n) return;
    const uint16 sixteen = vload16(0, packed + first);
    float x[16], y[16], z[16];
    int of[16];
    vstore16(dot_packed_normals(sixteen, (float3)(1.0f, 0.0f, 0.0f)), 0, x);
    vstore16(dot_packed_normals(sixteen, (float3)(0.0f, 1.0f, 0.0f)), 0, y);
    vstore16(dot_packed_normals(sixteen, (float3)(0.0f, 0.0f, 1.0f)), 0, z);
    vstore16(of_body(sixteen, body), 0, of);
    for (uint i = 0u; i < 16u; ++i) normals[first + i] = (float4)(x[i], y[i], z[i], (float)of[i]);
}
