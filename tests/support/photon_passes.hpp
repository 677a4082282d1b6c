// Passes of photons without a camera: what they leave in the maps.
#pragma once

#include <vector>

#include "host/render/photon_pass.hpp"
#include "tests/support/device_fixture.hpp"

namespace stokes {

// The slots of a map in use; one that nothing was stored in has the normal STOKES_EMPTY_SLOT.
struct Deposits {
    std::vector<PhotonHead> heads;
    std::vector<Flux16> flux;
};

struct PhotonPasses {
    // photons: of a pass; the scene's where it is 0.
    explicit PhotonPasses(const Scene& source, std::uint32_t photons_per_pass = 0)
        : scene(source),
          photons(photons_per_pass > 0 ? photons_per_pass : static_cast<std::uint32_t>(scene.render.photons_per_pass)),
          on_device(test_device(), scene),
          pass(test_device(), scene, on_device, photons, 16) {}  // maps that have to grow
    PhotonPasses(const PhotonPasses&) = delete;
    PhotonPasses& operator=(const PhotonPasses&) = delete;

    // Traces one pass: of this index of the scene's render, or with wavelengths of one's own.
    PhotonAccount trace(std::uint32_t index) {
        pass.prepare(index, photons);
        return pass.trace();
    }
    PhotonAccount trace(const PassWavelengths& wavelengths, std::uint32_t index) {
        pass.prepare(wavelengths, index, photons);
        return pass.trace();
    }

    const PassConstants& constants() const { return pass.inputs().spectra().constants; }
    const PhotonMaps& maps() const { return pass.maps(); }
    std::vector<Flux16> flux(std::size_t m) const { return maps()[m].flux().download(maps()[m].used()); }
    Deposits deposits(std::size_t m) const { return {maps()[m].heads().download(maps()[m].used()), flux(m)}; }

    const Scene scene;
    const std::uint32_t photons;
    const DeviceScene on_device;
    PhotonPass pass;
};

}  // namespace stokes
