// The film's layers: what the light last went through before it reached the camera.
#ifndef STOKES_SHARED_LAYERS_H
#define STOKES_SHARED_LAYERS_H

// X(name, NAME) of each layer, in the film's order: its name in files and on the command line, and in code. Those that
// a photon map lights come first, in the order of the maps (photon.h).
#define STOKES_LAYERS(X)          \
    X(fluorescence, FLUORESCENCE) \
    X(single, SINGLE)             \
    X(multiple, MULTIPLE)         \
    X(surface, SURFACE)

#define STOKES_LAYER_CODE(name, NAME) STOKES_LAYER_##NAME,
enum { STOKES_LAYERS(STOKES_LAYER_CODE) STOKES_LAYER_COUNT };
#undef STOKES_LAYER_CODE

#endif
