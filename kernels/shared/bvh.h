// The 16-wide bounding volume hierarchy with 16-bit bounds.
#ifndef STOKES_SHARED_BVH_H
#define STOKES_SHARED_BVH_H

#include "limits.h"

// Children are node indices; with STOKES_BVH_LEAF set, the low bits are the index of a block of triangles.
#define STOKES_BVH_WIDTH 16
#define STOKES_BVH_LEAF 0x80000000u
#define STOKES_BVH_EMPTY 0xffffffffu

// One node. Bounds are counts of the scene's grid (BvhGrid), rounded outward with slack. An empty slot has
// lo > hi on every axis and child STOKES_BVH_EMPTY. Written by the host's builder.
typedef struct BvhNode {
    unsigned short lo_x[16], lo_y[16], lo_z[16];
    unsigned short hi_x[16], hi_y[16], hi_z[16];
    unsigned int child[16];
} BvhNode;
STOKES_ASSERT_SIZE(BvhNode, 256);

// Eight triangles, structure of arrays; unused lanes have e1 = e2 = 0 and triangle STOKES_NONE.
typedef struct BvhBlock {
    float v0x[8], v0y[8], v0z[8];  // [mm]
    float e1x[8], e1y[8], e1z[8];  // [mm]
    float e2x[8], e2y[8], e2z[8];  // [mm]
    unsigned int triangle[8];      // index into the Triangle buffer
} BvhBlock;
STOKES_ASSERT_SIZE(BvhBlock, 320);

// World to grid: count = (x - origin) * scale.
typedef struct BvhGrid {
    float origin_x, origin_y, origin_z;  // [mm]
    float scale_x, scale_y, scale_z;     // [counts/mm]
    unsigned int root;                   // child word of the root: a node, a leaf block or STOKES_BVH_EMPTY
    unsigned int pad;
} BvhGrid;
STOKES_ASSERT_SIZE(BvhGrid, 32);

#endif
