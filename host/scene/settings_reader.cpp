#include "host/scene/settings_reader.hpp"

#include <fmt/format.h>

#include <limits>

#include "host/scene/scene_keys.hpp"

namespace stokes {
namespace {

// One pass draws this many wavelengths without replacement.
constexpr int wavelengths_per_pass = 16;

}  // namespace

RenderSettings read_render_settings(const JsonCursor& render) {
    render.expect_keys(keys::render);
    RenderSettings s;
    s.passes = static_cast<int>(render.integer_or("passes", s.passes, 1, 100'000'000));
    s.photons_per_pass = render.integer_or("photons_per_pass", s.photons_per_pass, 1, most_photons_per_pass);
    s.alpha = render.number_or("alpha", s.alpha, {0.0, 1.0, true});
    if (const auto radius = render.find("radius_mm")) s.radius_mm = radius->number(length_range);
    s.seed =
        static_cast<std::uint32_t>(render.integer_or("seed", s.seed, 0, std::numeric_limits<std::uint32_t>::max()));
    s.lambda_min_nm =
        static_cast<int>(render.integer_or("lambda_min_nm", s.lambda_min_nm, first_lambda_nm, last_lambda_nm));
    s.lambda_max_nm =
        static_cast<int>(render.integer_or("lambda_max_nm", s.lambda_max_nm, first_lambda_nm, last_lambda_nm));
    if (const auto sampling = render.find("sampling"))
        s.sampling = static_cast<Sampling>(sampling->choice(sampling_words));
    if (const auto wavelengths = render.find("wavelengths"))
        s.wavelengths = static_cast<Wavelengths>(wavelengths->choice(wavelengths_words));
    if (const auto branches = render.find("branches"))
        s.branches = static_cast<Branches>(branches->choice(branches_words));
    if (const auto emission = render.find("emission"))
        s.emission = static_cast<Emission>(emission->choice(emission_words));
    if (const auto direct = render.find("direct")) s.direct = static_cast<Direct>(direct->choice(direct_words));
    if (const auto radii = render.find("radii")) s.radii = static_cast<Radii>(radii->choice(radii_words));
    if (const auto distances = render.find("distances"))
        s.distances = static_cast<Distances>(distances->choice(distances_words));
    if (const auto exits = render.find("exits")) s.exits = static_cast<int>(exits->integer(1, most_exits));
    if (s.lambda_max_nm - s.lambda_min_nm + 1 < wavelengths_per_pass) {
        render.fail(
            fmt::format("expected at least {} whole wavelengths from lambda_min_nm to lambda_max_nm, got {} to {}",
                        wavelengths_per_pass, s.lambda_min_nm, s.lambda_max_nm));
    }
    return s;
}

Film read_film(const JsonCursor& film) {
    film.expect_keys(keys::film);
    Film result;
    result.width = static_cast<int>(film.integer_or("width", result.width, 1, 16384));
    result.height = static_cast<int>(film.integer_or("height", result.height, 1, 16384));
    const auto exposure = film.find("exposure_ev");
    if (!exposure) return result;
    if (exposure->is(JsonValue::Type::string)) {
        exposure->choice({"auto"});
    } else {
        result.exposure_ev = exposure->number({-100.0, 100.0});
    }
    return result;
}

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
