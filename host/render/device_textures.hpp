// The textures of a scene on the device.
#pragma once

#include <vector>

#include "host/device/kernel.hpp"
#include "host/scene/scene.hpp"
#include "kernels/shared/texture.h"

namespace stokes {

struct DeviceTextures {
    Buffer<TextureRecord> records;  // [materials]
    Buffer<float> texels;           // of all pictures: linear luminance
    Buffer<TriangleUv> uv;          // [triangles], or one where no material has a texture

    // TEXTURE_ARGUMENTS.
    Arguments arguments() const {
        return Arguments("texture_records", records).add("texels", texels).add("texture_uv", uv);
    }
};

// Pictures that materials share are uploaded once. InputError where they have 2^32 texels or more together.
DeviceTextures upload_textures(const Device& device, const Scene& scene);

}  // namespace stokes
