// Buffers that kernels take together, by the names under which the host binds them (host/device/kernel.hpp). OpenCL
// C 1.2 has no pointers in structs that are arguments, so that a group is a macro. Each one is bound by whoever owns
// its buffers.
#ifndef STOKES_SHARED_ARGUMENTS_H
#define STOKES_SHARED_ARGUMENTS_H

// The scene's bounding volume hierarchy (shared/bvh.h). Bound by RayScene.
#define RAY_SCENE_ARGUMENTS __global const BvhNode *bvh_nodes, __global const BvhBlock *bvh_blocks, BvhGrid bvh_grid

// [triangles], [shapes], [materials]. Bound by DeviceScene.
#define SURFACE_ARGUMENTS \
    __global const Triangle *triangles, __global const ShapeRecord *shapes, __global const MaterialRecord *materials

// [materials], texels of all pictures, [triangles] or one (shared/texture.h). Bound by DeviceTextures.
#define TEXTURE_ARGUMENTS \
    __global const TextureRecord *texture_records, __global const float *texels, __global const TriangleUv *texture_uv

// lights [light_count], light_areas [triangles of surface lights]: cumulative within a light [mm^2]. Bound by
// DeviceScene.
#define LIGHT_ARGUMENTS uint light_count, __global const LightRecord *lights, __global const float *light_areas

// cells [cell_count], first_photons [cell_count + 1]. Bound by PassInputs.
#define EMISSION_ARGUMENTS uint cell_count, __global const EmissionCell *cells, __global const uint *first_photons

// The pass's constants, and spectra: rows of the pass's wavelengths as SpectraLayout has them. Bound by PassInputs.
#define PASS_ARGUMENTS __global const PassConstants *pass, __global const float16 *spectra

// What the distances of subsurface light are drawn from, as TableShape has it: mean_rows and cumulative_rows [entries].
// Bound by the transport.
#define TABLE_ARGUMENTS \
    __global const TableShape *table_shapes, __global const float *mean_rows, __global const float *cumulative_rows

// The state of each path [paths]: its next ray, where that starts, its flux [W/nm] and its account. Bound by
// PhotonPaths.
#define PATH_ARGUMENTS \
    __global Ray *rays, __global Departure *departures, __global float16 *flux, __global PathLedger *ledgers

// The slots of a photon map (shared/photon.h). Bound by PhotonMap.
#define MAP_ARGUMENTS __global PhotonHead *map_heads, __global float16 *map_flux

// A photon map in cell order (shared/hash_grid.h): cell_starts [keys + 1]; positions: x, y and z, [stride] each [mm];
// normals, as PhotonHead has them; sorted_flux [W/nm]. Bound by SpatialHash.
#define SORTED_MAP_ARGUMENTS                                                               \
    HashGrid hash_grid, __global const uint *cell_starts, __global const float *positions, \
        __global const uint *normals, __global const float16 *sorted_flux

#endif
