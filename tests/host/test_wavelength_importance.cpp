#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "host/core/csv_spectrum.hpp"
#include "host/image/colour.hpp"
#include "host/render/pass_spectra.hpp"
#include "host/render/wavelength_importance.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

constexpr int first_nm = 300, last_nm = 780;
constexpr std::size_t all = last_nm - first_nm + 1;

using Values = std::vector<double>;  // by wavelength

Spectrum shipped(const std::string& file, const std::string& column) {
    return csv_spectrum(read_csv(source_path("tables/" + file)), column, Outside::zero);
}

std::vector<std::pair<std::string, Spectrum>> shipped_lamps() {
    return {{"blacklight", shipped("lamps/blacklight_blue_model.csv", "power")},
            {"blb", shipped("lamps/blacklight_visible_galidakis.csv", "blb")},
            {"bl", shipped("lamps/blacklight_visible_galidakis.csv", "bl")},
            {"led", shipped("lamps/uvled_365_model.csv", "power")},
            {"D65", cie_spectrum("illuminants_1nm.csv", "D65")}};
}

std::vector<Fluorophore> shipped_fluorophores() {
    std::vector<Fluorophore> result;
    const auto add = [&](const std::string& name, const std::string& file, const std::string& prefix) {
        Fluorophore fluorophore;
        fluorophore.name = name;
        fluorophore.excitation = shipped(file, prefix + "excitation");
        fluorophore.emission = shipped(file, prefix + "emission");
        result.push_back(fluorophore);
    };
    for (const char* dot : {"qdot545", "qdot585", "qdot655"})
        add(dot, std::string("fluorophores/") + dot + "_model.csv", "");
    for (const std::string mineral : {"calcite_mn", "willemite_mn", "fluorite_eu", "sodalite_s2", "scheelite"})
        add(mineral, "fluorophores/minerals_model.csv", mineral + "_");
    return result;
}

Scene lit(const Spectrum& lamp, const std::vector<Fluorophore>& fluorophores) {
    Scene scene;
    scene.lights = {{"lamp", lamp, SurfaceLight{}}};
    scene.fluorophores = fluorophores;
    for (std::size_t i = 0; i < fluorophores.size(); ++i) {
        const Dye dye{static_cast<int>(i), 0.5};
        scene.materials.push_back({fluorophores[i].name, TranslucentMaterial{std::nullopt, {dye}, false}});
    }
    return scene;
}

Values tabulated(const Spectrum& spectrum) {
    Values result(all);
    for (std::size_t i = 0; i < all; ++i) result[i] = spectrum.at(first_nm + static_cast<double>(i));
    return result;
}

std::size_t index_of(const PassWavelengths& w, std::size_t k) { return static_cast<std::size_t>(w.set[k] - first_nm); }

const std::vector<Values>& eye() {
    static const std::vector<Values> matching = {tabulated(cie1931().x), tabulated(cie1931().y),
                                                 tabulated(cie1931().z)};
    return matching;
}

double sum_of(const Values& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

Values product(const Values& a, const Values& b) {
    Values result(all);
    std::transform(a.begin(), a.end(), b.begin(), result.begin(), std::multiplies<>());
    return result;
}

// Sum over all f before g of f g.
double full_pairs(const Values& f, const Values& g) {
    double below = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < all; ++i) {
        sum += below * g[i];
        below += f[i];
    }
    return sum;
}

// What the kernels do, in double precision: light starts with its rarity, the film has the image weight.
double elastic_estimate(const PassWavelengths& w, const Values& g) {
    double sum = 0.0;
    for (std::size_t k = 0; k < w.set.size(); ++k) sum += w.rarity[k] * g[index_of(w, k)];
    return sum * image_weight_nm(first_nm, last_nm);
}

using PairWeights = std::array<std::array<double, 16>, 16>;
PairWeights pair_weights(const PassWavelengths& w) {
    PairWeights result{};
    for (std::size_t ex = 0; ex < 16; ++ex)
        for (std::size_t em = ex + 1; em < 16; ++em)
            if (w.set[em] > w.set[ex])
                result[ex][em] = w.rarity[ex] * w.weight_nm(ex, em) * image_weight_nm(first_nm, last_nm);
    return result;
}

