// Reflectances that change over a surface, by the luminance of a picture.
#ifndef STOKES_SHARED_TEXTURE_H
#define STOKES_SHARED_TEXTURE_H

#include "limits.h"

// One a material. Reflectance = row of the material + luminance * (row white_row - row of the material), both of the
// pass's spectra. Written by the host once per scene.
typedef struct TextureRecord {
    unsigned int width, height;  // texels; 0: no texture, the reflectance is the material's row everywhere
    unsigned int first_texel;    // of the picture, row by row from the top, in the texels: linear luminance in [0, 1]
    unsigned int white_row;      // reflectance where the luminance is 1
} TextureRecord;
STOKES_ASSERT_SIZE(TextureRecord, 16);

// Where the corners v0, v1, v2 of a triangle lie in the picture: (0, 0) is its top left corner, (1, 1) its bottom
// right. Written by the host once per scene, one a triangle where any material has a texture.
typedef struct TriangleUv {
    float u0, v0, u1, v1, u2, v2;
    unsigned int repeats;  // 1: beyond 0 to 1 the picture repeats, and is filtered across its edges; 0: it ends there
    unsigned int padding;
} TriangleUv;
STOKES_ASSERT_SIZE(TriangleUv, 32);

#endif
