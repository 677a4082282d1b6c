// Constants that host and kernels share. No types, no functions.
#ifndef STOKES_SHARED_LIMITS_H
#define STOKES_SHARED_LIMITS_H

// Wavelengths shared by a whole pass.
#define STOKES_WAVELENGTHS 16

// Marks "no triangle", "no shape", "no light".
#define STOKES_NONE 0xffffffffu

// Size check that both languages understand.
#define STOKES_ASSERT_SIZE(type, bytes) typedef char stokes_size_of_##type[(sizeof(type) == (bytes)) ? 1 : -1]

#endif
