// Light that is re-radiated several times, for test_reradiation.cpp.
#include "lib/reradiation.clh"

// One item a draw, u [n][times]. out [n]: what is left of flux after that many conversions by the same rows.
__kernel void reradiate_often(__global const PassConstants* pass, __global const float16* rows,
                              __global const float16* flux, __global const float* u, uint times, uint n,
                              __global float16* out, __global uint* histories) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    float16 f = *flux;
    uint history = 0u;
    for (uint k = 0u; k < times; ++k) {
        const LightHistory light = {k, history, u[i * times + k]};
        uint leader;
        f = reemit(rows, f, pass, light, &leader);
        history = with_leader(history, leader);
    }
    out[i] = f;
    histories[i] = history;
}
