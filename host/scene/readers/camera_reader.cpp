#include "host/scene/readers/camera_reader.hpp"

#include <fmt/format.h>

#include "host/scene/settings/object.hpp"

namespace stokes {
namespace {

Crop read_crop(const JsonCursor& where) {
    const ObjectReader crop(where, "crop");
    Crop result;
    result.left = crop.number("left");
    result.top = crop.number("top");
    result.width = crop.number("width");
    result.height = crop.number("height");
    const double slack = 1e-9;  // 0.7 + 0.3 may come out above 1
    if (result.left + result.width > 1.0 + slack)
        crop.fail(fmt::format("expected left + width up to 1, got {}", result.left + result.width));
    if (result.top + result.height > 1.0 + slack)
        crop.fail(fmt::format("expected top + height up to 1, got {}", result.top + result.height));
    return result;
}

}  // namespace

Camera read_camera(const JsonCursor& where) {
    const ObjectReader camera(where, "camera");
    Camera result;
    result.position_mm = camera.vector("position_mm");
    result.target_mm = camera.vector("target_mm");
    result.vertical_fov_deg = camera.number("vertical_fov_deg");
    if (camera.has("up")) result.up = camera.direction("up");
    if (const auto crop = camera.find("crop")) result.crop = read_crop(*crop);
    const glm::dvec3 view = result.target_mm - result.position_mm;
    if (glm::length(view) < 1e-6) camera.at("target_mm").fail("expected another place than position_mm");
    if (glm::length(glm::cross(glm::normalize(view), result.up)) < 1e-6) {
        camera.fail("expected up to point another way than the camera looks");
    }
    return result;
}

}  // namespace stokes
