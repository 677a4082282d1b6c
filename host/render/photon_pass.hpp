// The photon half of a pass: photons go from the lights, event by event, into the maps. Renders, their trial passes and
// the probe all use this class.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "host/device/kernel.hpp"
#include "host/render/device_scene.hpp"
#include "host/render/pass_inputs.hpp"
#include "host/render/photon_map.hpp"
#include "host/render/photon_paths.hpp"
#include "host/render/transport/subsurface_transport.hpp"

namespace stokes {

class PhotonPass {
  public:
    // Room for this many photons; compiles the photon kernels. first_slots: what each map has room for to begin with.
    // builder, hash: what the maps will be sorted with, as for PhotonMap. scene, on_device, builder and hash outlive
    // it.
    PhotonPass(const Device& device, const Scene& scene, const DeviceScene& on_device, std::uint32_t photons,
               std::uint32_t first_slots, HashBuilder* builder = nullptr, SpatialHash* hash = nullptr);

    // Brings spectra and tables to the wavelengths of the pass of this index, or to others.
    void prepare(std::uint32_t pass, std::uint32_t photons);
    void prepare(const PassWavelengths& wavelengths, std::uint32_t pass, std::uint32_t photons);

    // Follows the photons of the prepared pass to their ends. The maps then hold the deposits of this pass alone.
    PhotonAccount trace(const PathSampling& sampling);
    PhotonAccount trace() { return trace(sampling_); }

    // Notes from now on which bodies photons meet, until each translucent one has been met.
    void note_met_bodies();
    // Translucent bodies that no photon has met since then, by index.
    const std::vector<int>& unmet_bodies() const { return unmet_bodies_; }

    // The arguments of the scene and of the prepared pass.
    Arguments arguments() const;

    // The sampling that the scene's settings ask for.
    const PathSampling& sampling() const { return sampling_; }
    PassInputs& inputs() { return inputs_; }
    const PassInputs& inputs() const { return inputs_; }
    PhotonMaps& maps() { return maps_; }
    const PhotonMaps& maps() const { return maps_; }

  private:
    void emit() const;
    void trace_rays(std::uint32_t count) const;
    ListCounts classify(const EventRound& round);
    void check_scattered(const ListCounts& lists) const;
    void scatter_at_surfaces(const SubsurfaceEvent& event);
    void forget_met_bodies();

    const DeviceScene& on_device_;
    PassInputs inputs_;
    PathSampling sampling_;
    PhotonPaths paths_;
    PhotonMaps maps_;
    SubsurfaceExits exits_;
    std::vector<std::unique_ptr<SubsurfaceTransport>> transports_;  // those that some body uses
    Kernel emit_, emit_stratified_, trace_, classify_, scatter_;
    std::vector<int> translucent_bodies_, unmet_bodies_;
    Buffer<std::uint32_t> met_bodies_;  // [bodies], one at least
    Arguments common_;                  // of the scene, the pass and the paths
};

}  // namespace stokes