double pair_estimate(const PassWavelengths& w, const PairWeights& weights, const Values& f, const Values& g) {
    double sum = 0.0;
    for (std::size_t ex = 0; ex < 16; ++ex) {
        if (f[index_of(w, ex)] == 0.0) continue;
        double row = 0.0;
        for (std::size_t em = ex + 1; em < 16; ++em) row += weights[ex][em] * g[index_of(w, em)];
        sum += f[index_of(w, ex)] * row;
    }
    return sum;
}

}  // namespace

TEST_CASE("importance is where the light is, and some everywhere", "[wavelength_importance]") {
    for (const auto& [name, lamp] : shipped_lamps()) {
        const Scene scene = lit(lamp, shipped_fluorophores());
        const std::vector<double> expected = wavelength_importance(scene);
        CAPTURE(name);
        REQUIRE(expected.size() == all);
        CHECK(sum_of(expected) == Approx(16.0).epsilon(1e-12));
        CHECK(*std::max_element(expected.begin(), expected.end()) <= 1.0 + 1e-12);
        CHECK(*std::min_element(expected.begin(), expected.end()) >= 0.1 * 16.0 / 481.0 * (1.0 - 1e-12));
    }
    const Scene led = lit(shipped("lamps/uvled_365_model.csv", "power"), {shipped_fluorophores()[2]});
    const std::vector<double> expected = wavelength_importance(led);
    const auto between = [&](int low, int high) {
        return std::accumulate(expected.begin() + low - first_nm, expected.begin() + high - first_nm, 0.0);
    };
    CHECK(between(355, 376) > 3.0);
    CHECK(between(625, 685) > 3.0);
    CHECK(between(480, 560) < 0.6 * 16.0 * 80.0 / 481.0);
}

// It may lie across two strata, which are drawn independently.
TEST_CASE("a line of light is drawn about once a set", "[wavelength_importance]") {
    const Scene laser = lit({{364.5, 365.0, 365.5}, {0.0, 1.0, 0.0}, Outside::zero}, {shipped_fluorophores()[0]});
    const auto strata = stratified_wavelengths(laser);
    REQUIRE(strata);
    CHECK(strata->expected(365) == Approx(1.0).epsilon(1e-12));
    Sample count;
    for (std::uint32_t pass = 0; pass < 2000; ++pass) {
        const PassWavelengths w = strata->draw(pass, pass);
        count.add(static_cast<double>(std::count(w.set.begin(), w.set.end(), 365)));
    }
    CHECK(std::abs(count.z(1.0)) < 3.5);
    CHECK(count.variance() < 0.6);
}

TEST_CASE("wavelengths are drawn uniformly where that is asked for", "[wavelength_importance]") {
    Scene scene = lit(Spectrum::constant(1.0), {});
    CHECK(stratified_wavelengths(scene));
    scene.render.transport = Transport::paper;
    CHECK_FALSE(stratified_wavelengths(scene));
    scene.render.wavelengths = Wavelengths::importance;
    CHECK(stratified_wavelengths(scene));
    scene.render.wavelengths.reset();
    scene.render.transport = Transport::walk;
    CHECK(stratified_wavelengths(scene));
    scene.render.sampling = Sampling::plain;
    CHECK_FALSE(stratified_wavelengths(scene));
    scene.render.wavelengths = Wavelengths::importance;
    CHECK(stratified_wavelengths(scene));
    scene.render.lambda_min_nm = 500;
    scene.render.lambda_max_nm = 515;  // all sixteen are in every set
    CHECK_FALSE(stratified_wavelengths(scene));
    scene.render.lambda_max_nm = 516;
    CHECK(stratified_wavelengths(scene));
}

TEST_CASE("the spectra of a pass have the weights of its wavelengths", "[wavelength_importance]") {
    const Scene scene = lit(shipped_lamps()[0].second, shipped_fluorophores());
    const PassWavelengths w = stratified_wavelengths(scene)->draw(1, 2);
    const PassSpectra pass = make_pass_spectra(scene, {1.0}, {M_PI * 25.0}, w, 2, 1000);
    const SpectraLayout layout(scene);
    CHECK(pass.constants.stratified == 1);
    for (std::size_t l = 0; l < level_shares.size(); ++l)
        CHECK(static_cast<double>(pass.constants.level_shares[l]) == level_shares[l]);
    const auto even = reradiation_rows(scene.fluorophores[0], scene.render.transport, w.set, 1.0);
    for (std::size_t k = 0; k < 16; ++k) {
        const double flux = scene.lights[0].flux.at(w.set[k]) * w.rarity[k];
        CHECK(pass.constants.strata[k] == w.strata[k]);
        CHECK(static_cast<double>(pass.photon_flux[0].v[k]) * 1000.0 == Approx(flux).epsilon(1e-6));
        CHECK(static_cast<double>(pass.radiance[0].v[k]) * M_PI * 25.0 == Approx(flux).epsilon(1e-6));
        CHECK(static_cast<double>(pass.constants.to_y[k]) ==
              Approx(683.002e6 * 481.0 / 16.0 * cie1931().y.at(w.set[k])).epsilon(1e-6));
        for (std::size_t em = 0; em < 16; ++em)
            CHECK(static_cast<double>(pass.rows[layout.excitation_row[0] + 1 + k].v[em]) ==
                  Approx(static_cast<double>(even[k].v[em]) * w.weight_nm(k, em)).epsilon(1e-6));
    }
}

