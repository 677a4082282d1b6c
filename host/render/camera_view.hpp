// The camera: where its rays go.
#pragma once

#include "host/device/device.hpp"
#include "host/scene/scene.hpp"
#include "kernels/shared/camera.h"
#include "kernels/shared/pass.h"
#include "kernels/shared/ray.h"

namespace stokes {

// The pinhole camera for a picture of width x height pixels. InputError when the target is the position, up
// points along the view, the angle is not between 0 and 180 degrees, or there are no pixels.
CameraRecord make_camera_record(const Camera& camera, int width, int height);

// One jittered ray per pixel and pass.
class CameraView {
  public:
    CameraView(const Device& device, const CameraRecord& camera);

    const CameraRecord& camera() const { return camera_; }
    // Rays of a pass: one per pixel, in the order of kernels/lib/tiles.clh.
    std::uint32_t ray_count() const { return camera_.width * camera_.height; }

    // Writes rays[ray_count()] for the pass. Asynchronous.
    void make_rays(const Buffer<PassConstants>& pass, const Buffer<Ray>& rays);

  private:
    CameraRecord camera_;
    Kernel camera_rays_;
};

}  // namespace stokes
