// A beam on a body of a translucent material: what leaves it by model `walk`, and what exact transport theory says.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/half_space.hpp"
#include "tests/support/photon_passes.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/test_scenes.hpp"

namespace stokes {

inline constexpr std::size_t wavelengths = STOKES_WAVELENGTHS;
using Sixteen = std::array<double, wavelengths>;

// The pass's wavelengths; weights as in a pass of a render, so that re-radiation has its full size.
inline PassWavelengths test_wavelengths() {
    PassWavelengths result = pass_wavelengths(RenderSettings{}, 0);
    for (std::size_t k = 0; k < wavelengths; ++k) result.set[k] = 400 + 20 * static_cast<int>(k);
    return result;
}

inline Spectrum spectrum_of(const Sixteen& values) {
    Spectrum result;
    for (std::size_t k = 0; k < wavelengths; ++k) result.lambda_nm.push_back(test_wavelengths().set[k]);
    result.value.assign(values.begin(), values.end());
    return result;
}

// Sixteen values from low to high in equal ratios, out of order.
inline Sixteen spread(double low, double high) {
    Sixteen result;
    for (std::size_t k = 0; k < wavelengths; ++k)
        result[k] = low * std::pow(high / low, static_cast<double>(k * 7 % 16) / 15.0);
    return result;
}

inline Sixteen all(double value) {
    Sixteen result;
    result.fill(value);
    return result;
}

struct Material16 {
    Sixteen sigma_t = all(1.0);  // [1/mm]
    Sixteen albedo = all(1.0);
    double eta = 1.0;
    bool fresnel = false;
    double fraction = 0.0;  // of the fluorophore
    Sixteen excitation = all(0.0), emission = all(0.0);
    bool first_collision_only = true;
};

// A thin beam of flux 1 W/nm falls on the origin at this cosine to +y, on a body of the material.
inline Scene beam_scene(const Material16& m, const Mesh& mesh, double mu) {
    Scene scene;
    scene.file = "walk";
    scene.render.transport = Transport::walk;
    scene.render.first_collision_only = m.first_collision_only;
    Medium medium;
    medium.name = "medium";
    Sixteen sigma_s, sigma_a;
    for (std::size_t k = 0; k < wavelengths; ++k) {
        sigma_s[k] = m.sigma_t[k] * m.albedo[k];
        sigma_a[k] = m.sigma_t[k] - sigma_s[k];
    }
    medium.sigma_s = spectrum_of(sigma_s);
    medium.sigma_a = spectrum_of(sigma_a);
    medium.eta = m.eta;
    scene.media = {medium};
    Fluorophore fluorophore;
    fluorophore.name = "fluorophore";
    fluorophore.excitation = spectrum_of(m.excitation);
    fluorophore.emission = spectrum_of(m.emission);
    scene.fluorophores = {fluorophore};
    TranslucentMaterial material{0, {}, m.fresnel};
    if (m.fraction > 0.0) material.dyes = {{0, m.fraction}};
    scene.materials = {{"material", material}};
    add_shape(scene, "body", 0, mesh);
    DiskBeam beam;
    beam.direction = {std::sqrt(1.0 - mu * mu), -mu, 0.0};
    beam.position_mm = -50.0 * beam.direction;
    beam.half_u_mm = {0.0, 0.0, 0.01};
    beam.half_v_mm = glm::cross(beam.direction, beam.half_u_mm);
    scene.lights = {{"beam", Spectrum::constant(1.0), beam}};
    return scene;
}

// One triangle, facing up, so large that hardly any light leaves beyond it.
inline Mesh wide_sheet() {
    const float size = 1e6f;
    Mesh mesh;
    mesh.positions_mm = {{-size, 0.0f, -size}, {0.0f, 0.0f, 2.0f * size}, {size, 0.0f, -size}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

// What leaves for each photon that arrives; each wavelength arrives with flux 1.
struct Measured {
    std::array<std::array<Sample, wavelengths>, 3> map;
    std::array<Sample, wavelengths> total;  // with the specular reflection
    double absorbed = 0.0, dropped = 0.0;   // shares of the emitted energy
    double missed = 0.0;                    // deposits a photon
    double imbalance = 0.0;                 // worst
};

inline Measured measure(const Scene& scene, std::uint32_t batches, std::uint32_t photons) {
    PhotonPasses passes(scene, photons);
    Measured result;
    for (std::uint32_t batch = 0; batch < batches; ++batch) {
        const PhotonAccount account = passes.trace(test_wavelengths(), batch);
        const std::array<std::vector<Flux16>, 3> flux = {passes.flux(0), passes.flux(1), passes.flux(2)};
        for (std::size_t i = 0; i < photons; ++i)
            for (std::size_t k = 0; k < wavelengths; ++k) {
                double sum = i < flux[0].size() ? 0.0 : 1.0;  // reflected by the surface
                for (std::size_t m = 0; m < 3; ++m) {
                    const double f = i < flux[m].size() ? static_cast<double>(flux[m][i].v[k]) * photons : 0.0;
                    result.map[m][k].add(f);
                    sum += f;
                }
                result.total[k].add(sum);
            }
        CHECK(flux[0].size() + account.reflections == photons);
        const auto share = [&](std::size_t k) { return account.energy[k] / account.energy[0] / batches; };
        result.absorbed += share(1);
        result.dropped += share(4);
        result.missed += static_cast<double>(account.missed_exits) / (double(photons) * batches);
        for (const auto& sums : {account.energy, account.photons})
            result.imbalance =
                std::max(result.imbalance,
                         std::abs(sums[0] + sums[6] - sums[1] - sums[2] - sums[3] - sums[4] - sums[5]) / sums[0]);
    }
    return result;
}

// Three standard errors. Comparisons at different wavelengths of one run are hardly independent: the walks are the
// same.
inline void check_mean(const Sample& sample, double expected, double largest_error) {
    CAPTURE(sample.mean(), expected, sample.standard_error(), sample.z(expected));
    CHECK(std::abs(sample.mean() - expected) <= 3.0 * sample.standard_error() + 1e-5);
    CHECK(sample.standard_error() < largest_error);
}

// Shares of the light that arrives which leave, the specular reflection in the total.
struct Reflected {
    double specular, single, total;
};

inline Reflected exact(const Material16& m, std::size_t k, double mu) {
    const double within = cosine_within(m.eta, mu), eta = m.fresnel ? m.eta : 1.0;
    const double specular = m.fresnel ? internal_reflectance(within, m.eta) : 0.0;
    const Escaping share = escaping_share(eta, within, m.albedo[k]);
    const double scattered = (1.0 - specular) * m.albedo[k];
    return {specular, scattered * share.direct, specular + scattered * share.total};
}

inline const Sixteen many_albedos = {0.0,  0.1, 0.2,  0.3, 0.4,  0.5,  0.6,  0.7,
                                     0.75, 0.8, 0.85, 0.9, 0.93, 0.95, 0.97, 0.99};

}  // namespace stokes
