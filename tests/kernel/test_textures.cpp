#include <algorithm>
#include <cmath>
#include <random>

#include "kernels/shared/ray.h"
#include "tests/support/catch.hpp"
#include "tests/support/textures.hpp"

using namespace stokes;

namespace {

// Three materials: none, a picture of 5 x 3 texels, one of 1 x 1.
struct Pictures {
    std::vector<TextureRecord> records = {{0, 0, 0, STOKES_NONE}, {5, 3, 1, 4}, {1, 1, 0, 3}};
    std::vector<float> texels = {0.25f};
    std::vector<TriangleUv> uv;

    Pictures() {
        std::mt19937 random(3);
        std::uniform_real_distribution<float> uniform;
        for (int i = 0; i < 15; ++i) texels.push_back(uniform(random));
        uv.push_back({0, 0, 0, 1, 1, 1, 0, 0});                      // half of a rectangle
        uv.push_back({-0.5f, 2.0f, 1.7f, -0.3f, 0.4f, 0.9f, 0, 0});  // beyond the picture in places
        uv.push_back({-0.5f, 2.0f, 1.7f, -0.3f, 0.4f, 0.9f, 1, 0});  // and where it repeats
    }

    std::vector<float> luminances(const std::vector<std::uint32_t>& materials, const std::vector<Hit>& hits) const {
        const Device& device = test_device();
        const Buffer<float> found(device, "found", hits.size());
        test_program("texture.cl")
            .kernel("luminances")
            .launch(hits.size(), Arguments()
                                     .add("materials", Buffer<std::uint32_t>(device, "materials", materials))
                                     .add("hits", Buffer<Hit>(device, "hits", hits))
                                     .add("records", Buffer<TextureRecord>(device, "records", records))
                                     .add("texels", Buffer<float>(device, "texels", texels))
                                     .add("uv", Buffer<TriangleUv>(device, "uv", uv))
                                     .add("found", found)
                                     .add("n", static_cast<std::uint32_t>(hits.size())));
        return found.download();
    }
};

// The picture as a function of place: bilinear between the middles of texels, in double precision.
double picture_twin(const TextureRecord& picture, const std::vector<float>& texels, double u, double v, bool repeats) {
    const auto texel = [&](double x, double y) {
        return double(
            texels[picture.first_texel + static_cast<std::size_t>(y) * picture.width + static_cast<std::size_t>(x)]);
    };
    if (repeats) {  // the sum over all copies of all texels, each a tent over its neighbours' middles
        double sum = 0.0;
        for (int y = -3 * static_cast<int>(picture.height); y < 4 * static_cast<int>(picture.height); ++y)
            for (int x = -3 * static_cast<int>(picture.width); x < 4 * static_cast<int>(picture.width); ++x) {
                const double along = std::max(0.0, 1.0 - std::abs(u * picture.width - 0.5 - x)),
                             down = std::max(0.0, 1.0 - std::abs(v * picture.height - 0.5 - y));
                if (along * down > 0.0)
                    sum += along * down *
                           texel((x + 3 * static_cast<int>(picture.width)) % static_cast<int>(picture.width),
                                 (y + 3 * static_cast<int>(picture.height)) % static_cast<int>(picture.height));
            }
        return sum;
    }
    const double x = std::clamp(u * picture.width - 0.5, 0.0, picture.width - 1.0);
    const double y = std::clamp(v * picture.height - 0.5, 0.0, picture.height - 1.0);
    const double x1 = std::min(std::floor(x) + 1, picture.width - 1.0),
                 y1 = std::min(std::floor(y) + 1, picture.height - 1.0);
    const double fx = x - std::floor(x), fy = y - std::floor(y);
    return (1 - fy) * ((1 - fx) * texel(x, y) + fx * texel(x1, y)) +
           fy * ((1 - fx) * texel(x, y1) + fx * texel(x1, y1));
}

}  // namespace

