// The film's layers, which host/image/film.hpp names. Those that a photon map lights come first, with the map's number.
#ifndef STOKES_SHARED_LAYERS_H
#define STOKES_SHARED_LAYERS_H

#define STOKES_LAYER_FLUORESCENCE 0
#define STOKES_LAYER_SINGLE 1
#define STOKES_LAYER_MULTIPLE 2
#define STOKES_LAYER_SURFACE 3
#define STOKES_LAYER_COUNT 4

#endif
