// Passes of photons without a camera: what they leave in the maps.
#pragma once

#include <vector>

#include "host/render/pass_maker.hpp"
#include "host/render/photon_tracer.hpp"
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
          maker(test_device(), scene, on_device),
          tracer(test_device(), on_device.rays.kernels, photons),
          maps{map("F"), map("S"), map("M"), map("surface")} {}
    PhotonPasses(const PhotonPasses&) = delete;
    PhotonPasses& operator=(const PhotonPasses&) = delete;

    // Traces one pass into empty maps: of this index of the scene's render, or with wavelengths of one's own.
    PhotonAccount trace(std::uint32_t pass) {
        maker.make(pass, photons);
        return trace_made();
    }
    PhotonAccount trace(const PassWavelengths& wavelengths, std::uint32_t pass) {
        maker.make(wavelengths, pass, photons);
        return trace_made();
    }

    const PassConstants& constants() const { return maker.spectra().constants; }
    std::vector<Flux16> flux(std::size_t m) const { return maps[m].flux().download(maps[m].used()); }
    Deposits deposits(std::size_t m) const { return {maps[m].heads().download(maps[m].used()), flux(m)}; }

    const Scene scene;
    const std::uint32_t photons;
    const DeviceScene on_device;
    PassMaker maker;
    PhotonTracer tracer;
    PhotonMaps maps;

  private:
    // Small: it has to grow.
    static PhotonMap map(const char* name) { return PhotonMap(test_device(), name, 16); }
    PhotonAccount trace_made() {
        for (PhotonMap& m : maps) m.clear();
        return tracer.trace(on_device, maker.buffers(), photons, maps);
    }
};

}  // namespace stokes