// Lamp -> eye, and lamp -> fluorophore -> eye, in X, Y and Z: sets are drawn, each with a seed of its own, until
// the standard error is below 0.1 % of the full sum. Those of one scene share their sets: other seeds may have a
// few of the two hundred sums beyond 3 standard errors.
TEST_CASE("the mean over many sets is the full bispectral sum", "[wavelength_importance]") {
    std::size_t sums = 0;
    for (const auto& [lamp_name, spectrum] : shipped_lamps()) {
        const Values lamp = tabulated(spectrum);
        for (const Fluorophore& fluorophore : shipped_fluorophores()) {
            const auto strata = stratified_wavelengths(lit(spectrum, {fluorophore}));
            REQUIRE(strata);
            const Values taken_up = product(lamp, tabulated(fluorophore.excitation));
            std::vector<Values> elastic, seen;
            Values full;
            for (const Values& matching : eye()) {
                elastic.push_back(product(lamp, matching));
                seen.push_back(product(tabulated(fluorophore.emission), matching));
            }
            for (const Values& g : elastic) full.push_back(sum_of(g));
            for (const Values& g : seen) full.push_back(full_pairs(taken_up, g));
            std::vector<Sample> samples(6);
            const auto open = [&] {
                for (std::size_t i = 0; i < samples.size(); ++i)
                    if (full[i] > 0.0 && !(samples[i].standard_error() < 1e-3 * full[i])) return true;
                return false;
            };
            for (std::uint32_t pass = 0; pass < 1000000 && (pass % 5000 != 0 || pass < 5000 || open()); ++pass) {
                const PassWavelengths w = strata->draw(pass, 21 * pass);
                const PairWeights weights = pair_weights(w);
                for (std::size_t i = 0; i < 3; ++i) {
                    samples[i].add(elastic_estimate(w, elastic[i]));
                    samples[i + 3].add(pair_estimate(w, weights, taken_up, seen[i]));
                }
            }
            for (std::size_t i = 0; i < samples.size(); ++i) {
                if (full[i] == 0.0) continue;
                CAPTURE(lamp_name, fluorophore.name, i, samples[i].count(), samples[i].mean() / full[i] - 1.0);
                CHECK(samples[i].standard_error() < 1e-3 * full[i]);
                CHECK(std::abs(samples[i].z(full[i])) < 3.0);
                ++sums;
            }
        }
    }
    CHECK(sums > 150);
}

