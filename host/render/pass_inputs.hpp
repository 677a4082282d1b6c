// What the kernels of one pass read that depends on its wavelengths, and where its photons start.
#pragma once

#include <cstdint>
#include <optional>

#include "host/device/kernel.hpp"
#include "host/render/device_scene.hpp"
#include "host/render/emission_cells.hpp"
#include "host/render/pass_spectra.hpp"
#include "host/render/stratified_wavelengths.hpp"
#include "host/scene/scene.hpp"
#include "kernels/shared/light.h"

namespace stokes {

class PassInputs {
  public:
    // All outlive it.
    PassInputs(const Device& device, const Scene& scene, const DeviceScene& on_device);

    // Brings spectra and cells to the pass of this index of the scene's render, or to a pass of other wavelengths. The
    // pass before is replaced.
    void prepare(std::uint32_t pass, std::uint32_t photons);
    void prepare(const PassWavelengths& wavelengths, std::uint32_t pass, std::uint32_t photons);

    // Sets how photons start in the passes that are prepared from now on. Without cells they start anywhere on the
    // lights, at random.
    void set_emission(EmissionCells cells);
    bool has_cells() const { return !cells_.records().empty(); }

    // Gives each photon this flux at every wavelength [W/nm], until the next prepare().
    void set_photon_flux(float flux) const;

    // Groups PASS_ARGUMENTS and EMISSION_ARGUMENTS, and photon_flux and light_radiance [lights].
    Arguments arguments() const;

    // The spectra and the photons of the pass that was prepared.
    const PassSpectra& spectra() const { return spectra_; }
    std::uint32_t photons() const { return spectra_.constants.photons; }

  private:
    const Device device_;
    const Scene& scene_;
    const DeviceScene& on_device_;
    std::optional<StratifiedWavelengths> strata_;
    EmissionCells cells_;
    PassSpectra spectra_{};
    Buffer<PassConstants> constants_;  // [1]
    Buffer<Flux16> rows_;
    Buffer<Flux16> photon_flux_, radiance_;  // [lights]; of beams the irradiance across them
    Buffer<EmissionCell> cell_records_;
    Buffer<std::uint32_t> first_photons_;  // [cells + 1]
};

}  // namespace stokes
