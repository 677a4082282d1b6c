#include "host/render/pass_maker.hpp"

#include <algorithm>
#include <vector>

#include "host/render/wavelength_importance.hpp"
#include "host/subsurface/paper_transport.hpp"

namespace stokes {

namespace {

GreenResampler::Sixteen sixteen(const Flux16& row) {
    GreenResampler::Sixteen result;
    std::copy(std::begin(row.v), std::end(row.v), result.begin());
    return result;
}

}  // namespace

PassMaker::PassMaker(const Device& device, const Scene& scene, const DeviceScene& on_device)
    : device_(device),
      scene_(scene),
      on_device_(on_device),
      strata_(stratified_wavelengths(scene)),
      wavelengths_(device, "wavelengths of the pass", STOKES_WAVELENGTHS) {
    buffers_.constants = Buffer<PassConstants>(device, "pass constants", 1);
    buffers_.rows = Buffer<Flux16>(device, "spectra of the pass", SpectraLayout(scene).row_count);
    buffers_.photon_flux = Buffer<Flux16>(device, "photon flux of the lights", scene.lights.size());
    buffers_.radiance = Buffer<Flux16>(device, "radiance of the lights", scene.lights.size());
    buffers_.both_branches =
        scene.render.transport != Transport::walk && chosen_branches(scene.render) == Branches::both;
    buffers_.store_direct = chosen_direct(scene.render) == Direct::photons;
    buffers_.weighted_distances = chosen_distances(scene.render) == Distances::importance;
    buffers_.exits = static_cast<std::uint32_t>(chosen_exits(scene.render));
    const DeviceTables& tables = on_device.tables;
    if (tables.values.size() > 0) resample_ = Program(device, "resample_tables.cl").kernel("resample_table");
    for (const auto& [eta, table] : tables.green_tables) green_[eta] = std::make_unique<GreenResampler>(device, table);
    if (!tables.green.empty())
        green_tables_ = {tables.at_wavelengths, Buffer<Flux16>(device, "probabilities of escape", tables.green_rows),
                         tables.mean_rows, tables.cumulative_rows};
}

void PassMaker::make(std::uint32_t pass, std::uint32_t photons) {
    make(strata_ ? strata_->draw(scene_.render.seed, pass) : pass_wavelengths(scene_.render, pass), pass, photons);
}

void PassMaker::make(const PassWavelengths& wavelengths, std::uint32_t pass, std::uint32_t photons) {
    spectra_ =
        make_pass_spectra(scene_, on_device_.light_probability, on_device_.light_spread, wavelengths, pass, photons);
    spectra_.constants.offset_mm = on_device_.offset_mm;
    spectra_.constants.low_discrepancy_exits = buffers_.cell_count > 0 ? 1u : 0u;
    buffers_.constants.upload(&spectra_.constants, 1);
    buffers_.rows.upload(spectra_.rows);
    buffers_.photon_flux.upload(spectra_.photon_flux);
    buffers_.radiance.upload(spectra_.radiance);
    if (buffers_.cell_count > 0) buffers_.first_photons.upload(cells_.first_photons(scene_.render.seed, pass));
    resample_tables();
    if (on_device_.integrated) sample_media();
}

void PassMaker::set_emission(EmissionCells cells) {
    cells_ = std::move(cells);
    buffers_.cell_count = static_cast<std::uint32_t>(cells_.records().size());
    buffers_.cells = Buffer<EmissionCell>(device_, "emission cells", cells_.records());
    buffers_.first_photons = Buffer<std::uint32_t>(device_, "first photons of the cells", cells_.records().size() + 1);
}

// Where there are no power tables.
void PassMaker::sample_media() {
    std::vector<PassMedium> media(scene_.media.size(), PassMedium{});
    for (std::size_t m = 0; m < media.size(); ++m) {
        const Medium& medium = scene_.media[m];
        for (std::size_t i = 0; i < STOKES_WAVELENGTHS; ++i) {
            const auto lambda = static_cast<double>(spectra_.constants.lambda_nm[i]);
            media[m].sigma_s[i] = static_cast<float>(medium.sigma_s.at(lambda));
            media[m].sigma_a[i] = static_cast<float>(medium.sigma_a.at(lambda));
        }
        media[m].dipole_a = static_cast<float>(dipole_boundary(medium.dipole_eta));
    }
    on_device_.integrated->at_wavelengths.upload(media);
}

void PassMaker::resample_tables() {
    const DeviceTables& tables = on_device_.tables;
    if (tables.values.size() > 0) {
        const UniformAxis& lambda = tables.wavelengths;
        wavelengths_.upload(spectra_.constants.lambda_nm, STOKES_WAVELENGTHS);
        resample_.launch(tables.entries, tables.values, static_cast<std::uint32_t>(lambda.count),
                         static_cast<float>(lambda.first), static_cast<float>(lambda.step), wavelengths_,
                         tables.at_wavelengths, tables.entries);
    }
    const SpectraLayout layout(scene_);
    for (const GreenOwner& owner : tables.green) {
        const std::uint32_t row = layout.sigma_row(owner.medium);
        green_.at(owner.eta)->resample(owner.shape, owner.first_row, sixteen(spectra_.rows[row]),
                                       sixteen(spectra_.rows[row + 1]), green_tables_);
    }
}

}  // namespace stokes
