#include "host/render/pass_spectra.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/core/error.hpp"
#include "host/image/colour.hpp"
#include "host/render/stratified_wavelengths.hpp"

namespace stokes {

namespace {

// Over which the emission is normalised [nm].

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

std::uint32_t transport_code(Transport transport) {
    return transport == Transport::paper        ? STOKES_TRANSPORT_PAPER
           : transport == Transport::conserving ? STOKES_TRANSPORT_CONSERVING
                                                : STOKES_TRANSPORT_WALK;
}

double section_area_mm2(const Light& beam) {
    const double sides = glm::length(beam.half_u_mm) * glm::length(beam.half_v_mm);
    return beam.section == BeamSection::disk ? M_PI * sides : 4.0 * sides;
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
    constants.transport = transport_code(render.transport);
    constants.first_collision_only = render.first_collision_only ? 1 : 0;
    return constants;
}

}  // namespace

SpectraLayout::SpectraLayout(const Scene& scene)
    : materials(static_cast<std::uint32_t>(scene.materials.size())),
      fluorophores(static_cast<std::uint32_t>(scene.fluorophores.size())),
      media(static_cast<std::uint32_t>(scene.media.size())),
      textures(static_cast<std::uint32_t>(std::count_if(scene.materials.begin(), scene.materials.end(),
                                                        [](const Material& m) { return m.texture != nullptr; }))) {}

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
    const double sum = fluorophore.emission.sum_1nm();
    for (std::size_t ex = 0; ex < set.size(); ++ex)
        for (std::size_t em = 0; em < set.size(); ++em) {
            if (set[em] <= set[ex]) continue;
            const double emitted =
                transport == Transport::paper
                    ? fluorophore.conversion * fluorophore.emission.at(set[em])
                    : fluorophore.quantum_yield * fluorophore.emission.at(set[em]) / sum * set[ex] / set[em];
            rows[ex].v[em] =
                static_cast<float>(emitted * fluorophore.excitation.at(set[ex]) * wavelengths.weight_nm(ex, em));
        }
    return rows;
}

PassSpectra make_pass_spectra(const Scene& scene, const std::vector<double>& probabilities,
                              const std::vector<double>& surface_area_mm2, std::uint32_t pass, std::uint32_t photons) {
    return make_pass_spectra(scene, probabilities, surface_area_mm2, pass_wavelengths(scene.render, pass), pass,
                             photons);
}

PassSpectra make_pass_spectra(const Scene& scene, const std::vector<double>& probabilities,
                              const std::vector<double>& surface_area_mm2, const PassWavelengths& wavelengths,
                              std::uint32_t pass, std::uint32_t photons) {
    const WavelengthSet& set = wavelengths.set;
    PassSpectra result;
    result.constants = make_constants(scene.render, wavelengths, pass, photons);
    for (const Material& material : scene.materials) result.rows.push_back(sampled(material.reflectance, set));
    for (const Fluorophore& fluorophore : scene.fluorophores) {
        result.rows.push_back(sampled(fluorophore.excitation, set));
        for (const Flux16& row : reradiation_rows(fluorophore, scene.render.transport, wavelengths))
            result.rows.push_back(row);
    }
    for (const Medium& medium : scene.media) {
        Flux16 sigma_t{}, albedo{};
        for (std::size_t i = 0; i < set.size(); ++i) {
            const double s = medium.sigma_s.at(set[i]), t = s + medium.sigma_a.at(set[i]);
            sigma_t.v[i] = static_cast<float>(t);
            albedo.v[i] = static_cast<float>(s / t);
        }
        result.rows.push_back(sigma_t);
        result.rows.push_back(albedo);
    }
    for (const Material& material : scene.materials)
        if (material.texture) result.rows.push_back(sampled(material.white, set));
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i];
        const double p = probabilities[i];
        result.photon_flux.push_back(starting(light.flux, wavelengths, p > 0.0 ? 1.0 / (p * photons) : 0.0));
        const double spread = light.kind == LightKind::surface ? M_PI * surface_area_mm2[i] : section_area_mm2(light);
        result.radiance.push_back(starting(light.flux, wavelengths, spread > 0.0 ? 1.0 / spread : 0.0));
    }
    return result;
}

}  // namespace stokes
