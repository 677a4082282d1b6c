// Double-precision twin of the normal packing of kernels/lib/normal.clh.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>

namespace stokes {

// n: unit length. A kernel may round to a neighbour.
inline std::uint32_t pack_normal_twin(glm::dvec3 n, std::uint32_t body = 0) {
    const auto quantised = [](double u) { return static_cast<std::uint32_t>(std::lround(u * 127.0)) & 255u; };
    return quantised(n.x) | (quantised(n.y) << 8) | (quantised(n.z) << 16) | (body << 24);
}

inline glm::dvec3 unpack_normal_twin(std::uint32_t packed) {
    const auto component = [&](int shift) { return static_cast<std::int8_t>((packed >> shift) & 255u) / 127.0; };
    return {component(0), component(8), component(16)};
}

// Half a step of 1/127 is 0.00394.
inline bool same_normal(std::uint32_t packed, glm::dvec3 n) {
    const glm::dvec3 off = glm::abs(unpack_normal_twin(packed) - n);
    return off.x < 0.00395 && off.y < 0.00395 && off.z < 0.00395;
}

// Uniform on the unit sphere.
template <class Generator>
glm::dvec3 random_direction(Generator& generator) {
    std::normal_distribution<double> normal;
    const double x = normal(generator), y = normal(generator), z = normal(generator);
    return glm::normalize(glm::dvec3(x, y, z));
}

}  // namespace stokes
