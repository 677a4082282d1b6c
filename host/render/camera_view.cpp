#include "host/render/camera_view.hpp"

#include <cmath>

namespace stokes {

namespace {

// Of the whole picture whose crop width x height square pixels show, this window in as many pixels.
CameraRecord make_record(const Camera& camera, const Crop& window, int width, int height) {
    if (width < 1 || height < 1 || static_cast<double>(width) * height > 0x1p31)
        throw InputError("film: expected a picture of 1 to 2^31 pixels");
    if (!(camera.vertical_fov_deg > 0.0 && camera.vertical_fov_deg < 180.0))
        throw InputError("camera: expected a field of view between 0 and 180 degrees");
    const glm::dvec3 view = camera.target_mm - camera.position_mm;
    if (!(glm::length(view) > 0.0)) throw InputError("camera: expected a target away from the position");
    const glm::dvec3 forward = glm::normalize(view);
    const glm::dvec3 side = glm::cross(forward, camera.up);
    if (!(glm::length(side) > 1e-9 * glm::length(camera.up)))
        throw InputError("camera: expected an up direction that is not along the view");

    if (!(camera.crop.width > 0.0 && camera.crop.height > 0.0))
        throw InputError("camera: expected a crop of a width and a height above 0");

    // The whole picture at distance 1.
    const double whole_height = 2.0 * std::tan(glm::radians(camera.vertical_fov_deg) / 2.0);
    const double whole_width = whole_height * camera.crop.height / height * width / camera.crop.width;
    const glm::dvec3 across = glm::normalize(side) * whole_width;
    const glm::dvec3 downward = glm::normalize(glm::cross(forward, side)) * whole_height;
    const glm::dvec3 corner = forward + across * (window.left - 0.5) + downward * (window.top - 0.5);
    const glm::dvec3 right = across * (window.width / width), down = downward * (window.height / height);

    CameraRecord record{};
    record.width = static_cast<unsigned>(width);
    record.height = static_cast<unsigned>(height);
    const auto store = [](const glm::dvec3& from, float& x, float& y, float& z) {
        x = static_cast<float>(from.x);
        y = static_cast<float>(from.y);
        z = static_cast<float>(from.z);
    };
    store(camera.position_mm, record.position_x, record.position_y, record.position_z);
    store(corner, record.corner_x, record.corner_y, record.corner_z);
    store(right, record.right_x, record.right_y, record.right_z);
    store(down, record.down_x, record.down_y, record.down_z);
    return record;
}

}  // namespace

CameraRecord make_camera_record(const Camera& camera, int width, int height) {
    return make_record(camera, camera.crop, width, height);
}

CameraRecord make_whole_record(const Camera& camera, int width, int height) {
    return make_record(camera, Crop{}, width, height);
}

CameraView::CameraView(const Device& device, const CameraRecord& camera)
    : camera_(camera), camera_rays_(Program(device, "camera_rays.cl").kernel("camera_rays")) {}

void CameraView::make_rays(const CameraRecord& camera, const Arguments& pass, const Buffer<Ray>& rays) {
    if (rays.size() < ray_count()) throw RunError("camera: fewer rays than pixels");
    camera_rays_.launch(ray_count(), pass, Arguments("camera", camera).add("rays", rays));
}

}  // namespace stokes
