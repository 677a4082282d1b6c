// What the tests of the photon kernels share: buffers from vectors, pass constants, random flux, ledgers.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <random>
#include <string>
#include <vector>

#include "kernels/shared/material.h"
#include "kernels/shared/pass.h"
#include "kernels/shared/path.h"
#include "kernels/shared/photon.h"
#include "kernels/shared/ray.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/triangle_meshes.hpp"

namespace stokes {

template <class T>
Buffer<T> on_device(const std::vector<T>& data) {
    return Buffer<T>(test_device(), "test data", data);
}

// Of the pass [nm].
inline float test_wavelength(std::size_t i) { return 310.0f + 30.0f * static_cast<float>(i); }

inline Buffer<PassConstants> pass_on_device(std::uint32_t seed, std::uint32_t photons = 0, float offset_mm = 0.0f) {
    PassConstants constants{};
    constants.seed = seed;
    constants.pass = 2;
    constants.photons = photons;
    constants.offset_mm = offset_mm;
    for (std::size_t i = 0; i < 16; ++i) {
        constants.lambda_nm[i] = test_wavelength(i);
        const float k = static_cast<float>(i) + 1.0f;
        constants.chain[i] = k < 16.0f ? (481.0f - k) / (16.0f - k) * 15.0f / 480.0f : 0.0f;
    }
    return on_device(std::vector<PassConstants>{constants});
}

inline Flux16 constant_flux(float value) {
    Flux16 flux;
    for (float& v : flux.v) v = value;
    return flux;
}

// Sixteen values, uniform between low and high.
inline Flux16 random_flux(std::mt19937& generator, double low, double high) {
    std::uniform_real_distribution<double> uniform(low, high);
    Flux16 flux;
    for (float& v : flux.v) v = static_cast<float>(uniform(generator));
    return flux;
}

inline double sum_of(const Flux16& flux) {
    double sum = 0.0;
    for (const float v : flux.v) sum += static_cast<double>(v);
    return sum;
}

// Sums of flux and of flux times wavelength, as the ledgers keep them.
inline LightSum light_of(const Flux16& flux) {
    double photons = 0.0;
    for (std::size_t i = 0; i < 16; ++i)
        photons += static_cast<double>(flux.v[i]) * static_cast<double>(test_wavelength(i));
    return {static_cast<float>(sum_of(flux)), static_cast<float>(photons)};
}

inline bool same_bits(const Flux16& a, const Flux16& b) { return std::memcmp(a.v, b.v, sizeof(a.v)) == 0; }

inline glm::dvec3 origin_of(const Ray& ray) { return {ray.ox, ray.oy, ray.oz}; }
inline glm::dvec3 direction_of(const Ray& ray) { return {ray.dx, ray.dy, ray.dz}; }

// Of paths in the open that have met nothing yet.
inline Buffer<Departure> open_departures(std::size_t paths) {
    return on_device(std::vector<Departure>(paths, Departure{0.0f, 0.0f, 0.0f, STOKES_NONE, STOKES_NONE, 0, {0, 0}}));
}

// The account of a path that has just started with this flux.
inline PathLedger open_ledger(const Flux16& flux) {
    PathLedger ledger{};
    ledger.emitted = light_of(flux);
    ledger.reference_flux = ledger.emitted.energy / 16.0f;
    ledger.rays = 1;
    return ledger;
}

inline std::vector<PathLedger> open_ledgers(const std::vector<Flux16>& flux) {
    std::vector<PathLedger> ledgers;
    for (const Flux16& f : flux) ledgers.push_back(open_ledger(f));
    return ledgers;
}

// What a ledger leaves unaccounted for, in energy or in photons, whichever is worse, as a share of what was emitted;
// carried: the path's flux while it is alive.
inline double imbalance_of(const PathLedger& ledger, const Flux16& carried) {
    const LightSum left = ledger.fate == STOKES_FATE_ALIVE ? light_of(carried) : LightSum{0.0f, 0.0f};
    const auto rest = [&](float LightSum::*part) {
        const auto d = [&](const LightSum& sum) { return static_cast<double>(sum.*part); };
        const double difference = d(ledger.emitted) + d(ledger.created) - d(ledger.absorbed) - d(ledger.stokes_loss) -
                                  d(ledger.escaped) - d(ledger.dropped) - d(ledger.roulette) - d(left);
        return d(ledger.emitted) > 0.0 ? difference / d(ledger.emitted) : difference;
    };
    const double energy = rest(&LightSum::energy), photons = rest(&LightSum::photons);
    return std::abs(energy) > std::abs(photons) ? energy : photons;
}

inline double worst_imbalance(const std::vector<PathLedger>& ledgers, const std::vector<Flux16>& carried) {
    double worst = 0.0;
    for (std::size_t i = 0; i < ledgers.size(); ++i)
        worst = std::max(worst, std::abs(imbalance_of(ledgers[i], carried[i])));
    return worst;
}

// Of a translucent material, model `paper`; flags: STOKES_MATERIAL_*.
inline MaterialRecord translucent_record(std::uint32_t flags, float fluorescent_fraction, float eta = 1.0f) {
    MaterialRecord record{};
    record.kind = STOKES_TRANSLUCENT;
    record.flags = flags;
    record.fluorescent_fraction = fluorescent_fraction;
    record.eta = eta;
    return record;
}

// Two unit vectors at right angles to n and to each other, by another construction than the kernels'.
inline void frame_of(const glm::dvec3& n, glm::dvec3& s, glm::dvec3& t) {
    const glm::dvec3 a = glm::abs(n);
    const glm::dvec3 away = a.x < a.y && a.x < a.z ? glm::dvec3(1, 0, 0)
                            : a.y < a.z            ? glm::dvec3(0, 1, 0)
                                                   : glm::dvec3(0, 0, 1);
    s = glm::normalize(glm::cross(n, away));
    t = glm::cross(n, s);
}

// The azimuth of d about n in [0, 1).
inline double azimuth_about(const glm::dvec3& n, const glm::dvec3& d) {
    glm::dvec3 s, t;
    frame_of(n, s, t);
    const double turn = std::atan2(glm::dot(d, t), glm::dot(d, s)) / (2.0 * M_PI);
    return turn < 0.0 ? turn + 1.0 : turn;
}

// Counts of cosine-distributed directions about n, in cells of equal probability: mu^2 and azimuth, both
// uniform.
class CosineHistogram {
  public:
    explicit CosineHistogram(int steps) : steps_(steps), counts_(std::size_t(steps) * std::size_t(steps), 0.0) {}
    void add(const glm::dvec3& n, const glm::dvec3& d) {
        const double mu = glm::dot(n, d);
        const int row = std::min(int(mu * mu * steps_), steps_ - 1);
        const int column = std::min(int(azimuth_about(n, d) * steps_), steps_ - 1);
        counts_[std::size_t(row * steps_ + column)] += 1.0;
    }
    const std::vector<double>& counts() const { return counts_; }

  private:
    int steps_;
    std::vector<double> counts_;
};

}  // namespace stokes
