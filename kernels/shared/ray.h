// Rays, hits and triangles as they travel between kernels.
#ifndef STOKES_SHARED_RAY_H
#define STOKES_SHARED_RAY_H

#include "limits.h"

// A ray segment. Written by emit_photons, scatter_diffuse, retrace_* and camera_rays; read by trace_*.
// t_max < t_min marks a ray that is not to be traced.
typedef struct Ray {
    float ox, oy, oz;  // origin [mm]
    float t_min;       // [mm]
    float dx, dy, dz;  // direction, unit length
    float t_max;       // [mm], may be infinite
} Ray;
STOKES_ASSERT_SIZE(Ray, 32);

// The nearest intersection: point = v0 + u e1 + v e2. Written by trace_*.
typedef struct Hit {
    float t;                // distance along the ray [mm]; undefined without a hit
    float u, v;             // barycentric coordinates of v1 and v2
    unsigned int triangle;  // index into the Triangle buffer, STOKES_NONE: the ray leaves the scene
} Hit;
STOKES_ASSERT_SIZE(Hit, 16);

// A search for the surface of a body near a point of its tangent plane. Written by sample_exits, read by
// trace_probe. reach_mm < 0 marks a probe that is not to be traced.
typedef struct Probe {
    float x, y, z;      // point on the tangent plane [mm]
    float reach_mm;     // how far to look to either side [mm]
    float nx, ny, nz;   // the plane's normal, outward, unit length
    unsigned int body;  // only triangles of this body count
} Probe;
STOKES_ASSERT_SIZE(Probe, 32);

// Triangle.flags
#define STOKES_TRIANGLE_TWO_SIDED 1u  // the back is like the front, else the back is black
#define STOKES_TRIANGLE_OPAQUE 2u     // no light goes below it
#define STOKES_TRIANGLE_EMITTER 4u    // the surface of a light
#define STOKES_TRIANGLE_SOLID 8u      // part of a closed surface, which has an inside
#define STOKES_TRIANGLE_CONTESTED \
    16u  // another body's triangle may lie in its plane, on either side (lib/contacts.clh)

// One triangle of the scene, in the order of the scene's shapes. Written by the host once per scene.
typedef struct Triangle {
    float v0x, v0y, v0z;  // first vertex [mm]
    unsigned int shape;   // index into the ShapeRecord buffer
    float e1x, e1y, e1z;  // v1 - v0 [mm]; the geometric normal is e1 x e2, outward
    unsigned int body;    // shapes of one body share subsurface light
    float e2x, e2y, e2z;  // v2 - v0 [mm]
    unsigned int flags;   // STOKES_TRIANGLE_*
} Triangle;
STOKES_ASSERT_SIZE(Triangle, 48);

#endif