// Mean over 256 passes of a render against that over 256 independent sets, each sum's variance; the shipped lamps
// and dots, 80 seeds.
TEST_CASE("over passes the noise of wavelengths falls faster than that of independent sets",
          "[wavelength_importance]") {
    constexpr std::uint32_t seeds = 80, passes = 256;
    const std::vector<Fluorophore> minerals_too = shipped_fluorophores();
    const std::vector<Fluorophore> dots(minerals_too.begin(), minerals_too.begin() + 3);
    for (const auto& [name, spectrum] : shipped_lamps()) {
        const auto strata = stratified_wavelengths(lit(spectrum, dots));
        const Values lamp = tabulated(spectrum);
        std::vector<std::pair<Values, Values>> seen;
        std::vector<double> full;
        for (const Fluorophore& dot : dots)
            for (const Values& matching : eye()) {
                seen.emplace_back(product(lamp, tabulated(dot.excitation)), product(tabulated(dot.emission), matching));
                full.push_back(full_pairs(seen.back().first, seen.back().second));
            }
        std::vector<Values> elastic;
        for (const Values& matching : eye()) {
            elastic.push_back(product(lamp, matching));
            full.push_back(sum_of(elastic.back()));
        }
        std::vector<Sample> alone(full.size()), together(full.size());
        for (std::uint32_t seed = 0; seed < seeds; ++seed) {
            Values mean(full.size(), 0.0);
            for (std::uint32_t pass = 0; pass < passes; ++pass) {
                const auto add = [&](const PassWavelengths& w, const auto& take) {
                    const PairWeights weights = pair_weights(w);
                    for (std::size_t i = 0; i < seen.size(); ++i)
                        take(i, pair_estimate(w, weights, seen[i].first, seen[i].second));
                    for (std::size_t i = 0; i < elastic.size(); ++i)
                        take(seen.size() + i, elastic_estimate(w, elastic[i]));
                };
                add(strata->draw(seed, pass), [&](std::size_t i, double value) { mean[i] += value / passes; });
                add(strata->draw(1000 + seed * passes + pass, pass),
                    [&](std::size_t i, double value) { alone[i].add(value); });
            }
            for (std::size_t i = 0; i < mean.size(); ++i) together[i].add(mean[i]);
        }
        double log_gain = 0.0, least = 1e9;
        for (std::size_t i = 0; i < full.size(); ++i) {
            if (full[i] == 0.0) continue;
            const double gain = alone[i].variance() / passes / together[i].variance();
            CAPTURE(name, i, gain);
            CHECK(std::abs(together[i].z(full[i])) < 4.0);
            log_gain += std::log(gain) / static_cast<double>(full.size());
            least = std::min(least, gain);
        }
        CAPTURE(name, std::exp(log_gain), least);
        CHECK(std::exp(log_gain) > 5.0);
        CHECK(least > 2.5);
    }
}

// Lamp -> fluorophore -> the same fluorophore -> eye: three wavelengths at once. With the weights of pairs
// alone the mean would be more than 1 % off.
TEST_CASE("the mean over many sets is the full sum of light re-radiated twice", "[wavelength_importance]") {
    using Triples = std::array<std::array<std::array<double, 16>, 16>, 16>;
    static Triples triples;
    for (std::uint32_t i = 0; i < 16; ++i)
        for (std::uint32_t j = i; j < 16; ++j)
            for (std::uint32_t k = j; k < 16; ++k) triples[i][j][k] = joint_ratio({i, j, k});
    const Fluorophore dot = shipped_fluorophores()[0];
    const Spectrum light = cie_spectrum("illuminants_1nm.csv", "D65");
    const auto strata = stratified_wavelengths(lit(light, {dot}));
    const Values f = product(tabulated(light), tabulated(dot.excitation));
    const Values g = product(tabulated(dot.emission), tabulated(dot.excitation));
    const Values h = product(tabulated(dot.emission), eye()[1]);
    double full = 0.0, below = 0.0, pairs = 0.0;
    for (std::size_t i = 0; i < all; ++i) {
        full += pairs * h[i];
        pairs += below * g[i];
        below += f[i];
    }
    Sample exact, by_pairs;
    for (std::uint32_t pass = 0; pass < 250000; ++pass) {
        const PassWavelengths w = strata->draw(pass, 8 * pass);
        double sum = 0.0, pair_sum = 0.0;
        for (std::size_t k = 2; k < 16; ++k)
            for (std::size_t j = 1; j < k; ++j)
                for (std::size_t i = 0; i < j; ++i) {
                    if (!(w.set[i] < w.set[j] && w.set[j] < w.set[k])) continue;
                    const double value = w.rarity[i] * f[index_of(w, i)] * w.rarity[j] * g[index_of(w, j)] *
                                         w.rarity[k] * h[index_of(w, k)];
                    const std::uint32_t a = w.strata[i], b = w.strata[j], c = w.strata[k];
                    sum += value / triples[a][b][c];
                    pair_sum += value / (pair_ratio(a, b) * pair_ratio(b, c));
                }
        const double weight = image_weight_nm(first_nm, last_nm);
        exact.add(sum * weight * weight * weight);
        by_pairs.add(pair_sum * weight * weight * weight);
    }
    CAPTURE(full, exact.mean(), exact.standard_error(), by_pairs.mean(), by_pairs.standard_error());
    CHECK(exact.standard_error() < 3e-3 * full);
    CHECK(std::abs(exact.z(full)) < 3.0);
    CHECK(by_pairs.z(full) < -3.0);
}
