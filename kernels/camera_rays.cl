// The camera's rays of a pass, one a pixel.
#include "lib/pixel_places.clh"
#include "lib/tiles.clh"
#include "shared/camera.h"
#include "shared/pass.h"
#include "shared/ray.h"

// Work-items: one per pixel, in the order of lib/tiles.clh. One ray through a point of the pixel.
// Reads camera, pass (seed, pass, low_discrepancy_pixels). Writes rays[width * height].
__kernel void camera_rays(CameraRecord camera, __global const PassConstants* pass, __global Ray* rays) {
    const uint i = (uint)get_global_id(0);
    if (i >= camera.width * camera.height) return;
    const uint2 pixel = pixel_of_ray(i, camera.width, camera.height);
    const float2 place = place_in_pixel(pass, pixel.y * camera.width + pixel.x);
    const float x = (float)pixel.x + place.x, y = (float)pixel.y + place.y;
    const float3 direction = normalize((float3)(camera.corner_x + x * camera.right_x + y * camera.down_x,
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
