// What the camera rays meet, from finding the points to gathering their photons.
#ifndef STOKES_SHARED_GATHER_H
#define STOKES_SHARED_GATHER_H

#include "limits.h"

// A photon counts towards a point when it is nearer than the point's radius, its normal is within 57 degrees of the
// point's, it is not further from the tangent plane than this fraction of the radius, and it lies on the same body: so
// no light comes through a thin wall, round an edge, down from a step or from a sheet close above. The cosine lies
// midway between those of a hexagon's corner, 0.5, and of a cuboctahedron's edge, 0.577: normals are rounded by up to
// 0.007 (lib/normal.clh), and all edges of a regular solid must turn out alike.
#define STOKES_GATHER_MIN_COSINE 0.54f
#define STOKES_GATHER_MAX_HEIGHT 0.25f

// The most random places of a disk that measure_disks tries.
#define STOKES_GATHER_MOST_TRIALS 32u

// The point that a camera ray meets, directly or mirrored by smooth surfaces. Written by collect_points, choose_radii
// and measure_disks, read by add_direct_light, gather_radiance and those of the trial passes; one per camera ray.
typedef struct GatherPoint {
    float x, y, z;          // [mm]
    unsigned int pixel;     // y * width + x
    float nx, ny, nz;       // geometric normal on the side that the ray meets, unit length
    unsigned int material;  // index into the MaterialRecord buffer
    unsigned int maps;      // bit STOKES_MAP_*: photons of this map count; 0: nothing to gather
    // Factor on the density estimate: MaterialRecord.exit_scale where the surface reflects, else 1 (collect_points),
    // times 1 / the share of the disk on the surface, in the mean (measure_disks).
    float weight;
    unsigned int reflected;  // 1: the ray was reflected; 0: the point lies on the pixel's own ray
    float luminance;         // of the material's texture there, in [0, 1]; 0 without one
    float radius_factor;     // its radius over that of the pass, > 0: 1 (collect_points), or of its own (choose_radii)
    unsigned int body;       // Triangle.body
} GatherPoint;
STOKES_ASSERT_SIZE(GatherPoint, 56);

// A pixel's own radius. Written by the host once per scene, read by choose_radii.
typedef struct PixelRadius {
    float factor;           // over that of the pass, > 0
    unsigned int material;  // of the surface it holds for, or STOKES_NONE
} PixelRadius;
STOKES_ASSERT_SIZE(PixelRadius, 8);

#endif
