#include "host/scene/camera_reader.hpp"

#include <fmt/format.h>

namespace stokes {
namespace {

// Below this the pixels of a picture come close to the steps of single precision, in which rays are.
constexpr double smallest_crop = 1e-3;

Crop read_crop(const JsonCursor& crop) {
    crop.expect_keys(keys::crop);
    Crop result;
    result.left = crop.at("left").number({0.0, 1.0});
    result.top = crop.at("top").number({0.0, 1.0});
    result.width = crop.at("width").number({smallest_crop, 1.0});
    result.height = crop.at("height").number({smallest_crop, 1.0});
    const double slack = 1e-9;  // 0.7 + 0.3 may come out above 1
    if (result.left + result.width > 1.0 + slack)
        crop.fail(fmt::format("expected left + width up to 1, got {}", result.left + result.width));
    if (result.top + result.height > 1.0 + slack)
        crop.fail(fmt::format("expected top + height up to 1, got {}", result.top + result.height));
    return result;
}

}  // namespace

Camera read_camera(const JsonCursor& camera) {
    camera.expect_keys(keys::camera);
    Camera result;
    result.position_mm = camera.at("position_mm").vector();
    result.target_mm = camera.at("target_mm").vector();
    result.vertical_fov_deg = camera.number_or("vertical_fov_deg", result.vertical_fov_deg, {0.01, 179.0});
    if (const auto up = camera.find("up")) result.up = up->direction();
    if (const auto crop = camera.find("crop")) result.crop = read_crop(*crop);
    const glm::dvec3 view = result.target_mm - result.position_mm;
    if (glm::length(view) < 1e-6) camera.at("target_mm").fail("expected another place than position_mm");
    if (glm::length(glm::cross(glm::normalize(view), result.up)) < 1e-6) {
        camera.fail("expected up to point another way than the camera looks");
    }
    return result;
}

}  // namespace stokes
