// Where photons start.
#ifndef STOKES_SHARED_LIGHT_H
#define STOKES_SHARED_LIGHT_H

#include "limits.h"

// LightRecord.kind
#define STOKES_LIGHT_SURFACE 0u
#define STOKES_LIGHT_BEAM_DISK 1u
#define STOKES_LIGHT_BEAM_RECTANGLE 2u

// Written by the host once per scene. A photon of light i carries row i of the pass's photon flux buffer.
typedef struct LightRecord {
    unsigned int kind;             // STOKES_LIGHT_*; any other is dark
    unsigned int first_triangle;   // surface: first of its triangles in the Triangle buffer
    unsigned int triangle_count;   // surface: how many
    float cumulative_probability;  // of choosing one of the lights 0..this, the last is 1
    float px, py, pz;              // beam: centre of the cross-section; surface: of a ball that holds it [mm]
    unsigned int first_area;       // surface: its first entry in the cumulative area buffer
    float dx, dy, dz;              // beam: direction, unit length
    float ball_mm;                 // surface: radius of that ball
    float ux, uy, uz;              // beam: half-axis of the cross-section [mm]
    unsigned int dimensions;       // coordinates of a place in its cube, 2 or 4: lib/lights.clh
    float vx, vy, vz;              // beam: the other half-axis [mm]
    unsigned int restricted;       // 1: photons start only where they can meet something, as the rest says; else 0
    float tx, ty, tz;     // beam: centre of a window, before what it meets; surface: of a ball around that [mm]
    float target_mm;      // surface: radius of the ball
    float wux, wuy, wuz;  // beam: half-axis of the window, which is a rectangle [mm]
    float part;           // beam: area of the window over that of the section
    float wvx, wvy, wvz;  // beam: the other half-axis of the window [mm]
    unsigned int inside;  // the body within which it lies, or STOKES_NONE
} LightRecord;
STOKES_ASSERT_SIZE(LightRecord, 128);

// A part of where and whereto a light emits, with a share of the pass's photons: a box in the cube [0, 1]^4 that
// lib/lights.clh maps onto the light, all of it evenly. Written by the host; they partition the cubes of all lights.
typedef struct EmissionCell {
    float low[4], size[4];
    float probability;    // of the box among all that the lights emit at random
    unsigned int light;   // index into the LightRecord buffer
    unsigned int stride;  // points of the cell's sequence for a pass: at least as many as photons start there
    unsigned int pad;
} EmissionCell;
STOKES_ASSERT_SIZE(EmissionCell, 48);

// A point of a surface that photons should meet. Written by the host, read by find_emission_places.
typedef struct EmissionTarget {
    float x, y, z;     // [mm]
    float nx, ny, nz;  // normal of its front, unit length
} EmissionTarget;
STOKES_ASSERT_SIZE(EmissionTarget, 24);

#endif
