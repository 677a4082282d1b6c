#include "host/render/pass_spectra.hpp"

#include <cmath>
#include <numeric>

#include "host/core/error.hpp"
#include "host/image/colour.hpp"

namespace stokes {

namespace {

Flux16 sampled(const Spectrum& spectrum, const WavelengthSet& set, double factor = 1.0) {
    Flux16 result;
    for (std::size_t i = 0; i < set.size(); ++i) result.v[i] = static_cast<float>(factor * spectrum.at(set[i]));
    return result;
}

PassConstants make_constants(const RenderSettings& render, const WavelengthSet& set, std::uint32_t pass,
                             std::uint32_t photons) {
    PassConstants constants{};
    const double weight = image_weight_nm(render.lambda_min_nm, render.lambda_max_nm);
    const double to_film = luminous_efficacy * 1e6 * weight;
    const ColourMatching& observer = cie1931();
    for (std::size_t i = 0; i < set.size(); ++i) {
        constants.lambda_nm[i] = static_cast<float>(set[i]);
        constants.to_x[i] = static_cast<float>(to_film * observer.x.at(set[i]));
        constants.to_y[i] = static_cast<float>(to_film * observer.y.at(set[i]));
        constants.to_z[i] = static_cast<float>(to_film * observer.z.at(set[i]));
    }
    constants.seed = render.seed;
    constants.pass = pass;
    constants.photons = photons;
    constants.wavelengths = static_cast<float>(render.lambda_max_nm - render.lambda_min_nm + 1);
    return constants;
}

}  // namespace

SpectraLayout::SpectraLayout(const Scene& scene)
    : materials(static_cast<std::uint32_t>(scene.materials.size())),
      fluorophores(static_cast<std::uint32_t>(scene.fluorophores.size())) {}

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

std::array<Flux16, STOKES_WAVELENGTHS> reradiation_rows(const Fluorophore& fluorophore, const WavelengthSet& set,
                                                        double pair_weight) {
    std::array<Flux16, STOKES_WAVELENGTHS> rows{};
    for (std::size_t ex = 0; ex < set.size(); ++ex)
        for (std::size_t em = 0; em < set.size(); ++em)
            if (set[em] > set[ex])
                rows[ex].v[em] = static_cast<float>(fluorophore.conversion * fluorophore.excitation.at(set[ex]) *
                                                    fluorophore.emission.at(set[em]) * pair_weight);
    return rows;
}

PassSpectra make_pass_spectra(const Scene& scene, const std::vector<double>& probabilities,
                              const std::vector<double>& surface_area_mm2, std::uint32_t pass, std::uint32_t photons) {
    const RenderSettings& render = scene.render;
    const WavelengthSet set = draw_wavelengths(render.seed, pass, render.lambda_min_nm, render.lambda_max_nm);
    PassSpectra result;
    result.constants = make_constants(render, set, pass, photons);
    for (const Material& material : scene.materials) result.rows.push_back(sampled(material.reflectance, set));
    const double pair_weight = pair_weight_nm(render.lambda_min_nm, render.lambda_max_nm);
    for (const Fluorophore& fluorophore : scene.fluorophores) {
        result.rows.push_back(sampled(fluorophore.excitation, set));
        for (const Flux16& row : reradiation_rows(fluorophore, set, pair_weight)) result.rows.push_back(row);
    }
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i];
        const double p = probabilities[i];
        result.photon_flux.push_back(sampled(light.flux, set, p > 0.0 ? 1.0 / (p * photons) : 0.0));
        const bool surface = light.kind == LightKind::surface;
        result.radiance.push_back(sampled(light.flux, set, surface ? 1.0 / (M_PI * surface_area_mm2[i]) : 0.0));
    }
    return result;
}

}  // namespace stokes
