// The spatial hash over the photons of one map.
#ifndef STOKES_SHARED_HASH_GRID_H
#define STOKES_SHARED_HASH_GRID_H

#include "limits.h"

// Runs of slots that are counted apart from one another; fixed, so that nothing depends on the device.
#define STOKES_HASH_CHUNKS 256u

// Runs of keys that are sorted apart from one another.
#define STOKES_HASH_BUCKETS 512u

// Cells along an axis at most; what lies beyond belongs to the border cells.
#define STOKES_HASH_MAX_CELLS 1048576u

// Readers take photons sixteen at a time: arrays in cell order are this much longer than their last photon.
#define STOKES_HASH_PADDING 16u

// Cells are cubes slightly larger than twice the radius, so that the ball about a query lies in 2 x 2 x 2 of
// them. A cell's key is the first key of its row (y, z) plus its x: neighbours along x stand side by side.
// Written by SpatialHash for each build.
typedef struct HashGrid {
    float origin_x, origin_y, origin_z;      // corner of cell (0, 0, 0) [mm]
    float cells_per_mm;                      // 1 / edge of a cell [1/mm]
    unsigned int cells_x, cells_y, cells_z;  // at least 1 each
    unsigned int row_mask;                   // rows start at hash(y, z) & row_mask; 0: every cell has a key of its own
    unsigned int keys;                       // keys are below this; there are keys + 1 cell starts
    unsigned int bucket_shift;               // key >> bucket_shift is its bucket, below STOKES_HASH_BUCKETS
    float radius_mm;                         // of the density estimate
    unsigned int stride;                     // between the x, y and z arrays of positions in cell order
} HashGrid;
STOKES_ASSERT_SIZE(HashGrid, 48);

#endif
