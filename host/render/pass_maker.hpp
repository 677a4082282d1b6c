// What one pass needs on the device: its wavelengths, and every spectrum and table brought onto them.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "host/device/device.hpp"
#include "host/render/device_scene.hpp"
#include "host/render/emission_cells.hpp"
#include "host/render/green_resampler.hpp"
#include "host/render/pass_spectra.hpp"
#include "host/render/photon_tracer.hpp"
#include "host/render/stratified_wavelengths.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

class PassMaker {
  public:
    // Both outlive it.
    PassMaker(const Device& device, const Scene& scene, const DeviceScene& on_device);

    // The pass of this index of the scene's render, or one with wavelengths of one's own. What buffers() held before
    // is replaced, and so are the tables of the DeviceScene.
    void make(std::uint32_t pass, std::uint32_t photons);
    void make(const PassWavelengths& wavelengths, std::uint32_t pass, std::uint32_t photons);

    // How photons start in the passes that are made from now on; until then anywhere on the lights, at random.
    void set_emission(EmissionCells cells);

    const PassBuffers& buffers() const { return buffers_; }
    // As they stand in buffers().
    const PassSpectra& spectra() const { return spectra_; }

  private:
    void resample_tables();
    void sample_media();
    const Device device_;
    const Scene& scene_;
    const DeviceScene& on_device_;
    std::optional<StratifiedWavelengths> strata_;
    EmissionCells cells_;
    PassBuffers buffers_;
    PassSpectra spectra_;
    Kernel resample_;
    Buffer<float> wavelengths_;
    std::map<double, std::unique_ptr<GreenResampler>> green_;  // by refractive index
    GreenPassTables green_tables_;
};

}  // namespace stokes
