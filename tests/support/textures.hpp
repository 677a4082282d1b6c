// Textures on the device, put together by hand.
#pragma once

#include <vector>

#include "host/render/device_textures.hpp"
#include "tests/support/device_fixture.hpp"

namespace stokes {

// Of materials that have none.
inline DeviceTextures no_textures(std::size_t materials) {
    return {
        Buffer<TextureRecord>(test_device(), "textures", std::vector<TextureRecord>(materials, {0, 0, 0, STOKES_NONE})),
        Buffer<float>(test_device(), "texels", std::vector<float>(1, 0.0f)),
        Buffer<TriangleUv>(test_device(), "texture coordinates", std::vector<TriangleUv>(1))};
}

}  // namespace stokes
