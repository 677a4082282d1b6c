// Points one by one, for test_low_discrepancy.cpp.
#include "lib/low_discrepancy.clh"

__kernel void unscrambled_words(__global uint* words, uint first, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const uint index = first + i;
    words[i * 6] = reverse_bits(index);
    words[i * 6 + 1] = reverse_bits(sobol_word_1(index));
    words[i * 6 + 2] = reverse_bits(sobol_word(index, sobol_directions_2));
    words[i * 6 + 3] = reverse_bits(sobol_word(index, sobol_directions_3));
    words[i * 6 + 4] = reverse_bits(sobol_word(index, sobol_directions_4));
    words[i * 6 + 5] = reverse_bits(sobol_word(index, sobol_directions_5));
}

// Dimensions 2 to 5, from their words.
__kernel void later_points(uint first, uint seed, __global float4* points, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const uint2 a = sobol_words_2_3(first + i, seed), b = sobol_words_4_5(first + i, seed);
    points[i] =
        (float4)(uniform_from_word(a.x), uniform_from_word(a.y), uniform_from_word(b.x), uniform_from_word(b.y));
}

__kernel void points(uint first, uint seed, __global float4* all, __global float2* two, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    all[i] = sobol4(first + i, seed);
    two[i] = sobol2(first + i, seed);
}

__kernel void points_of_seeds(uint index, uint first_seed, __global float4* points, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i < n) points[i] = sobol4(index, first_seed + i);
}

__kernel void shuffled(uint seed, __global uint* indices, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i < n) indices[i] = shuffled_index(i, seed);
}

// For each seed, dimension 0 of two sequences at the same index.
__kernel void joined(uint index, __global float2* out, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const uint a = mix_bits(2u * i), b = mix_bits(2u * i + 1u);
    out[i] = (float2)(sobol2(shuffled_index(index, a), a).x, sobol2(shuffled_index(index, b), b).x);
}