TEST_CASE("textures are bilinear between the middles of texels, and end at their edges or repeat", "[textures][tiny]") {
    const Pictures pictures;
    std::mt19937 random(4);
    std::uniform_real_distribution<float> uniform;
    std::vector<std::uint32_t> materials;
    std::vector<Hit> hits;
    for (std::uint32_t i = 0; i < 900; ++i) {
        float u = uniform(random), v = uniform(random);
        if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
        materials.push_back(i % 3);
        hits.push_back({1.0f, u, v, i / 3 % 3});
    }
    const std::vector<float> found = pictures.luminances(materials, hits);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const TriangleUv& t = pictures.uv[hits[i].triangle];
        const double u = double(hits[i].u), v = double(hits[i].v);
        const double at_u = (1 - u - v) * double(t.u0) + u * double(t.u1) + v * double(t.u2);
        const double at_v = (1 - u - v) * double(t.v0) + u * double(t.v1) + v * double(t.v2);
        const double expected = materials[i] == 0 ? 0.0
                                                  : picture_twin(pictures.records[materials[i]], pictures.texels, at_u,
                                                                 at_v, t.repeats != 0);
        CHECK(std::abs(double(found[i]) - expected) < 1e-5);
    }
}

// The first triangle's corners are (0, 0), (0, 1) and (1, 1): its place (u, v) lies at (v, u + v) of the
// picture.
TEST_CASE("the middle of each texel has its own luminance, the top row first", "[textures][tiny]") {
    const Pictures pictures;
    std::vector<Hit> hits;
    std::vector<float> expected;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 5; ++column) {
            const float x = (static_cast<float>(column) + 0.5f) / 5, y = (static_cast<float>(row) + 0.5f) / 3;
            if (x > y) continue;  // on the other half
            hits.push_back({1.0f, y - x, x, 0});
            expected.push_back(pictures.texels[static_cast<std::size_t>(1 + 5 * row + column)]);
        }
    REQUIRE(hits.size() == 8);
    const std::vector<float> found = pictures.luminances(std::vector<std::uint32_t>(hits.size(), 1), hits);
    for (std::size_t i = 0; i < found.size(); ++i) CHECK(found[i] == Approx(expected[i]).epsilon(1e-5));
}

TEST_CASE("a texture blends its two reflectances by its luminance", "[textures][tiny]") {
    const Pictures pictures;
    std::vector<Flux16> spectra(5), expected;
    for (std::size_t row = 0; row < spectra.size(); ++row)
        for (std::size_t k = 0; k < 16; ++k) spectra[row].v[k] = 0.01f * static_cast<float>(row * 16 + k);
    std::vector<std::uint32_t> materials;
    std::vector<float> luminances;
    for (std::uint32_t m = 0; m < 3; ++m)
        for (const float luminance : {0.0f, 0.25f, 1.0f}) {
            materials.push_back(m);
            luminances.push_back(m == 0 ? 0.0f : luminance);
            const std::size_t white = m == 0 ? 0 : pictures.records[m].white_row;
            Flux16 blend{};
            for (std::size_t k = 0; k < 16; ++k)
                blend.v[k] = (1.0f - luminances.back()) * spectra[m].v[k] + luminances.back() * spectra[white].v[k];
            expected.push_back(blend);
        }
    const Device& device = test_device();
    const Buffer<Flux16> found(device, "found", materials.size());
    test_program("texture.cl")
        .kernel("reflectances")
        .launch(materials.size(), Arguments()
                                      .add("materials", Buffer<std::uint32_t>(device, "materials", materials))
                                      .add("luminances", Buffer<float>(device, "luminances", luminances))
                                      .add("records", Buffer<TextureRecord>(device, "records", pictures.records))
                                      .add("spectra", Buffer<Flux16>(device, "spectra", spectra))
                                      .add("found", found)
                                      .add("n", static_cast<std::uint32_t>(materials.size())));
    const std::vector<Flux16> blends = found.download();
    for (std::size_t i = 0; i < blends.size(); ++i)
        for (std::size_t k = 0; k < 16; ++k) CHECK(blends[i].v[k] == Approx(expected[i].v[k]).margin(1e-6));
}
