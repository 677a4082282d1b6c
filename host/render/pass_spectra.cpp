#include "host/render/pass_spectra.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/core/error.hpp"
#include "host/core/overloaded.hpp"
#include "host/image/colour.hpp"
#include "host/render/stokes_shift.hpp"
#include "host/render/stratified_wavelengths.hpp"
#include "host/render/transport/transport_model.hpp"

namespace stokes {

namespace {

Flux16 sampled(const Spectrum& spectrum, const WavelengthSet& set) {
    Flux16 result;
    for (std::size_t i = 0; i < set.size(); ++i) result.v[i] = static_cast<float>(spectrum.at(set[i]));
    return result;
}

// Of light that starts at the set's wavelengths.
Flux16 starting(const Spectrum& spectrum, const PassWavelengths& wavelengths, double factor) {
    Flux16 result;
    for (std::size_t i = 0; i < wavelengths.set.size(); ++i)
        result.v[i] = static_cast<float>(factor * wavelengths.rarity[i] * spectrum.at(wavelengths.set[i]));
    return result;
}

// The rows of a material's fluorophores together, from first on: sums of each one's own, by their weights.
void add_dyes(const TranslucentMaterial& material, Transport transport, const Scene& scene,
              const PassWavelengths& wavelengths, Flux16* first) {
    const std::vector<double> weights = dye_weights(material.dyes);
    for (std::size_t k = 0; k < weights.size(); ++k) {
        const Fluorophore& dye = scene.fluorophores[static_cast<std::size_t>(material.dyes[k].fluorophore)];
        const auto add = [weight = static_cast<float>(weights[k])](Flux16& to, const Flux16& row) {
            for (std::size_t i = 0; i < STOKES_WAVELENGTHS; ++i) to.v[i] += weight * row.v[i];
        };
        add(*first, sampled(dye.excitation, wavelengths.set));
        const auto rows = reradiation_rows(dye, transport, wavelengths);
        for (std::size_t ex = 0; ex < rows.size(); ++ex) add(first[1 + ex], rows[ex]);
    }
}

PassConstants make_constants(const RenderSettings& render, const PassWavelengths& wavelengths, std::uint32_t pass,
                             std::uint32_t photons) {
    PassConstants constants{};
    const double weight = image_weight_nm(render.lambda_min_nm, render.lambda_max_nm);
    const double to_film = luminous_efficacy * 1e6 * weight;
    const ColourMatching& observer = cie1931();
    const WavelengthSet& set = wavelengths.set;
    for (std::size_t i = 0; i < set.size(); ++i) {
        constants.lambda_nm[i] = static_cast<float>(set[i]);
        constants.to_x[i] = static_cast<float>(to_film * observer.x.at(set[i]));
        constants.to_y[i] = static_cast<float>(to_film * observer.y.at(set[i]));
        constants.to_z[i] = static_cast<float>(to_film * observer.z.at(set[i]));
        constants.chain[i] = static_cast<float>(wavelengths.chain[i]);
        constants.strata[i] = wavelengths.strata[i];
    }
    constants.low_discrepancy_pixels = render.sampling == Sampling::plain ? 0 : 1;
    constants.stratified = wavelengths.stratified ? 1 : 0;
    for (std::size_t i = 0; i < level_shares.size(); ++i)
        constants.level_shares[i] = static_cast<float>(level_shares[i]);
    constants.seed = render.seed;
    constants.pass = pass;
    constants.photons = photons;
    constants.first_collision_only = render.first_collision_only ? 1 : 0;
    return constants;
}

}  // namespace

SpectraLayout::SpectraLayout(const Scene& scene) {
    const std::vector<MaterialUse> uses = material_uses(scene);
    row_count = static_cast<std::uint32_t>(uses.size());
    for (const MaterialUse& use : uses) {
        const Material& material = scene.materials[static_cast<std::size_t>(use.material)];
        excitation_row.push_back(row_count);
        if (const auto* translucent = as_translucent(material); translucent != nullptr && !translucent->dyes.empty())
            row_count += 1 + STOKES_WAVELENGTHS;
        white_row.push_back(row_count);
        if (texture_of(material) != nullptr) ++row_count;
    }
    first_sigma_row = row_count;
    row_count += 2 * static_cast<std::uint32_t>(scene.media.size());
}

// Given k wavelengths of a path in the set, the next is in it with probability (n - k)/(N - k).
PassWavelengths pass_wavelengths(const RenderSettings& render, std::uint32_t pass) {
    PassWavelengths result{};
    result.set = draw_wavelengths(render.seed, pass, render.lambda_min_nm, render.lambda_max_nm);
    result.pair_weight_nm = pair_weight_nm(render.lambda_min_nm, render.lambda_max_nm);
    const double all = render.lambda_max_nm - render.lambda_min_nm + 1, drawn = STOKES_WAVELENGTHS;
    for (std::size_t i = 0; i + 1 < result.chain.size(); ++i) {
        const double k = static_cast<double>(i) + 1.0;
        result.chain[i] = (all - k) / (drawn - k) / result.pair_weight_nm;
    }
    return result;
}

std::vector<double> light_probabilities(const Scene& scene) {
    std::vector<double> power;
    for (const Light& light : scene.lights)
        power.push_back(light.flux.sum_1nm(scene.render.lambda_min_nm, scene.render.lambda_max_nm));
    const double total = std::accumulate(power.begin(), power.end(), 0.0);
    if (!(total > 0.0))
        throw InputError(scene.file + ": lights: expected one with power between " +
                         std::to_string(scene.render.lambda_min_nm) + " and " +
                         std::to_string(scene.render.lambda_max_nm) + " nm");
    for (double& p : power) p /= total;
    return power;
}

std::vector<double> dye_weights(const std::vector<Dye>& dyes) {
    const double sum = fluorescent_fraction(dyes);
    std::vector<double> weights;
    for (const Dye& dye : dyes)
        weights.push_back(sum > 0.0 ? dye.fraction / sum : 1.0 / static_cast<double>(dyes.size()));
    return weights;
}

std::array<Flux16, STOKES_WAVELENGTHS> reradiation_rows(const Fluorophore& fluorophore, Transport transport,
                                                        const WavelengthSet& set, double pair_weight_nm) {
    PassWavelengths wavelengths{};
    wavelengths.set = set;
    wavelengths.pair_weight_nm = pair_weight_nm;
    return reradiation_rows(fluorophore, transport, wavelengths);
}

std::array<Flux16, STOKES_WAVELENGTHS> reradiation_rows(const Fluorophore& fluorophore, Transport transport,
                                                        const PassWavelengths& wavelengths) {
    const WavelengthSet& set = wavelengths.set;
    std::array<Flux16, STOKES_WAVELENGTHS> rows{};
    const StokesFactor stokes(fluorophore.emission, stokes_rule_of(fluorophore, transport));
    const TransportModel& model = transport_model(transport);
    for (std::size_t ex = 0; ex < set.size(); ++ex)
        for (std::size_t em = 0; em < set.size(); ++em) {
            if (set[em] <= set[ex]) continue;
            const double emitted =
                stokes(set[ex]) * model.reradiated_per_nm(fluorophore, stokes.sum(), set[ex], set[em]);
            rows[ex].v[em] =
                static_cast<float>(emitted * fluorophore.excitation.at(set[ex]) * wavelengths.weight_nm(ex, em));
        }
    return rows;
}

PassSpectra make_pass_spectra(const Scene& scene, const std::vector<double>& probabilities,
                              const std::vector<double>& light_spread, std::uint32_t pass, std::uint32_t photons) {
    return make_pass_spectra(scene, probabilities, light_spread, pass_wavelengths(scene.render, pass), pass, photons);
}

PassSpectra make_pass_spectra(const Scene& scene, const std::vector<double>& probabilities,
                              const std::vector<double>& light_spread, const PassWavelengths& wavelengths,
                              std::uint32_t pass, std::uint32_t photons) {
    const WavelengthSet& set = wavelengths.set;
    PassSpectra result;
    result.constants = make_constants(scene.render, wavelengths, pass, photons);
    const SpectraLayout layout(scene);
    result.rows.resize(layout.row_count);
    const std::vector<MaterialUse> uses = material_uses(scene);
    for (std::size_t m = 0; m < uses.size(); ++m) {
        const Material& material = scene.materials[static_cast<std::size_t>(uses[m].material)];
        const auto black = [](const BlackMaterial&) {};
        const auto diffuse = [&](const DiffuseMaterial& of) {
            result.rows[m] = sampled(of.reflectance, set);
            if (of.texture) result.rows[layout.white_row[m]] = sampled(of.white, set);
        };
        const auto translucent = [&](const TranslucentMaterial& of) {
            add_dyes(of, uses[m].transport, scene, wavelengths, &result.rows[layout.excitation_row[m]]);
        };
        std::visit(Overloaded{black, diffuse, translucent}, material.kind);
    }
    for (std::size_t m = 0; m < scene.media.size(); ++m) {
        Flux16* sigma_t = &result.rows[layout.sigma_row(static_cast<int>(m))];
        Flux16* albedo = sigma_t + 1;
        for (std::size_t i = 0; i < set.size(); ++i) {
            const double s = scene.media[m].sigma_s.at(set[i]), t = s + scene.media[m].sigma_a.at(set[i]);
            sigma_t->v[i] = static_cast<float>(t);
            albedo->v[i] = static_cast<float>(s / t);
        }
    }
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i];
        const double p = probabilities[i];
        result.photon_flux.push_back(starting(light.flux, wavelengths, p > 0.0 ? 1.0 / (p * photons) : 0.0));
        const double spread = light_spread[i];
        result.radiance.push_back(starting(light.flux, wavelengths, spread > 0.0 ? 1.0 / spread : 0.0));
    }
    return result;
}

}  // namespace stokes
