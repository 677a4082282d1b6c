// Light that enters a medium is stored by one branch, drawn, or by both with their weights, at one exit or several, at
// distances drawn in one way or another: the same light in the mean, at every wavelength and distance, with less noise.
#include <array>
#include <cmath>
#include <vector>

#include "host/render/emission_trial.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/photon_passes.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

constexpr std::uint32_t batches = 24, photons = 8192;

using Sixteen = std::array<Sample, STOKES_WAVELENGTHS>;

// A sample a batch.
struct Stored {
    std::array<Sixteen, 3> flux;                  // in each map, by wavelength [W/nm]
    std::array<std::array<Sample, 3>, 3> within;  // in each map, within three distances of x = z = 0, all wavelengths
    std::array<Sample, 8> energy;                 // in the order of LedgerSums
    double imbalance = 0.0;                       // of energy or photons, over that of all batches
};

constexpr std::array<double, 3> distances_mm = {2.0, 4.0, 12.0};

void add_maps(const PhotonPasses& passes, Stored& stored) {
    for (std::size_t m = 0; m < 3; ++m) {
        const auto [heads, flux] = passes.deposits(m);
        std::array<double, STOKES_WAVELENGTHS> sums{};
        std::array<double, 3> within{};
        for (std::size_t i = 0; i < heads.size(); ++i) {
            if (heads[i].normal == STOKES_EMPTY_SLOT) continue;
            double all = 0.0;
            for (std::size_t k = 0; k < STOKES_WAVELENGTHS; ++k) {
                sums[k] += static_cast<double>(flux[i].v[k]);
                all += static_cast<double>(flux[i].v[k]);
            }
            const double r = std::hypot(static_cast<double>(heads[i].x), static_cast<double>(heads[i].z));
            for (std::size_t d = 0; d < within.size(); ++d)
                if (r < distances_mm[d]) within[d] += all;
        }
        for (std::size_t k = 0; k < STOKES_WAVELENGTHS; ++k) stored.flux[m][k].add(sums[k]);
        for (std::size_t d = 0; d < within.size(); ++d) stored.within[m][d].add(within[d]);
    }
}

Stored measured(Scene scene, Branches branches, int exits, std::uint32_t seed, bool even = false) {
    scene.render.branches = branches;
    scene.render.exits = exits;
    scene.render.seed = seed;
    PhotonPasses passes(scene, photons);
    if (even)
        passes.pass.inputs().set_emission(EmissionCells::stratified(emitting_lights(scene, passes.on_device), photons));
    PassWavelengths wavelengths = pass_wavelengths(RenderSettings{}, 0);
    for (std::size_t k = 0; k < STOKES_WAVELENGTHS; ++k) wavelengths.set[k] = 330 + 20 * static_cast<int>(k);
    Stored stored;
    std::array<double, 8> energy{}, photon_sums{};
    for (std::uint32_t batch = 0; batch < batches; ++batch) {
        const PhotonAccount account = passes.trace(wavelengths, batch);
        CHECK(account.refused_slots == 0);
        CHECK(account.fates[STOKES_FATE_OVERFLOW] + account.fates[STOKES_FATE_EVENT_LIMIT] == 0);
        add_maps(passes, stored);
        for (std::size_t k = 0; k < energy.size(); ++k) {
            energy[k] += account.energy[k];
            photon_sums[k] += account.photons[k];
            stored.energy[k].add(account.energy[k]);
        }
    }
    for (const std::array<double, 8>& s : {energy, photon_sums})
        stored.imbalance =
            std::max(stored.imbalance, std::abs(s[0] + s[6] - s[1] - s[2] - s[3] - s[4] - s[5]) / (s[0] + s[6]));
    return stored;
}

void check_same(const Sample& a, const Sample& b, double largest_error) {
    const double error = std::hypot(a.standard_error(), b.standard_error());
    CAPTURE(a.mean(), b.mean(), a.standard_error(), b.standard_error());
    CHECK(std::abs(a.mean() - b.mean()) <= 4.0 * error + 1e-6 * std::abs(a.mean()));
    CHECK(error <= largest_error * std::abs(a.mean()));
}

// largest_error: of a value [1], below which the comparison must be sure.
void check_same(const Stored& a, const Stored& b, double largest_error) {
    CHECK(a.imbalance < 1e-7);
    CHECK(b.imbalance < 1e-7);
    for (std::size_t m = 0; m < 3; ++m) {
        for (std::size_t k = 0; k < STOKES_WAVELENGTHS; ++k) {
            CAPTURE(m, k);
            if (m != STOKES_MAP_FLUORESCENCE || a.flux[m][k].mean() > 0.0)
                check_same(a.flux[m][k], b.flux[m][k], largest_error);
        }
        for (std::size_t d = 0; d < distances_mm.size(); ++d) {
            CAPTURE(m, distances_mm[d]);
            check_same(a.within[m][d], b.within[m][d], largest_error);
        }
    }
    for (const std::size_t k : {1u, 2u, 3u, 6u, 7u}) {  // absorbed, Stokes loss, escaped, created, stored
        CAPTURE(k);
        check_same(a.energy[k], b.energy[k], 0.5 * largest_error);
    }
}

