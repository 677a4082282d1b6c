// Where a photon power table lies in the buffers, and how its axes map to indices.
#ifndef STOKES_SHARED_POWER_TABLE_H
#define STOKES_SHARED_POWER_TABLE_H

// A table is a row for each incidence (model `paper`: the refraction angle) of entries over distance, both evenly
// spaced, in layout [row][r]. Several tables may follow each other in one buffer. The same shape indexes the
// resampled values (an entry is a float16) and the distance densities (an entry is a float).
// Written by the host once per scene.
typedef struct TableShape {
    unsigned int offset;     // index of the table's first entry in its buffers
    unsigned int row_count;  // at least 1; a table that does not depend on incidence has 1
    float row_first;         // incidence of row 0 [deg]
    float row_step;          // [deg], positive
    unsigned int r_count;    // at least 2
    float r_first;           // distance of entry 0 [mm]
    float r_step;            // [mm], positive
    unsigned int pad;
} TableShape;
STOKES_ASSERT_SIZE(TableShape, 32);

#endif
