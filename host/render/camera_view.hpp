// The camera: where its rays go.
#pragma once

#include "host/device/kernel.hpp"
#include "host/scene/scene.hpp"
#include "kernels/shared/camera.h"
#include "kernels/shared/pass.h"
#include "kernels/shared/ray.h"

namespace stokes {

// The pinhole camera for width x height square pixels that show the camera's crop; so the whole picture has width /
// crop.width by height / crop.height of them. InputError when the target is the position, up points along the view,
// the angle is not between 0 and 180 degrees, the crop is empty, or there are no pixels.
CameraRecord make_camera_record(const Camera& camera, int width, int height);

// The whole picture that the record above shows the crop of, in as many pixels, which need not be square.
CameraRecord make_whole_record(const Camera& camera, int width, int height);

// One jittered ray per pixel and pass.
class CameraView {
  public:
    CameraView(const Device& device, const CameraRecord& camera);

    const CameraRecord& camera() const { return camera_; }
    // Rays of a pass: one per pixel, in the order of kernels/lib/tiles.clh.
    std::uint32_t ray_count() const { return camera_.width * camera_.height; }

    // Writes rays[ray_count()] for the pass. Asynchronous.
    void make_rays(const Arguments& pass, const Buffer<Ray>& rays) { make_rays(camera_, pass, rays); }
    // Writes the rays of another camera of as many pixels.
    void make_rays(const CameraRecord& camera, const Arguments& pass, const Buffer<Ray>& rays);

  private:
    CameraRecord camera_;
    Kernel camera_rays_;
};

}  // namespace stokes
