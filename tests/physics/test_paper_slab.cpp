#include <array>
#include <cmath>

#include "host/subsurface/power_table.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/photon_passes.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

// E[T(r)] at each of the pass's wavelengths for r with density proportional to the table's mean over wavelengths, the
// table taken as linear between its grid points as the kernels do; Simpson's rule is exact for the products.
std::array<double, 16> mean_kept(const PowerTable& table, double theta_deg, const WavelengthSet& set) {
    const std::size_t count_r = table.axis("r")->values.size(), count_l = table.axis("lambda")->values.size();
    const bool angular = table.axis("theta") != nullptr;
    const std::size_t count_t = angular ? table.axis("theta")->values.size() : 1;
    const double row = angular ? theta_deg / 0.9 : 0.0;
    const auto t0 = static_cast<std::size_t>(row);
    const double ft = row - static_cast<double>(t0);
    const auto at = [&](std::size_t r, double l) {
        const double position = (l - 300.0) / 5.0;
        const auto l0 = std::min(static_cast<std::size_t>(position), count_l - 2);
        const double fl = position - static_cast<double>(l0);
        const auto value = [&](std::size_t t, std::size_t k) { return table.values[(r * count_t + t) * count_l + k]; };
        const auto row_value = [&](std::size_t t) { return value(t, l0) * (1.0 - fl) + value(t, l0 + 1) * fl; };
        return row_value(t0) * (1.0 - ft) + (angular ? row_value(t0 + 1) * ft : 0.0);
    };
    const auto density = [&](std::size_t r) {
        double sum = 0.0;
        for (std::size_t k = 0; k < count_l; ++k) sum += at(r, table.axis("lambda")->values[k]);
        return sum;
    };
    std::array<double, 16> result{};
    double total = 0.0;
    for (std::size_t r = 0; r + 1 < count_r; ++r) {
        const double p0 = density(r), p1 = density(r + 1);
        total += 0.5 * (p0 + p1);
        for (std::size_t i = 0; i < set.size(); ++i) {
            const double f0 = at(r, set[i]), f1 = at(r + 1, set[i]);
            result[i] += (p0 * f0 + 4.0 * 0.25 * (p0 + p1) * (f0 + f1) + p1 * f1) / 6.0;
        }
    }
    for (double& v : result) v /= total;
    return result;
}

}  // namespace

// A beam on a wide flat slab: each photon has one event and then escapes, so that the flux in the maps has a closed
// expectation: c * re-radiated flux * E[T_F], (1 - c) * flux * E[T_S] and the same with T_M (PHYSICS section 3).
TEST_CASE("the maps of a flat slab hold the flux that the paper's model says", "[subsurface]") {
    for (const double angle_deg : {0.0, 50.0}) {
        const Scene scene = slab_scene(0.4, angle_deg);
        PhotonPasses passes(scene);
        const std::uint32_t photons = passes.photons;
        const PhotonAccount account = passes.trace(3);
        const PhotonMaps& maps = passes.maps();
        CHECK(account.missed_exits == 0);
        CHECK(account.refused_slots == 0);
        CHECK(account.fates[STOKES_FATE_ESCAPED] + account.fates[STOKES_FATE_ABSORBED] == photons);
        CHECK(maps[STOKES_MAP_SURFACE].used() == 0);
        CHECK(maps[0].used() + maps[1].used() == photons);

        WavelengthSet set;
        for (std::size_t i = 0; i < 16; ++i) set[i] = static_cast<int>(passes.constants().lambda_nm[i]);
        const double theta_deg = std::asin(std::sin(angle_deg * M_PI / 180.0) / 1.5) * 180.0 / M_PI;
        const Medium& medium = scene.media[0];
        const MediumSpectra ms{medium.name, medium.sigma_s, medium.sigma_a, medium.eta, medium.dipole_eta};
        const std::array<PowerTable, 3> power = {make_fluorescence_table(ms), make_single_table(ms),
                                                 make_multiple_table(ms)};
        for (std::size_t component = 0; component < 3; ++component) {
            const std::array<double, 16> kept = mean_kept(power[component], theta_deg, set);
            const std::vector<Flux16> flux = passes.flux(component);
            for (std::size_t i = 0; i < 16; ++i) {
                double start = scene.lights[0].flux.at(set[i]);
                if (component == STOKES_MAP_FLUORESCENCE) {
                    start = 0.0;
                    for (std::size_t j = 0; j < i; ++j)
                        start += scene.lights[0].flux.at(set[j]) * 0.02 * scene.fluorophores[0].excitation.at(set[j]) *
                                 scene.fluorophores[0].emission.at(set[i]) * pair_weight_nm(300, 780);
                }
                const double expected = start * kept[i] * (component == STOKES_MAP_FLUORESCENCE ? 0.4 : 0.6);
                Sample stored;
                for (const Flux16& f : flux) stored.add(static_cast<double>(f.v[i]));
                const double sum = stored.mean() * static_cast<double>(flux.size());
                // Binomial number of events times the spread of their flux.
                const double n = photons, mean = sum / n;
                const double second = stored.variance() * (static_cast<double>(flux.size()) / n) +
                                      stored.mean() * stored.mean() * (static_cast<double>(flux.size()) / n);
                const double error = std::sqrt(std::max(second - mean * mean, 0.0) * n);
                CAPTURE(angle_deg, component, set[i], sum, expected, error);
                CHECK(std::abs(sum - expected) <= 4.5 * error + 1e-6 * expected);
                if (expected > 0.0) CHECK(error < 0.02 * expected);
            }
        }
    }
}
