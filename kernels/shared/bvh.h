// The 16-wide bounding volume hierarchy with 16-bit bounds.
#ifndef STOKES_SHARED_BVH_H
#define STOKES_SHARED_BVH_H

#include "limits.h"

// Children are node indices; with STOKES_BVH_LEAF set, the low bits are the index of a block of triangles.
#define STOKES_BVH_WIDTH 16
#define STOKES_BVH_LEAF 0x80000000u
#define STOKES_BVH_EMPTY 0xffffffffu  // a root only

// Most levels of nodes that the builder makes, and what a traversal stack must therefore hold: a visit to a
// node takes one entry off and puts at most 16 on.
#define STOKES_BVH_LEVELS 32
#define STOKES_BVH_STACK (15 * STOKES_BVH_LEVELS + 1)

// One node. Bounds are counts of the scene's grid (BvhGrid), rounded outward; the slack that float rounding
// asks for is added per ray. Children stand in order of falling surface area. An empty slot has lo > hi on
// every axis and the first block as its child: a ray that meets it all the same, because its numbers are not
// finite, reads triangles that exist. Written by the host's builder.
typedef struct BvhNode {
    unsigned short lo_x[16], lo_y[16], lo_z[16];
    unsigned short hi_x[16], hi_y[16], hi_z[16];
    unsigned int child[16];
} BvhNode;
STOKES_ASSERT_SIZE(BvhNode, 256);

// Eight triangles by their corners, structure of arrays, in order of rising triangle index: triangles that
// share an edge see the same corners there, bit for bit, so that no ray slips between them. In unused lanes
// the three corners coincide and triangle is STOKES_NONE. Written by the host's builder.
typedef struct BvhBlock {
    float v0x[8], v0y[8], v0z[8];  // [mm]
    float v1x[8], v1y[8], v1z[8];  // [mm]
    float v2x[8], v2y[8], v2z[8];  // [mm]
    unsigned int triangle[8];      // index into the Triangle buffer
} BvhBlock;
STOKES_ASSERT_SIZE(BvhBlock, 320);

// World to grid: count = (x - origin) * scale, in 0..65535 for every corner of the scene.
typedef struct BvhGrid {
    float origin_x, origin_y, origin_z;  // [mm]
    float scale_x, scale_y, scale_z;     // [counts/mm]
    unsigned int root;                   // child word of the root: a node, a leaf block or STOKES_BVH_EMPTY
    unsigned int pad;
} BvhGrid;
STOKES_ASSERT_SIZE(BvhGrid, 32);

#endif
