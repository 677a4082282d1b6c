#include "host/render/device_textures.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "host/core/error.hpp"
#include "host/render/pass_spectra.hpp"
#include "host/render/transport/transport_model.hpp"

namespace stokes {

namespace {

// In the order of scene_triangles().
std::vector<TriangleUv> triangle_uvs(const Scene& scene) {
    std::vector<TriangleUv> result;
    for (const Shape& shape : scene.shapes)
        for (std::size_t i = 0; i < shape.mesh.triangles.size(); ++i) {
            const std::array<glm::vec2, 3> uv = shape.mesh.uv.empty() ? std::array<glm::vec2, 3>{} : shape.mesh.uv[i];
            result.push_back(
                {uv[0].x, uv[0].y, uv[1].x, uv[1].y, uv[2].x, uv[2].y, shape.texture_repeats ? 1u : 0u, 0});
        }
    return result;
}

}  // namespace

DeviceTextures upload_textures(const Device& device, const Scene& scene) {
    const SpectraLayout layout(scene);
    std::vector<TextureRecord> records;
    std::vector<float> texels;
    std::map<const Picture*, std::uint32_t> first_texel;
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const Picture* picture = texture_of(scene.materials[m]);
        if (picture == nullptr) {
            records.push_back({0, 0, 0, STOKES_NONE});
            continue;
        }
        if (first_texel.count(picture) == 0) {
            if (texels.size() + picture->luminance.size() > std::numeric_limits<std::uint32_t>::max())
                throw InputError(scene.file + ": materials: more texels than 32-bit indices can count");
            first_texel[picture] = static_cast<std::uint32_t>(texels.size());
            texels.insert(texels.end(), picture->luminance.begin(), picture->luminance.end());
        }
        records.push_back({static_cast<std::uint32_t>(picture->width), static_cast<std::uint32_t>(picture->height),
                           first_texel[picture], layout.white_row[m]});
    }
    records.resize(std::max<std::size_t>(material_uses(scene).size(), 1), {0, 0, 0, STOKES_NONE});
    std::vector<TriangleUv> uv(1);
    if (!texels.empty())
        uv = triangle_uvs(scene);
    else
        texels.push_back(0.0f);
    return {Buffer<TextureRecord>(device, "textures", records), Buffer<float>(device, "texels", texels),
            Buffer<TriangleUv>(device, "texture coordinates", uv)};
}

}  // namespace stokes
