// The textures of a scene on the device.
#pragma once

#include <vector>

#include "host/device/device.hpp"
#include "host/scene/scene.hpp"
#include "kernels/shared/texture.h"

namespace stokes {

struct DeviceTextures {
    Buffer<TextureRecord> records;  // [materials]
    Buffer<float> texels;           // of all pictures: linear luminance
    Buffer<TriangleUv> uv;          // [triangles], or one where no material has a texture
};

// Pictures that materials share are uploaded once. InputError where they have 2^32 texels or more together.
DeviceTextures upload_textures(const Device& device, const Scene& scene);

}  // namespace stokes
