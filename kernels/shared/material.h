// What stands behind a triangle: shape -> material.
#ifndef STOKES_SHARED_MATERIAL_H
#define STOKES_SHARED_MATERIAL_H

#include "limits.h"

// MaterialRecord.kind
#define STOKES_BLACK 0u
#define STOKES_DIFFUSE 1u
#define STOKES_TRANSLUCENT 2u

// Written by the host once per scene.
typedef struct ShapeRecord {
    unsigned int material;  // index into the MaterialRecord buffer
    unsigned int light;     // index of the light whose surface this is, or STOKES_NONE
} ShapeRecord;
STOKES_ASSERT_SIZE(ShapeRecord, 8);

// How a body without thickness or volume of its own is to be taken: bodies [bodies], for model `walk`.
#define STOKES_BODY_CLOSED 0u  // a closed mesh
#define STOKES_BODY_FLAT 1u    // a flat sheet, the surface of a half-space

// Written by the host once per scene. A "row" is an index into the pass's spectra: one float16, the value at each
// of the pass's wavelengths. Row i is the reflectance of material i.
typedef struct MaterialRecord {
    unsigned int kind;             // STOKES_BLACK, STOKES_DIFFUSE or STOKES_TRANSLUCENT
    unsigned int medium;           // owner of its three power tables, or STOKES_NONE: no subsurface
    float fluorescent_fraction;    // c in [0, 1]: probability of meeting a fluorophore; `conserving`: where E is 1
    float eta;                     // refractive index
    unsigned int excitation_row;   // of its fluorophore, or STOKES_NONE without one
    unsigned int reradiation_row;  // first of 16 rows, one an excitation wavelength: flux there -> emitted flux
    unsigned int sigma_row;        // of its medium: sigma_t [1/mm], and in the next row the albedo; or STOKES_NONE
    float exit_scale;              // with Fresnel reflection 1/(1 - diffuse reflectance from outside), without it 0
} MaterialRecord;
STOKES_ASSERT_SIZE(MaterialRecord, 32);

#endif
