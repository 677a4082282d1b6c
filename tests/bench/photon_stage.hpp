// The photon half of a pass alone: what Renderer does before it looks through the camera.
#pragma once

#include "host/render/device_scene.hpp"
#include "host/render/photon_pass.hpp"
#include "host/render/spatial_hash.hpp"

namespace stokes::bench {

class PhotonStage {
  public:
    PhotonStage(const Device& device, const Scene& scene, std::uint32_t photons)
        : device_(device),
          scene_(scene),
          photons_(photons),
          on_device_(device, scene_),
          builder_(device, photons),
          hash_(device, "photon map", photons),
          pass_(device, scene_, on_device_, photons, photons + 1024, &builder_, &hash_) {}
    PhotonStage(const PhotonStage&) = delete;
    PhotonStage& operator=(const PhotonStage&) = delete;

    void make_pass(std::uint32_t pass) {
        pass_.prepare(pass, photons_);
        device_.finish();
    }
    // From emission to the last deposit; waits for it. Returns the account of the pass.
    PhotonAccount trace() {
        const PhotonAccount account = pass_.trace();
        device_.finish();
        return account;
    }
    // Sorts what trace() left in the maps, one map after the other.
    void sort(float radius_mm) {
        for (const PhotonMap& map : pass_.maps())
            if (map.used() > 0)
                builder_.build(hash_, map.heads(), map.flux(), map.used(), on_device_.minimum_mm, on_device_.maximum_mm,
                               radius_mm);
        device_.finish();
    }
    const PhotonMaps& maps() const { return pass_.maps(); }

  private:
    Device device_;
    Scene scene_;
    std::uint32_t photons_;
    DeviceScene on_device_;
    HashBuilder builder_;
    SpatialHash hash_;
    PhotonPass pass_;
};

}  // namespace stokes::bench
