// Double-precision twin of the normal packing of kernels/lib/normal.clh.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>

namespace stokes {

// n: unit length. The nearest octahedral grid point; a kernel may round to its neighbour.
inline std::uint32_t pack_normal_twin(glm::dvec3 n) {
    n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    if (n.z < 0.0)
        n = {std::copysign(1.0 - std::abs(n.y), n.x), std::copysign(1.0 - std::abs(n.x), n.y), n.z};
    const auto quantised = [](double u) {
        return static_cast<std::uint32_t>(std::lround((u + 1.0) * 32767.0));
    };
    return quantised(n.x) | (quantised(n.y) << 16);
}

// Uniform on the unit sphere.
template <class Generator>
glm::dvec3 random_direction(Generator& generator) {
    std::normal_distribution<double> normal;
    const double x = normal(generator), y = normal(generator), z = normal(generator);
    return glm::normalize(glm::dvec3(x, y, z));
}

}  // namespace stokes
