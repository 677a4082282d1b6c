// The half-space's Green's function: what the walk that tabulates it and the kernel that resamples it are told.
#ifndef STOKES_SHARED_GREEN_H
#define STOKES_SHARED_GREEN_H

#include "limits.h"

#define STOKES_GREEN_ALBEDOS 32

// One launch of walk_green. Lengths are in mean free paths. Written by the host once per launch.
typedef struct GreenWalk {
    float source_depth;     // of the isotropic point source, >= 0
    float eta;              // refractive index relative to the outside, >= 1
    float critical_cosine;  // sqrt(1 - 1/eta^2): less is reflected totally
    float deep;             // beyond this depth the rest of a walk is replaced by diffusion
    float deep_offset;      // the extrapolated surface of diffusion lies this far outside, [mfp],
    float deep_spread;      // plus an exponentially distributed distance of this mean [mfp]
    float rho_first;        // lateral distance at the centre of bin 1, > 0
    float bins_per_octave;  // bin i has its centre at rho_first 2^((i - 1) / bins_per_octave)
    unsigned int bins;      // bin 0 lies below bin 1; what is beyond the last bin is not scored
    unsigned int seed;
    unsigned int stream;      // keeps the random numbers of different sources apart
    unsigned int first_walk;  // index of the launch's first walk
    unsigned int walks_per_item;
    unsigned int items;
    unsigned int pad0, pad1;
} GreenWalk;
STOKES_ASSERT_SIZE(GreenWalk, 64);

// The universal table and where it goes. Axes in mean free paths: node 0 at 0, node i >= 1 at
// first 2^((i - 1) step). Written by the host once per medium.
typedef struct GreenShape {
    float rho_first, rho_step;
    float z_first, z_step;
    unsigned int rho_count, z_count;  // at least 3
    unsigned int pad0, pad1;
} GreenShape;
STOKES_ASSERT_SIZE(GreenShape, 32);

#endif
