// How much each photon of a trial pass adds to the picture, for the aiming of emission.
#include "lib/film.clh"
#include "lib/inline.clh"
#include "lib/texture.clh"
#include "lib/tiles.clh"
#include "shared/arguments.h"
#include "shared/camera.h"
#include "shared/gather.h"
#include "shared/material.h"
#include "shared/pass.h"
#include "shared/photon.h"

// A photon counts as visible where the point that the camera ray of its pixel meets is nearer than this many of the
// pixel's widths on the surface, and of its body.
#define VISIBLE_WIDTHS 3.0f

// Work-items: count, the events of a round whose deposits stand in slots first_slot + i * exits_each + k, k <
// exits_each. Reads: event_lists, the events' paths from first_entry on. Writes: path_of_slot, below slot_limit.
__kernel void note_paths(uint count, uint exits_each, uint first_entry, uint first_slot, uint slot_limit,
                         __global const uint* event_lists, __global uint* path_of_slot) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    for (uint k = 0u; k < exits_each; ++k) {
        const uint slot = first_slot + i * exits_each + k;
        if (slot < slot_limit) path_of_slot[slot] = event_lists[first_entry + i];
    }
}

// Work-items: slots of the map.
// Reads: heads, flux [slots, W/nm], points [width * height] in the order of lib/tiles.clh, as collect_points leaves
//   them, spectra, texture_records, pass (to_x, to_y, to_z).
// Writes: scores [slots]: the squares that the photon adds to X, Y and Z [(cd/m^2)^2 mm^2], summed over pixels, but for
//   the square of the radius: a photon of flux f in a disk of area A on which a pixel covers the area a adds f/(pi A)
//   to A/a pixels. 0 where the photon is not visible.
__kernel void score_photons(uint slots, uint map, CameraRecord camera, PASS_ARGUMENTS,
                            __global const TextureRecord* texture_records, __global const PhotonHead* map_heads,
                            __global const float16* map_flux, __global const GatherPoint* gather_points,
                            __global float* scores) {
    const uint i = (uint)get_global_id(0);
    if (i >= slots) return;
    scores[i] = 0.0f;
    if (map_heads[i].normal == STOKES_EMPTY_SLOT) return;
    const float3 position = (float3)(map_heads[i].x, map_heads[i].y, map_heads[i].z);
    const float3 to = position - (float3)(camera.position_x, camera.position_y, camera.position_z);
    const float3 corner = (float3)(camera.corner_x, camera.corner_y, camera.corner_z);
    const float3 right = (float3)(camera.right_x, camera.right_y, camera.right_z);
    const float3 down = (float3)(camera.down_x, camera.down_y, camera.down_z);
    const float depth = dot(to, normalize(cross(right, down)));
    if (!(depth > 0.0f)) return;
    const float3 on_film = to / depth - corner;
    const float x = dot(on_film, right) / dot(right, right), y = dot(on_film, down) / dot(down, down);
    if (!(x >= 0.0f && y >= 0.0f && x < (float)camera.width && y < (float)camera.height)) return;

    const GatherPoint point = gather_points[ray_of_pixel((uint)x, (uint)y, camera.width, camera.height)];
    if ((point.maps & (1u << map)) == 0u || (map_heads[i].normal >> 24) != (point.body & 255u)) return;
    const float3 away = position - (float3)(point.x, point.y, point.z);
    const float facing = fabs(dot(to, (float3)(point.nx, point.ny, point.nz))) / depth;
    const float area = length(right) * length(down) * depth * depth / max(facing, 1e-3f);
    if (dot(away, away) > VISIBLE_WIDTHS * VISIBLE_WIDTHS * area) return;
    float16 light = map_flux[i] * (point.weight * M_1_PI_F);
    if (map == STOKES_MAP_SURFACE)
        light *= textured_reflectance(texture_records, spectra, point.material, point.luminance);
    const float4 value = film_value(light, pass);
    scores[i] = dot(value, value) / area;
}
