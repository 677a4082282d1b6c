// What stands behind a triangle: shape -> material.
#ifndef STOKES_SHARED_MATERIAL_H
#define STOKES_SHARED_MATERIAL_H

#include "limits.h"

// MaterialRecord.kind
#define STOKES_BLACK 0u
#define STOKES_DIFFUSE 1u
#define STOKES_TRANSLUCENT 2u

// MaterialRecord.flags, of translucent materials.
#define STOKES_MATERIAL_SUBSURFACE 1u   // light goes below the surface; else it leaves where it came in
#define STOKES_MATERIAL_FRESNEL 2u      // the surface reflects, outside and within; only with SUBSURFACE
#define STOKES_MATERIAL_FLUORESCENT 4u  // there are fluorophores
#define STOKES_MATERIAL_BRANCHES 8u     // with SUBSURFACE: light may go both ways, by a fluorophore and past it

// MaterialRecord.transport: the models of PHYSICS sections 3, 4 and 5.
#define STOKES_TRANSPORT_PAPER 0u
#define STOKES_TRANSPORT_CONSERVING 1u
#define STOKES_TRANSPORT_WALK 2u
#define STOKES_TRANSPORT_COUNT 3u

// Written by the host once per scene.
typedef struct ShapeRecord {
    unsigned int material;  // index into the MaterialRecord buffer
    unsigned int light;     // index of the light whose surface this is, or STOKES_NONE
} ShapeRecord;
STOKES_ASSERT_SIZE(ShapeRecord, 8);

// BodyRecord.flags
#define STOKES_BODY_FLAT 1u     // model `walk`: a flat sheet, the surface of a half-space; else a closed mesh
#define STOKES_BODY_TOUCHES 2u  // another body comes as near as rays start off a surface
#define STOKES_BODY_SOLID 4u    // its surface is closed
#define STOKES_BODY_HOLLOW 8u   // model `walk`: other surfaces may lie within it

// Shapes that exchange light below their surfaces, and each other shape by itself. Written by the host once per scene.
typedef struct BodyRecord {
    unsigned int flags;                       // STOKES_BODY_*
    unsigned int material;                    // index into the MaterialRecord buffer: of one of its shapes
    unsigned int inside;                      // the body of model `walk` within which it lies, or STOKES_NONE
    unsigned int first_region, region_count;  // TOUCHES: of its ContactRegions
    unsigned int pad[3];
} BodyRecord;
STOKES_ASSERT_SIZE(BodyRecord, 32);

// A box that holds the part of a body's surface near to which another body comes. Written by the host once per scene.
typedef struct ContactRegion {
    float low_x, low_y, low_z;     // [mm]
    float high_x, high_y, high_z;  // [mm]
} ContactRegion;
STOKES_ASSERT_SIZE(ContactRegion, 24);

// Written by the host once per scene. A "row" is an index into the pass's spectra: one float16, the value at each
// of the pass's wavelengths. Row i is the reflectance of material i. There is a record for each material of the scene,
// and for each further transport that some of its bodies have (material_uses() of the host).
typedef struct MaterialRecord {
    unsigned int kind;             // STOKES_BLACK, STOKES_DIFFUSE or STOKES_TRANSLUCENT; any other is black
    unsigned int flags;            // STOKES_MATERIAL_*
    unsigned int transport;        // STOKES_TRANSPORT_*: who scatters its light; `walk` only with SUBSURFACE
    unsigned int medium;           // SUBSURFACE: owner of its three power tables
    float fluorescent_fraction;    // c in [0, 1]: probability of meeting a fluorophore; `conserving`: where E is 1
    float eta;                     // refractive index
    unsigned int excitation_row;   // FLUORESCENT: of its fluorophores together
    unsigned int reradiation_row;  // FLUORESCENT: first of 16, one an excitation wavelength: flux there -> emitted flux
    unsigned int sigma_row;        // SUBSURFACE: of its medium: sigma_t [1/mm], and in the next row the albedo
    float exit_scale;              // FRESNEL: 1/(1 - diffuse reflectance from outside)
} MaterialRecord;
STOKES_ASSERT_SIZE(MaterialRecord, 40);

#endif