// Of the light within the middle distance.
double variance_ratio(const Stored& a, const Stored& b, std::size_t map) {
    return a.within[map][1].variance() / b.within[map][1].variance();
}

// Extinction from 0.4 to 5 per mm.
Scene uneven(Scene scene) {
    Medium& medium = scene.media[0];
    medium.sigma_s = {{330.0, 430.0, 530.0, 630.0}, {4.0, 0.4, 2.0, 0.8}, Outside::hold};
    medium.sigma_a = {{330.0, 430.0, 530.0, 630.0}, {1.0, 0.02, 0.01, 0.1}, Outside::hold};
    scene.fluorophores[0].quantum_yield = 0.8;
    return scene;
}

}  // namespace

// About 60 comparisons of means a pair at 4 standard errors, of which few are independent: wrong by chance once in 50.
TEST_CASE("both branches and several exits store what the roulette does in the mean", "[branches]") {
    for (const bool fresnel : {false, true}) {
        Scene scene = uneven(slab_scene(0.4, 45.0, Transport::conserving));
        translucent_of(scene).fresnel = fresnel;
        CAPTURE(fresnel);
        const Stored roulette = measured(scene, Branches::roulette, 1, 1), both = measured(scene, Branches::both, 1, 2),
                     exits = measured(scene, Branches::both, 3, 3), alone = measured(scene, Branches::roulette, 3, 4);
        for (const Stored* other : {&both, &exits, &alone}) check_same(roulette, *other, 0.1);
        CHECK(variance_ratio(both, roulette, STOKES_MAP_FLUORESCENCE) < 0.3);
        CHECK(variance_ratio(exits, roulette, STOKES_MAP_FLUORESCENCE) < 0.3);
        CHECK(variance_ratio(exits, roulette, STOKES_MAP_MULTIPLE) < 0.6);
    }
}

// Light that returns to the medium, from a floor: what is stored and what goes on must go together at every event.
TEST_CASE("light that enters again and again is the same by both branches", "[branches]") {
    for (const Transport transport : {Transport::conserving, Transport::paper}) {
        Scene scene = small_scene(transport);
        if (transport == Transport::conserving) scene = uneven(scene);
        scene.materials[0] = diffuse_material(0.95);
        CAPTURE(static_cast<int>(transport));
        const Stored roulette = measured(scene, Branches::roulette, 1, 5), both = measured(scene, Branches::both, 2, 6);
        check_same(roulette, both, 0.3);
        if (transport == Transport::conserving) CHECK(variance_ratio(both, roulette, STOKES_MAP_FLUORESCENCE) < 0.6);
    }
}

// As above, each pair of about 60 comparisons wrong by chance once in 50.
TEST_CASE("the paper's light leaves as far from its entry however that is drawn", "[branches]") {
    for (const bool floor : {false, true}) {
        Scene scene = floor ? small_scene(Transport::paper) : uneven(slab_scene(0.4, 45.0, Transport::paper));
        if (floor) scene.materials[0] = diffuse_material(0.95);
        CAPTURE(floor);
        scene.render.distances = Distances::table;
        const Stored table = measured(scene, Branches::both, 1, 7);
        scene.render.distances = Distances::importance;
        const Stored importance = measured(scene, Branches::both, 1, 8),
                     roulette = measured(scene, Branches::roulette, 1, 9);
        check_same(table, importance, 0.3);
        check_same(table, roulette, 0.3);
        if (floor) continue;
        for (const std::size_t map : {STOKES_MAP_FLUORESCENCE, STOKES_MAP_SINGLE, STOKES_MAP_MULTIPLE}) {
            CAPTURE(map);
            CHECK(variance_ratio(importance, table, map) < 0.5);
        }
    }
}

// Photons of a narrow beam, so that where they start makes no noise within the distances: what is left is that of the
// exits.
TEST_CASE("exits that go with an even start store the same light with less noise", "[branches]") {
    for (const Transport transport : {Transport::conserving, Transport::paper}) {
        const Scene scene = uneven(slab_scene(0.4, 45.0, transport));
        CAPTURE(static_cast<int>(transport));
        const Stored random = measured(scene, Branches::both, 1, 10),
                     even = measured(scene, Branches::both, 1, 11, true);
        check_same(random, even, 0.1);
        CHECK(variance_ratio(even, random, STOKES_MAP_MULTIPLE) < 0.6);
        // By `conserving` its noise is that of the way to the first collision.
        if (transport == Transport::paper) CHECK(variance_ratio(even, random, STOKES_MAP_FLUORESCENCE) < 0.1);
    }
}
