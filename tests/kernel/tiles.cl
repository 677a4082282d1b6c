// The ray order of kernels/lib/tiles.clh, for test_camera_rays.cpp and test_score_photons.cpp.
#include "lib/tiles.clh"

__kernel void pixels_of_rays(uint width, uint height, __global uint2* pixels) {
    const uint i = (uint)get_global_id(0);
    if (i < width * height) pixels[i] = pixel_of_ray(i, width, height);
}

// The ray of each ray's pixel.
__kernel void rays_of_pixels(uint width, uint height, __global uint* rays) {
    const uint i = (uint)get_global_id(0);
    if (i >= width * height) return;
    const uint2 at = pixel_of_ray(i, width, height);
    rays[i] = ray_of_pixel(at.x, at.y, width, height);
}
