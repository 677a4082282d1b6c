// The wide bounding volume hierarchy: nodes of 16 or 8 children, their bounds as 16-bit counts or as floats.
#ifndef STOKES_SHARED_BVH_H
#define STOKES_SHARED_BVH_H

#include "limits.h"

// Children are node indices; with STOKES_BVH_LEAF set, the low bits are the index of a block of triangles.
#define STOKES_BVH_LEAF 0x80000000u
#define STOKES_BVH_EMPTY 0xffffffffu  // a root only

// Most levels of nodes that the builder makes.
#define STOKES_BVH_LEVELS 32

// One node, by width and kind of bounds. Bounds are coordinates of the scene's grid (BvhGrid), 0 to 65535,
// rounded outward to counts or to floats; the slack that float rounding asks for is added per ray. Children
// stand in order of falling surface area. An empty slot has lo > hi on every axis and the first block as its
// child: a ray that meets it all the same, because its numbers are not finite, reads triangles that exist.
// Written by the host's builder.
typedef struct BvhNode16 {
    unsigned short lo_x[16], lo_y[16], lo_z[16];
    unsigned short hi_x[16], hi_y[16], hi_z[16];
    unsigned int child[16];
} BvhNode16;
STOKES_ASSERT_SIZE(BvhNode16, 256);

typedef struct BvhNode16f {
    float lo_x[16], lo_y[16], lo_z[16];
    float hi_x[16], hi_y[16], hi_z[16];
    unsigned int child[16];
} BvhNode16f;
STOKES_ASSERT_SIZE(BvhNode16f, 448);

typedef struct BvhNode8 {
    unsigned short lo_x[8], lo_y[8], lo_z[8];
    unsigned short hi_x[8], hi_y[8], hi_z[8];
    unsigned int child[8];
} BvhNode8;
STOKES_ASSERT_SIZE(BvhNode8, 128);

typedef struct BvhNode8f {
    float lo_x[8], lo_y[8], lo_z[8];
    float hi_x[8], hi_y[8], hi_z[8];
    unsigned int child[8];
} BvhNode8f;
STOKES_ASSERT_SIZE(BvhNode8f, 224);

// A kernel is built for one kind of node: 16 counts, unless the build options say otherwise.
// -DSTOKES_BVH_WIDTH=8: nodes of 8 children; -DSTOKES_BVH_FLOAT: float bounds.
#ifdef __OPENCL_C_VERSION__
#ifndef STOKES_BVH_WIDTH
#define STOKES_BVH_WIDTH 16
#endif
#if STOKES_BVH_WIDTH == 16 && defined(STOKES_BVH_FLOAT)
typedef BvhNode16f BvhNode;
#elif STOKES_BVH_WIDTH == 16
typedef BvhNode16 BvhNode;
#elif STOKES_BVH_WIDTH == 8 && defined(STOKES_BVH_FLOAT)
typedef BvhNode8f BvhNode;
#elif STOKES_BVH_WIDTH == 8
typedef BvhNode8 BvhNode;
#else
#error "STOKES_BVH_WIDTH: expected 8 or 16"
#endif
// What a traversal stack must hold: a visit to a node takes one entry off and puts at most all children on.
#define STOKES_BVH_STACK ((STOKES_BVH_WIDTH - 1) * STOKES_BVH_LEVELS + 1)
#endif

// Eight triangles by their corners, structure of arrays, in order of rising triangle index: triangles that
// share an edge see the same corners there, bit for bit, so that no ray slips between them. A long triangle
// may lie, whole, in several blocks. In unused lanes the three corners coincide and triangle is STOKES_NONE.
// Written by the host's builder.
typedef struct BvhBlock {
    float v0x[8], v0y[8], v0z[8];  // [mm]
    float v1x[8], v1y[8], v1z[8];  // [mm]
    float v2x[8], v2y[8], v2z[8];  // [mm]
    unsigned int triangle[8];      // index into the Triangle buffer
} BvhBlock;
STOKES_ASSERT_SIZE(BvhBlock, 320);

// World to grid: (x - origin) * scale, in 0..65535 for every corner of the scene.
typedef struct BvhGrid {
    float origin_x, origin_y, origin_z;  // [mm]
    float scale_x, scale_y, scale_z;     // [counts/mm]
    unsigned int root;                   // child word of the root: a node, a leaf block or STOKES_BVH_EMPTY
    unsigned int pad;
} BvhGrid;
STOKES_ASSERT_SIZE(BvhGrid, 32);

#endif
