// lib/fresnel.clh on given values, for test_fresnel.cpp.
#include "lib/fresnel.clh"

// reflectances[n]: at cosine.x and index cosine.y, from outside and from within.
__kernel void reflectances(__global const float2* cosines, __global float2* found, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    found[i] =
        (float2)(external_reflectance(cosines[i].x, cosines[i].y), internal_reflectance(cosines[i].x, cosines[i].y));
}

// directions, normals: x, y, z and in directions the index. refracted, mirrored: x, y, z, 0.
__kernel void turned(__global const float4* directions, __global const float4* normals, __global float4* refracted,
                     __global float4* mirrored, uint n) {
    const uint i = (uint)get_global_id(0);
    if (i >= n) return;
    refracted[i] = (float4)(refract_into(directions[i].xyz, normals[i].xyz, directions[i].w), 0.0f);
    mirrored[i] = (float4)(reflect_at(directions[i].xyz, normals[i].xyz), 0.0f);
}
