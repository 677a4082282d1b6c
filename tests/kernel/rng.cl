// Raw Philox words and uniforms, for test_rng.cpp.
#include "lib/rng.clh"

__kernel void philox_words(__global const uint* counters_and_keys, __global uint* words, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    uint x0 = counters_and_keys[i * 6], x1 = counters_and_keys[i * 6 + 1];
    uint x2 = counters_and_keys[i * 6 + 2], x3 = counters_and_keys[i * 6 + 3];
    philox4x32(&x0, &x1, &x2, &x3, counters_and_keys[i * 6 + 4], counters_and_keys[i * 6 + 5]);
    words[i * 4] = x0;
    words[i * 4 + 1] = x1;
    words[i * 4 + 2] = x2;
    words[i * 4 + 3] = x3;
}

__kernel void uniforms(uint seed, uint pass, uint dimension, __global float* out, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const Random4 r = random4(seed, pass, i, 0u, dimension);
    out[i * 4] = r.a;
    out[i * 4 + 1] = r.b;
    out[i * 4 + 2] = r.c;
    out[i * 4 + 3] = r.d;
}
