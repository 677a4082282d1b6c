// Trial passes, which find out where the light of the picture starts, and aim the photons there.
#pragma once

#include "host/device/kernel.hpp"
#include "host/render/device_scene.hpp"
#include "host/render/emission_cells.hpp"
#include "host/render/gather.hpp"
#include "host/render/photon_pass.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

std::vector<EmittingLight> emitting_lights(const Scene& scene, const DeviceScene& on_device);

class EmissionTrial {
  public:
    EmissionTrial(const Device& device, std::uint32_t photons);

    // Takes in a pass of that many photons that PhotonPass has traced from these cells, into maps that tracked their
    // paths; common: arguments of the scene and the pass; points: what the camera finds in it, in the order of its
    // rays.
    void add(const EmissionCells& cells, const Arguments& common, const PhotonMaps& maps, const CameraRecord& camera,
             const Buffer<GatherPoint>& points);

    // The samples of all passes so far.
    std::vector<EmissionSample> samples() const;

  private:
    std::vector<double> path_scores(const Arguments& common, const PhotonMaps& maps, const CameraRecord& camera,
                                    const Buffer<GatherPoint>& points);

    Device device_;
    std::uint32_t photons_, passes_ = 0;
    Kernel find_places_, score_photons_;
    Buffer<std::uint32_t> cells_;
    Buffer<float> scores_;
    struct alignas(16) Place {
        float at[4];
    };
    Buffer<Place> places_;
    std::vector<EmissionSample> samples_;
};

}  // namespace stokes
