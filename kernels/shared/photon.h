// Photons as the four maps keep them.
#ifndef STOKES_SHARED_PHOTON_H
#define STOKES_SHARED_PHOTON_H

#include "limits.h"

// The maps, in this order everywhere.
#define STOKES_MAP_FLUORESCENCE 0
#define STOKES_MAP_SINGLE 1
#define STOKES_MAP_MULTIPLE 2
#define STOKES_MAP_SURFACE 3
#define STOKES_MAP_COUNT 4

// PhotonHead.normal of a slot without a photon.
#define STOKES_EMPTY_SLOT 0xffffffffu

// A stored photon but for its flux, which stands in the slot of the same index of a float16 buffer [W/nm].
// Written by scatter_diffuse, deposit_exits and walk_photons, read by the hash build and score_photons.
typedef struct PhotonHead {
    float x, y, z;        // position on the surface [mm]
    unsigned int normal;  // the surface's outward normal and its body, by lib/normal.clh, or STOKES_EMPTY_SLOT
} PhotonHead;
STOKES_ASSERT_SIZE(PhotonHead, 16);

#endif
