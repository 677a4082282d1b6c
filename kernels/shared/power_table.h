// Where a photon power table lies in the buffers, and how its axes map to indices.
#ifndef STOKES_SHARED_POWER_TABLE_H
#define STOKES_SHARED_POWER_TABLE_H

// Bits of TableShape.log_axes: that axis has node 0 at 0 and node i >= 1 at first * 2^((i - 1) * step).
#define STOKES_LOG_ROWS 1u
#define STOKES_LOG_R 2u

// A table is a row for each incidence (model `paper`: the refraction angle [deg]; `conserving`: the depth of the first
// collision [mm]) of entries over distance, in layout [row][r]. An axis is evenly spaced, node i at first + i * step,
// or logarithmic. Several tables may follow each other in one buffer. The same shape indexes the resampled values (an
// entry is a float16) and the distance densities (an entry is a float).
// Written by the host once per scene.
typedef struct TableShape {
    unsigned int offset;     // index of the table's first entry in its buffers
    unsigned int row_count;  // at least 1; a table that does not depend on incidence has 1, evenly spaced
    float row_first;         // [unit of the rows]
    float row_step;          // positive: [unit of the rows], or octaves where the rows are logarithmic
    unsigned int r_count;    // at least 2
    float r_first;           // [mm]
    float r_step;            // positive: [mm], or octaves where r is logarithmic
    unsigned int log_axes;   // STOKES_LOG_*
} TableShape;
STOKES_ASSERT_SIZE(TableShape, 32);

#endif
