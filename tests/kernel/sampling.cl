// Frames, directions, points and sums one by one, for test_sampling.cpp.
#include "lib/rng.clh"
#include "lib/sampling.clh"

__kernel void frames(__global const float4* normals, __global float4* s, __global float4* t, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    float3 first, second;
    tangent_frame(normals[i].xyz, &first, &second);
    s[i] = (float4)(first, 0.0f);
    t[i] = (float4)(second, 0.0f);
}

__kernel void cosine_directions(float4 normal, uint seed, __global float4* directions, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const Random4 r = random4(seed, 0u, i, 0u, RNG_SCATTER);
    directions[i] = (float4)(cosine_direction(normal.xyz, r.a, r.b), 0.0f);
}

__kernel void directions_at(float4 normal, __global const float2* u, __global float4* directions, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    directions[i] = (float4)(cosine_direction(normal.xyz, u[i].x, u[i].y), 0.0f);
}

__kernel void triangle_points(uint seed, __global float2* uv, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const Random4 r = random4(seed, 0u, i, 0u, RNG_SCATTER);
    uv[i] = uniform_triangle(r.a, r.b);
}

__kernel void sums(__global const float16* values, __global float* out, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i < n) out[i] = sum16(values[i]);
}

__kernel void circle_points(__global const float* turns, __global float2* points, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i < n) points[i] = unit_circle(turns[i]);
}
