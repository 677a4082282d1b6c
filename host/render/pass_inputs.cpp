#include "host/render/pass_inputs.hpp"

#include <algorithm>
#include <vector>

#include "host/render/wavelength_importance.hpp"

namespace stokes {

PassInputs::PassInputs(const Device& device, const Scene& scene, const DeviceScene& on_device)
    : device_(device),
      scene_(scene),
      on_device_(on_device),
      strata_(stratified_wavelengths(scene)),
      constants_(device, "pass constants", 1),
      rows_(device, "spectra of the pass", SpectraLayout(scene).row_count),
      photon_flux_(device, "photon flux of the lights", scene.lights.size()),
      radiance_(device, "radiance of the lights", scene.lights.size()) {}

void PassInputs::prepare(std::uint32_t pass, std::uint32_t photons) {
    prepare(strata_ ? strata_->draw(scene_.render.seed, pass) : pass_wavelengths(scene_.render, pass), pass, photons);
}

void PassInputs::prepare(const PassWavelengths& wavelengths, std::uint32_t pass, std::uint32_t photons) {
    spectra_ =
        make_pass_spectra(scene_, on_device_.light_probability, on_device_.light_spread, wavelengths, pass, photons);
    spectra_.constants.offset_mm = on_device_.offset_mm;
    spectra_.constants.low_discrepancy_exits = has_cells() ? 1u : 0u;
    constants_.upload(&spectra_.constants, 1);
    rows_.upload(spectra_.rows);
    photon_flux_.upload(spectra_.photon_flux);
    radiance_.upload(spectra_.radiance);
    if (has_cells()) first_photons_.upload(cells_.first_photons(scene_.render.seed, pass));
}

void PassInputs::set_emission(EmissionCells cells) {
    cells_ = std::move(cells);
    cell_records_ = Buffer<EmissionCell>(device_, "emission cells", cells_.records());
    first_photons_ = Buffer<std::uint32_t>(device_, "first photons of the cells", cells_.records().size() + 1);
}

void PassInputs::set_photon_flux(float flux) const {
    Flux16 uniform;
    std::fill(std::begin(uniform.v), std::end(uniform.v), flux);
    photon_flux_.upload(std::vector<Flux16>(photon_flux_.size(), uniform));
}

Arguments PassInputs::arguments() const {
    return Arguments("pass", constants_)
        .add("spectra", rows_)
        .add("photon_flux", photon_flux_)
        .add("light_radiance", radiance_)
        .add("cell_count", static_cast<std::uint32_t>(cells_.records().size()))
        .add("cells", cell_records_)
        .add("first_photons", first_photons_);
}

}  // namespace stokes
