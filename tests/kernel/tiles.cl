// The ray order of kernels/lib/tiles.clh, for test_camera_rays.cpp.
#include "lib/tiles.clh"

__kernel void pixels_of_rays(uint width, uint height, __global uint2* pixels) {
    const uint i = (uint)get_global_id(0);
    if (i < width * height) pixels[i] = pixel_of_ray(i, width, height);
}
