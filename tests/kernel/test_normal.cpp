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

std::vector<std::uint32_t> pack(const std::vector<glm::dvec3>& normals) {
    std::vector<Float4> data;
    for (const glm::dvec3& n : normals)
        data.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z), 0.0f});
    const Buffer<Float4> input(test_device(), "normals", data);
    const Buffer<std::uint32_t> packed(test_device(), "packed", data.size());
    test_program("normal.cl")
        .kernel("pack_normals")
        .launch(data.size(), input, packed, std::uint32_t(data.size()));
    return packed.download();
}

std::vector<Float4> unpack(const char* kernel, const std::vector<std::uint32_t>& packed) {
    const Buffer<std::uint32_t> input(test_device(), "packed", packed);
    const Buffer<Float4> normals(test_device(), "normals", packed.size());
    test_program("normal.cl")
        .kernel(kernel)
        .launch(packed.size(), input, normals, std::uint32_t(packed.size()));
    return normals.download();
}

double angle(const glm::dvec3& a, const Float4& b) {
    return glm::length(glm::cross(a, glm::dvec3(b.x, b.y, b.z)));
}

}  // namespace

TEST_CASE("a packed normal comes back within 1e-4", "[normal][tiny]") {
    const std::vector<glm::dvec3> normals = directions(4096);
    const std::vector<std::uint32_t> packed = pack(normals);
    const std::vector<Float4> back = unpack("unpack_normals", packed);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        REQUIRE(packed[i] != STOKES_EMPTY_SLOT);
        REQUIRE(angle(normals[i], back[i]) < 1e-4);
        REQUIRE(glm::dot(normals[i], glm::dvec3(back[i].x, back[i].y, back[i].z)) > 0.0);
        REQUIRE(std::hypot(back[i].x, back[i].y, back[i].z) == Approx(1.0).epsilon(1e-6));
    }
}

TEST_CASE("axes are packed exactly", "[normal][tiny]") {
    const std::vector<glm::dvec3> axes = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                          {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    const std::vector<Float4> back = unpack("unpack_normals", pack(axes));
    for (std::size_t i = 0; i < axes.size(); ++i) {
        CHECK(back[i].x == static_cast<float>(axes[i].x));
        CHECK(back[i].y == static_cast<float>(axes[i].y));
        CHECK(back[i].z == static_cast<float>(axes[i].z));
    }
}

// Half a step of 1/127 is 0.00394.
TEST_CASE("coarse normals are right to half a step of a byte", "[normal][tiny]") {
    const std::vector<std::uint32_t> packed = pack(directions(4096));
    const std::vector<Float4> fine = unpack("unpack_normals", packed);
    const std::vector<Float4> coarse = unpack("coarse_components", packed);
    for (std::size_t i = 0; i < packed.size(); ++i) {
        REQUIRE(std::abs(coarse[i].x - fine[i].x) < 0.00395f);
        REQUIRE(std::abs(coarse[i].y - fine[i].y) < 0.00395f);
        REQUIRE(std::abs(coarse[i].z - fine[i].z) < 0.00395f);
    }
}
