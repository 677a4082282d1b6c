// What is the same for every photon and every camera ray of a pass.
#ifndef STOKES_SHARED_PASS_H
#define STOKES_SHARED_PASS_H

#include "limits.h"

// Sets drawn in strata have 2^level bands of 16 / 2^level wavelengths each, for levels below this.
#define STOKES_STRATA_LEVELS 5

// Written by the host once per pass.
typedef struct PassConstants {
    float lambda_nm[16];  // the pass's wavelengths, increasing
    // Radiance [W mm^-2 sr^-1 nm^-1] -> tristimulus values of the film [cd/m^2]: 683.002 lm/W * 1e6 mm^2/m^2 *
    // colour matching function at lambda * N/n (PHYSICS of the image estimator: N/n times the sum over the set).
    float to_x[16], to_y[16], to_z[16];
    // Factor on the re-radiation rows for light that has been re-radiated k times before, PHYSICS section 2: the rows
    // hold the pair weight, which is that of the first time; chain[0] = 1.
    float chain[16];
    unsigned int seed;                  // of the whole render
    unsigned int pass;                  // index of the pass, from 0
    unsigned int photons;               // photons emitted in this pass
    float offset_mm;                    // rays start this far above the surface they leave
    unsigned int first_collision_only;  // `walk`: 1: fluorophores take light up at its first collision only
    // 1: the wavelengths are drawn by importance, in strata; chain is void, the rows hold each pair's own weight, and
    // lib/reradiation.clh needs the rest of this.
    unsigned int stratified;
    unsigned int low_discrepancy_pixels;       // 1: rays cover a pixel, and trials its disk, evenly over passes; 0:
                                               // independently (plain)
    unsigned int strata[16];                   // each wavelength's stratum, 0 to 15, never decreasing
    float level_shares[STOKES_STRATA_LEVELS];  // how often sets are drawn in 1, 2, 4, 8, 16 bands of equal counts
    unsigned int low_discrepancy_exits;  // 1: exits of a photon's first event lie at its EventSample; 0: at random
    float pad1[3];
} PassConstants;
STOKES_ASSERT_SIZE(PassConstants, 448);

#endif
