// The camera's record, which kernels read.
#ifndef STOKES_SHARED_CAMERA_H
#define STOKES_SHARED_CAMERA_H

#include "limits.h"

// A pinhole. The ray through film point (x, y), in pixels from the top left corner of the picture, has the
// direction corner + x * right + y * down, not normalised. Written by make_camera_record once per scene.
typedef struct CameraRecord {
    float position_x, position_y, position_z;  // [mm]
    unsigned int width;                        // [pixels]
    float corner_x, corner_y, corner_z;        // towards the top left corner, at distance 1 along the axis
    unsigned int height;                       // [pixels]
    float right_x, right_y, right_z;           // one pixel to the right
    unsigned int pad0;
    float down_x, down_y, down_z;  // one pixel down
    unsigned int pad1;
} CameraRecord;
STOKES_ASSERT_SIZE(CameraRecord, 64);

#endif
