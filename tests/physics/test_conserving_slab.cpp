#include <array>
#include <cmath>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/half_space.hpp"
#include "tests/support/photon_passes.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

// Flux that leaves, by map and wavelength [W/nm].
using MapFlux = std::array<std::array<double, STOKES_WAVELENGTHS>, 3>;

// Exact transport theory for light that arrives at cosine mu within a half-space (PHYSICS section 4, A1 to A3).
MapFlux exact_flux(const Scene& scene, const WavelengthSet& set, double eta_of_surface, double mu, double entering) {
    const Medium& medium = scene.media[0];
    const Fluorophore& dot = scene.fluorophores[0];
    const double c = fluorescent_fraction(as_translucent(scene.materials[0])->dyes),
                 sum = dot.emission.sum_1nm(300, 830);
    const auto sigma_t = [&](int lambda) { return medium.sigma_s.at(lambda) + medium.sigma_a.at(lambda); };
    MapFlux result{};
    for (std::size_t em = 0; em < set.size(); ++em) {
        const double albedo = medium.sigma_s.at(set[em]) / sigma_t(set[em]);
        const Escaping share = escaping_share(eta_of_surface, mu, albedo);
        const double elastic =
            entering * scene.lights[0].flux.at(set[em]) * (1.0 - c * dot.excitation.at(set[em])) * albedo;
        result[STOKES_MAP_SINGLE][em] = elastic * share.direct;
        result[STOKES_MAP_MULTIPLE][em] = elastic * (share.total - share.direct);
        if (!(dot.emission.at(set[em]) > 0.0)) continue;
        for (std::size_t ex = 0; ex < em; ++ex) {
            const double taken_up = entering * scene.lights[0].flux.at(set[ex]) * c * dot.excitation.at(set[ex]);
            if (!(taken_up > 0.0)) continue;
            const double escaping =
                escaping_share(eta_of_surface, mu, albedo, sigma_t(set[em]) / sigma_t(set[ex])).total;
            result[STOKES_MAP_FLUORESCENCE][em] += taken_up * dot.quantum_yield * dot.emission.at(set[em]) / sum *
                                                   set[ex] / set[em] * pair_weight_nm(300, 780) * escaping;
        }
    }
    return result;
}

struct Case {
    double fraction, angle_deg;
    bool fresnel;
    double albedo_scale;  // factor on absorption
    Branches branches;
    int exits;
};

}  // namespace

// A beam on a wide flat slab, sixteen wavelengths at once with extinction coefficients of their own: the flux in the
// maps is that of exact transport theory at every wavelength. Batches of photons give the standard error; in all about
// 260 comparisons at 4 standard errors, wrong once in 60 choices of the seed.
TEST_CASE("the maps of a flat slab hold the flux that exact transport says", "[conserving]") {
    constexpr Branches roulette = Branches::roulette, both = Branches::both;
    for (const Case& c : {Case{0.4, 0.0, false, 1.0, roulette, 1}, Case{0.7, 60.0, false, 60.0, roulette, 1},
                          Case{0.4, 45.0, true, 30.0, roulette, 1}, Case{0.4, 0.0, false, 1.0, both, 1},
                          Case{0.7, 60.0, false, 60.0, both, 3}, Case{0.4, 45.0, true, 30.0, both, 1}}) {
        Scene scene = slab_scene(c.fraction, c.angle_deg, Transport::conserving);
        translucent_of(scene).fresnel = c.fresnel;
        scene.render.branches = c.branches;
        scene.render.exits = c.exits;
        scene.fluorophores[0].quantum_yield = 0.8;
        scene.media[0].sigma_a = scene.media[0].sigma_a.scaled(c.albedo_scale);
        const std::uint32_t batches = 20, photons = 32768;
        PhotonPasses passes(scene, photons);
        const PassWavelengths wavelengths = pass_wavelengths(scene.render, 3);
        std::array<std::array<Sample, STOKES_WAVELENGTHS>, 3> stored;
        double reflected = 0.0, missed = 0.0;
        for (std::uint32_t batch = 0; batch < batches; ++batch) {
            const PhotonAccount account = passes.trace(wavelengths, batch);
            reflected += static_cast<double>(account.reflections);
            missed += account.energy[4] / account.energy[0];
            CHECK(account.refused_slots == 0);
            for (std::size_t m = 0; m < 3; ++m) {
                std::array<double, STOKES_WAVELENGTHS> sum{};
                for (const Flux16& flux : passes.flux(m))
                    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += static_cast<double>(flux.v[k]);
                for (std::size_t k = 0; k < sum.size(); ++k) stored[m][k].add(sum[k]);
            }
        }
        CHECK(missed / batches < 1e-4);
        const double mu_out = std::cos(c.angle_deg * M_PI / 180.0), mu = cosine_within(1.5, mu_out);
        const double specular = c.fresnel ? internal_reflectance(mu, 1.5) : 0.0;
        const double n = double(batches) * photons;
        CHECK(std::abs(reflected - specular * n) <= 4.0 * std::sqrt(specular * n));
        const MapFlux expected = exact_flux(scene, wavelengths.set, c.fresnel ? 1.5 : 1.0, mu, 1.0 - specular);
        for (std::size_t m = 0; m < 3; ++m)
            for (std::size_t k = 0; k < STOKES_WAVELENGTHS; ++k) {
                const Sample& sample = stored[m][k];
                CAPTURE(c.angle_deg, c.fresnel, c.exits, static_cast<int>(c.branches), m);
                CAPTURE(wavelengths.set[k], sample.mean(), expected[m][k]);
                CAPTURE(sample.mean() / expected[m][k], sample.standard_error() / expected[m][k]);
                CHECK(sample.standard_error() <= 0.03 * expected[m][k]);
                CHECK(std::abs(sample.mean() - expected[m][k]) <=
                      4.0 * sample.standard_error() + 3e-4 * expected[m][k]);
            }
    }
}
