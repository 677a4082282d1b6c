// The first collision one by one, for test_first_collision.cpp.
#include "lib/first_collision.clh"

// weights [n][3] float16: of the way, and of the two branches, fluorescent and elastic. branch [n]: probability of the
// first of them. uptake: c E.
__kernel void draw_collisions(__global const float16* sigma_t, __global const float16* uptake, __global const float2* u,
                              uint n, __global float* way_mm, __global float16* weights, __global float* branch) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    way_mm[i] = collision_way(sigma_t, u[i].x, u[i].y);
    const float16 w = collision_weights(*sigma_t, way_mm[i]);
    const float p = uptake_probability(w, *uptake);
    branch[i] = p;
    weights[3u * i] = w;
    weights[3u * i + 1u] = p > 0.0f ? w * *uptake / p : (float16)(0.0f);
    weights[3u * i + 2u] = p < 1.0f ? w * (1.0f - *uptake) / (1.0f - p) : (float16)(0.0f);
}
