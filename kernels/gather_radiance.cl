// What the camera rays see: light that surfaces emit, and the density estimate over the photon maps.
// Surfaces have a front only, the side of their outward normal; their back is black, unless they are two-sided.
#include "lib/film.clh"
#include "lib/gather.clh"
#include "lib/inline.clh"
#include "lib/lights.clh"
#include "lib/surface.clh"
#include "lib/surface_normal.clh"
#include "lib/texture.clh"
#include "lib/tiles.clh"
#include "shared/arguments.h"
#include "shared/camera.h"
#include "shared/layers.h"
#include "shared/material.h"
#include "shared/pass.h"
#include "shared/photon.h"
#include "shared/ray.h"

// Work-items: one per camera ray, in the order of lib/tiles.clh. Finds the point each ray sees, and adds the
// light it emits to the film's surface layer.
// Reads rays, hits [width * height], triangles, shapes, materials, lights, textures of the scene, emitted[lights]
// [W mm^-2 sr^-1 nm^-1], pass (to_x, to_y, to_z). Writes points[width * height].
// Adds to film[STOKES_LAYER_COUNT][width * height] (X, Y, Z, 0) [cd/m^2].
__kernel void collect_points(CameraRecord camera, __global const PassConstants* pass, SURFACE_ARGUMENTS,
                             LIGHT_ARGUMENTS, __global const float16* light_radiance, TEXTURE_ARGUMENTS,
                             __global const Ray* rays, __global const Hit* hits, __global GatherPoint* gather_points,
                             __global float4* film) {
    const uint i = (uint)get_global_id(0);
    const uint pixels = camera.width * camera.height;
    if (i >= pixels) return;
    const uint2 at = pixel_of_ray(i, camera.width, camera.height);
    const Hit hit = hits[i];
    GatherPoint point;
    point.pixel = at.y * camera.width + at.x;
    point.maps = 0u;
    point.weight = 1.0f;
    point.radius_factor = 1.0f;
    point.reflected =
        (uint)(rays[i].ox != camera.position_x || rays[i].oy != camera.position_y || rays[i].oz != camera.position_z);
    if (hit.triangle != STOKES_NONE) {
        const Triangle t = triangles[hit.triangle];
        const ShapeRecord shape = shapes[t.shape];
        const float3 normal = facing_normal(t, (float3)(rays[i].dx, rays[i].dy, rays[i].dz));
        point.x = t.v0x + hit.u * t.e1x + hit.v * t.e2x;
        point.y = t.v0y + hit.u * t.e1y + hit.v * t.e2y;
        point.z = t.v0z + hit.u * t.e1z + hit.v * t.e2z;
        point.nx = normal.x;
        point.ny = normal.y;
        point.nz = normal.z;
        point.material = shape.material;
        point.body = t.body;
        const Textures textures = {texture_records, texels, texture_uv};
        point.luminance = texture_luminance(textures, shape.material, hit);
        const float cos_in = -(normal.x * rays[i].dx + normal.y * rays[i].dy + normal.z * rays[i].dz);
        if (cos_in > 0.0f) {
            const VisibleSurface visible = visible_surface(&materials[shape.material], min(cos_in, 1.0f));
            point.maps = visible.maps;
            point.weight = visible.weight;
            if (shape.light != STOKES_NONE)
                film[STOKES_LAYER_SURFACE * pixels + point.pixel] +=
                    film_value(radiance_of(&lights[shape.light], light_radiance[shape.light]) / visible.share, pass);
        }
    }
    gather_points[i] = point;
}

// Work-items: one per point; launched once per map and class of radii: of points whose radius_factor is in
// (largest_factor / 2, largest_factor], with a grid of radius_mm for the largest. L = 1/(pi r^2) * sum over the map's
// photons of flux / pi (eq. 6 of Kugita et al.), times the point's weight, for the surface map times the reflectance.
// Reads points[count], the map in cell order with its hash (hash_photons.cl), spectra (row i: reflectance of
// material i, without its texture), textures, pass (to_x, to_y, to_z).
// Adds to film[STOKES_LAYER_COUNT][count] (X, Y, Z, 0) [cd/m^2].
__kernel void gather_radiance(uint count, uint map, float largest_factor, PASS_ARGUMENTS, SORTED_MAP_ARGUMENTS,
                              __global const TextureRecord* texture_records, __global const GatherPoint* gather_points,
                              __global float4* film) {
    const uint i = (uint)get_global_id(0);
    if (i >= count || (gather_points[i].maps & (1u << map)) == 0u) return;
    const float factor = gather_points[i].radius_factor / largest_factor;
    if (!(factor > 0.5f && factor <= 1.0f)) return;
    const GatherPoint point = gather_points[i];
    const float radius = hash_grid.radius_mm * factor;
    const float16 sum =
        sum_flux(hash_grid, cell_starts, positions, normals, sorted_flux, (float3)(point.x, point.y, point.z),
                 (float3)(point.nx, point.ny, point.nz), point.body, radius);
    float16 radiance = sum * (point.weight * M_1_PI_F * M_1_PI_F / (radius * radius));
    if (map == STOKES_MAP_SURFACE)
        radiance *= textured_reflectance(texture_records, spectra, point.material, point.luminance);
    film[map * count + point.pixel] += film_value(radiance, pass);
}
