// What stands behind a triangle: shape -> material.
#ifndef STOKES_SHARED_MATERIAL_H
#define STOKES_SHARED_MATERIAL_H

// MaterialRecord.kind
#define STOKES_BLACK 0u
#define STOKES_DIFFUSE 1u
#define STOKES_TRANSLUCENT 2u

// Written by the host once per scene.
typedef struct ShapeRecord {
    unsigned int material;  // index into the MaterialRecord buffer
    unsigned int light;     // index of the light whose surface this is, or STOKES_NONE
    unsigned int body;      // shapes of one body share subsurface light
    unsigned int pad;
} ShapeRecord;
STOKES_ASSERT_SIZE(ShapeRecord, 16);

// Written by the host once per scene. Spectra of a material live in per-pass buffers of 16 wavelengths.
typedef struct MaterialRecord {
    unsigned int kind;           // STOKES_BLACK, STOKES_DIFFUSE or STOKES_TRANSLUCENT
    unsigned int fluorophore;    // index of its re-radiation matrix, or STOKES_NONE
    unsigned int tables;         // index of its medium's power tables (MediumTables), or STOKES_NONE: no subsurface
    float fluorescent_fraction;  // c in [0, 1]: probability of meeting a fluorophore
    float eta;                   // refractive index, for the refraction angle
    unsigned int pad0, pad1, pad2;
} MaterialRecord;
STOKES_ASSERT_SIZE(MaterialRecord, 32);

#endif
