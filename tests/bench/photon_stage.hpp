// The photon half of a pass alone: what Renderer does before it looks through the camera.
#pragma once

#include "host/render/device_scene.hpp"
#include "host/render/pass_maker.hpp"
#include "host/render/photon_tracer.hpp"
#include "host/render/spatial_hash.hpp"

namespace stokes::bench {

class PhotonStage {
  public:
    PhotonStage(const Device& device, const Scene& scene, std::uint32_t photons)
        : device_(device),
          scene_(scene),
          photons_(photons),
          on_device_(device, scene_),
          pass_(device, scene_, on_device_),
          tracer_(device, on_device_.rays.kernels, photons),
          builder_(device, photons),
          hash_(device, "photon map", photons),
          maps_{map("fluorescence"), map("single scattering"), map("multiple scattering"), map("surface")} {}
    PhotonStage(const PhotonStage&) = delete;
    PhotonStage& operator=(const PhotonStage&) = delete;

    void make_pass(std::uint32_t pass) {
        pass_.make(pass, photons_);
        device_.finish();
    }
    // From emission to the last deposit; waits for it. Returns the account of the pass.
    PhotonAccount trace() {
        for (PhotonMap& map : maps_) map.clear();
        const PhotonAccount account = tracer_.trace(on_device_, pass_.buffers(), photons_, maps_);
        device_.finish();
        return account;
    }
    // Sorts what trace() left in the maps, one map after the other.
    void sort(float radius_mm) {
        for (PhotonMap& map : maps_)
            if (map.used() > 0)
                builder_.build(hash_, map.heads(), map.flux(), map.used(), on_device_.minimum_mm, on_device_.maximum_mm,
                               radius_mm);
        device_.finish();
    }
    const PhotonMaps& maps() const { return maps_; }

  private:
    PhotonMap map(const char* name) { return PhotonMap(device_, name, photons_ + 1024, &builder_, &hash_); }
    Device device_;
    Scene scene_;
    std::uint32_t photons_;
    DeviceScene on_device_;
    PassMaker pass_;
    PhotonTracer tracer_;
    HashBuilder builder_;
    SpatialHash hash_;
    PhotonMaps maps_;
};

}  // namespace stokes::bench
