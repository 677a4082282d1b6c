// lib/texture.clh on given places, for test_textures.cpp.
#include "lib/texture.clh"

// luminances[n]: of the texture of materials[i] where hits[i] is.
__kernel void luminances(__global const uint* materials, __global const Hit* hits,
                         __global const TextureRecord* records, __global const float* texels,
                         __global const TriangleUv* uv, __global float* found, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    const Textures textures = {records, texels, uv};
    found[i] = texture_luminance(textures, materials[i], hits[i]);
}

// reflectances[n]: of materials[i] at that luminance.
__kernel void reflectances(__global const uint* materials, __global const float* luminances,
                           __global const TextureRecord* records, __global const float16* spectra,
                           __global float16* found, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i < n) found[i] = textured_reflectance(records, spectra, materials[i], luminances[i]);
}
