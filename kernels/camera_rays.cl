// The camera's rays of a pass, one a pixel.
#include "lib/low_discrepancy.clh"
#include "lib/rng.clh"
#include "lib/tiles.clh"
#include "shared/camera.h"
#include "shared/pass.h"
#include "shared/ray.h"

// Where in a pixel its ray of this pass goes through: uniform in [0, 1)^2, and with even_pixels any 2^m passes that follow
// a multiple of 2^m have one ray in each rectangle of 2^-m of the area that halving gives.
FORCE_INLINE float2 place_in_pixel(__global const PassConstants* pass, uint pixel) {
    if (pass->even_pixels) {
        const uint seed = dimension_seed(pass->seed, pixel);
        return sobol2(shuffled_index(pass->pass, seed), seed);
    }
    const Random4 r = random4(pass->seed, pass->pass, pixel, 0u, RNG_CAMERA);
    return (float2)(r.a, r.b);
}

// Work-items: one per pixel, in the order of lib/tiles.clh. One ray through a point of the pixel.
// Reads camera, pass (seed, pass, even_pixels). Writes rays[width * height].
__kernel void camera_rays(CameraRecord camera, __global const PassConstants* pass, __global Ray* rays) {
    const uint i = (uint)get_global_id(0);
    if (i >= camera.width * camera.height) return;
    const uint2 pixel = pixel_of_ray(i, camera.width, camera.height);
    const float2 place = place_in_pixel(pass, pixel.y * camera.width + pixel.x);
    const float x = (float)pixel.x + place.x, y = (float)pixel.y + place.y;
    const float3 direction =
        normalize((float3)(camera.corner_x + x * camera.right_x + y * camera.down_x,
                           camera.corner_y + x * camera.right_y + y * camera.down_y,
                           camera.corner_z + x * camera.right_z + y * camera.down_z));
    Ray ray;
    ray.ox = camera.position_x;
    ray.oy = camera.position_y;
    ray.oz = camera.position_z;
    ray.t_min = 0.0f;
    ray.dx = direction.x;
    ray.dy = direction.y;
    ray.dz = direction.z;
    ray.t_max = INFINITY;
    rays[i] = ray;
}
