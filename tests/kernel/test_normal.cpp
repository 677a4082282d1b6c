#include <cmath>
#include <random>

#include "kernels/shared/photon.h"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/normals.hpp"

using namespace stokes;

namespace {

struct alignas(16) Float4 {
    float x, y, z, w;
};

// Axes, edges and corners of the octahedron, directions close to them, and random ones; a multiple of 16.
std::vector<glm::dvec3> directions(std::size_t count) {
    std::vector<glm::dvec3> result;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x != 0 || y != 0 || z != 0) {
                    result.push_back(glm::normalize(glm::dvec3(x, y, z)));
                    result.push_back(glm::normalize(glm::dvec3(x + 1e-4, y - 1e-4, z + 1e-5)));
                }
    std::mt19937 generator(1);
    while (result.size() < count) result.push_back(random_direction(generator));
    return result;
}

// Normals of bodies 0, 1, 2 ..
std::vector<std::uint32_t> pack(const std::vector<glm::dvec3>& normals) {
    std::vector<Float4> data;
    std::vector<std::uint32_t> bodies;
    for (const glm::dvec3& n : normals) {
        bodies.push_back(static_cast<std::uint32_t>(data.size()));
        data.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z), 0.0f});
    }
    const Buffer<Float4> input(test_device(), "normals", data);
    const Buffer<std::uint32_t> body_buffer(test_device(), "bodies", bodies);
    const Buffer<std::uint32_t> packed(test_device(), "packed", data.size());
    test_program("normal.cl")
        .kernel("pack_normals")
        .launch(data.size(), Arguments()
                                 .add("normals", input, "float4")
                                 .add("bodies", body_buffer)
                                 .add("packed", packed)
                                 .add("n", std::uint32_t(data.size())));
    return packed.download();
}

std::vector<Float4> components(const std::vector<std::uint32_t>& packed, std::uint32_t body) {
    const Buffer<std::uint32_t> input(test_device(), "packed", packed);
    const Buffer<Float4> normals(test_device(), "normals", packed.size());
    test_program("normal.cl")
        .kernel("packed_components")
        .launch(packed.size() / 16, Arguments()
                                        .add("packed", input)
                                        .add("body", body)
                                        .add("normals", normals, "float4")
                                        .add("n", std::uint32_t(packed.size())));
    return normals.download();
}

}  // namespace

// Half a step of 1/127 is 0.00394.
TEST_CASE("a packed normal is right to half a step of a byte", "[normal][tiny]") {
    const std::vector<glm::dvec3> normals = directions(4096);
    const std::vector<std::uint32_t> packed = pack(normals);
    const std::vector<Float4> back = components(packed, 0);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        REQUIRE(packed[i] != STOKES_EMPTY_SLOT);
        REQUIRE(std::abs(static_cast<double>(back[i].x) - normals[i].x) < 0.00395);
        REQUIRE(std::abs(static_cast<double>(back[i].y) - normals[i].y) < 0.00395);
        REQUIRE(std::abs(static_cast<double>(back[i].z) - normals[i].z) < 0.00395);
        REQUIRE(same_normal(packed[i], normals[i]));
    }
}

TEST_CASE("axes are packed exactly", "[normal][tiny]") {
    std::vector<glm::dvec3> axes = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    axes.resize(16, {1, 0, 0});
    const std::vector<Float4> back = components(pack(axes), 0);
    for (std::size_t i = 0; i < axes.size(); ++i) {
        CHECK(back[i].x == Approx(axes[i].x).margin(1e-7));
        CHECK(back[i].y == Approx(axes[i].y).margin(1e-7));
        CHECK(back[i].z == Approx(axes[i].z).margin(1e-7));
    }
}

TEST_CASE("a packed normal is of its own body, modulo 256", "[normal][tiny]") {
    const std::vector<std::uint32_t> packed = pack(directions(4096));
    for (const std::uint32_t body : {0u, 1u, 127u, 128u, 255u, 256u, 700u}) {
        const std::vector<Float4> found = components(packed, body);
        for (std::size_t i = 0; i < packed.size(); ++i) REQUIRE(found[i].w == (i % 256 == body % 256 ? -1.0f : 0.0f));
    }
}
