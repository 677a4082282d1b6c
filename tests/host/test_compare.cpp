#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "host/core/error.hpp"
#include "host/core/srgb.hpp"
#include "host/image/colour.hpp"
#include "host/image/compare.hpp"
#include "host/image/error_map.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;

namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();

// Rec. 709 as a file holds it.
std::vector<float> rgb_of(const std::vector<glm::dvec3>& xyz) {
    std::vector<float> rgb;
    for (const glm::dvec3& colour : xyz) {
        const glm::dvec3 v = rec709_of_xyz(colour);
        rgb.insert(rgb.end(), {static_cast<float>(v.r), static_cast<float>(v.g), static_cast<float>(v.b)});
    }
    return rgb;
}

const std::vector<glm::dvec3> reference_xyz = {{1, 2, 3}, {0, 0, 0}, {4, 4, 4}, {2, 0, 1}};
const std::vector<glm::dvec3> errors_xyz = {{0.5, 0, 0}, {0, -1, 0}, {0, 0, 2}, {0, 0, 0}};

std::vector<float> picture() {
    std::vector<glm::dvec3> xyz = reference_xyz;
    for (std::size_t i = 0; i < xyz.size(); ++i) xyz[i] += errors_xyz[i];
    return rgb_of(xyz);
}

double lightness(const std::array<std::uint8_t, 3>& srgb) {
    glm::dvec3 linear;
    for (int c = 0; c < 3; ++c) linear[c] = srgb_decode(srgb[static_cast<std::size_t>(c)] / 255.0);
    return oklab_of_rec709(linear).x;
}

}  // namespace

// Squares 0.25, 1, 4 and sum of errors 1.5 over 12 values; |reference| adds up to 21, its largest is 4.
TEST_CASE("errors of a picture of four pixels are those of the hand", "[compare]") {
    const LayerError e = compare_layer(picture(), rgb_of(reference_xyz), 2);
    CHECK(e.rmse == Approx(std::sqrt(5.25 / 12.0)).epsilon(1e-6));
    CHECK(e.reference_mean == Approx(1.75).epsilon(1e-6));
    CHECK(e.relative_rmse == Approx(std::sqrt(5.25 / 12.0) / 1.75).epsilon(1e-6));
    CHECK(e.peak == Approx(4.0).epsilon(1e-6));
    CHECK(e.psnr_db == Approx(10.0 * std::log10(16.0 * 12.0 / 5.25)).epsilon(1e-6));
    CHECK(e.mean_error == Approx(0.125).epsilon(1e-5));
    CHECK(e.max_error == Approx(2.0).epsilon(1e-6));
    CHECK(e.max_x == 0);
    CHECK(e.max_y == 1);
    CHECK(e.max_channel == 2);
    CHECK(e.compared == 4);
    CHECK(e.not_finite + e.reference_not_finite == 0);
    for (std::size_t c = 0; c < 3; ++c) {
        CHECK(e.rmse_xyz[c] == Approx(std::vector<double>{0.25, 0.5, 1.0}[c]).epsilon(1e-6));
        CHECK(e.mean_error_xyz[c] == Approx(std::vector<double>{0.125, -0.25, 0.5}[c]).epsilon(1e-6));
    }
}

// Over values -3, 1, 2 an error of 1 in each.
TEST_CASE("negative values of a reference count by their size", "[compare]") {
    const LayerError e = compare_layer(rgb_of({{-2, 2, 3}}), rgb_of({{-3, 1, 2}}), 1);
    CHECK(e.reference_mean == Approx(2.0).epsilon(1e-6));
    CHECK(e.relative_rmse == Approx(0.5).epsilon(1e-6));
    CHECK(e.peak == Approx(2.0).epsilon(1e-6));
}

TEST_CASE("the bias changes its sign with the sides, the rest of the error does not", "[compare]") {
    const LayerError e = compare_layer(picture(), rgb_of(reference_xyz), 2);
    const LayerError back = compare_layer(rgb_of(reference_xyz), picture(), 2);
    CHECK(back.mean_error == -e.mean_error);
    CHECK(back.rmse == e.rmse);
    CHECK(back.max_error == e.max_error);
    CHECK(back.reference_mean != e.reference_mean);
}

TEST_CASE("the same picture has no error, black or not", "[compare]") {
    for (const std::vector<float>& same : {picture(), std::vector<float>(12, 0.0f)}) {
        const LayerError e = compare_layer(same, same, 2);
        CHECK(e.rmse == 0.0);
        CHECK(e.relative_rmse == 0.0);
        CHECK(e.psnr_db == std::numeric_limits<double>::infinity());
        CHECK(e.mean_error == 0.0);
        CHECK(e.max_error == 0.0);
        CHECK(e.max_x + e.max_y == 0);
    }
}

TEST_CASE("light where the reference is black is an error beyond every share", "[compare]") {
    const LayerError e = compare_layer(picture(), std::vector<float>(12, 0.0f), 2);
    CHECK(e.rmse > 0.0);
    CHECK(e.relative_rmse == std::numeric_limits<double>::infinity());
    CHECK(std::isnan(e.psnr_db));
}

// Without the third pixel: squares 0.25 and 1 over 9 values, |reference| 9.
TEST_CASE("pixels that are not finite are counted and left out", "[compare]") {
    for (const float bad : {not_a_number, infinite, -infinite}) {
        std::vector<float> spoilt = picture(), reference = rgb_of(reference_xyz);
        spoilt[2 * 3 + 1] = bad;
        LayerError e = compare_layer(spoilt, reference, 2);
        CHECK(e.rmse == Approx(std::sqrt(1.25 / 9.0)).epsilon(1e-6));
        CHECK(e.reference_mean == Approx(1.0).epsilon(1e-6));
        CHECK(e.max_error == Approx(1.0).epsilon(1e-6));
        CHECK(e.max_x == 1);
        CHECK(e.max_y == 0);
        CHECK(e.compared == 3);
        CHECK(e.not_finite == 1);
        CHECK(e.reference_not_finite == 0);
        reference[2 * 3] = bad;
        reference[3 * 3 + 2] = bad;
        e = compare_layer(spoilt, reference, 2);
        CHECK(e.compared == 2);
        CHECK(e.not_finite == 1);
        CHECK(e.reference_not_finite == 2);
    }
    const LayerError none = compare_layer(std::vector<float>(12, not_a_number), rgb_of(reference_xyz), 2);
    CHECK(none.compared == 0);
    CHECK(none.not_finite == 4);
    for (const double figure : {none.rmse, none.relative_rmse, none.psnr_db, none.mean_error, none.max_error})
        CHECK(std::isnan(figure));
}

TEST_CASE("the root mean square of the pixels' errors is that of the picture", "[compare]") {
    std::vector<float> spoilt = picture();
    std::vector<double> errors = pixel_errors(spoilt, rgb_of(reference_xyz));
    REQUIRE(errors.size() == 4);
    for (std::size_t i = 0; i < 4; ++i)
        CHECK(errors[i] == Approx(glm::length(errors_xyz[i]) / std::sqrt(3.0)).epsilon(1e-6).margin(1e-6));
    spoilt[4] = not_a_number;
    errors = pixel_errors(spoilt, rgb_of(reference_xyz));
    CHECK(std::isnan(errors[1]));
    double squares = 0.0;
    for (const std::size_t i : {0u, 2u, 3u}) squares += errors[i] * errors[i];
    CHECK(std::sqrt(squares / 3.0) == Approx(compare_layer(spoilt, rgb_of(reference_xyz), 2).rmse).epsilon(1e-12));
}

TEST_CASE("pictures of different sizes are not compared", "[compare]") {
    CHECK_THROWS_AS(compare_layer(picture(), std::vector<float>(9), 2), RunError);
    CHECK_THROWS_AS(pixel_errors(picture(), std::vector<float>(9)), RunError);
}

TEST_CASE("layers come whole first, then as the renderer has them, then by name", "[compare]") {
    RgbLayers layers;
    for (const char* name : {"alpha", "surface", "", "zeta", "single", "fluorescence"}) layers[name] = {};
    CHECK(layers_in_order(layers) ==
          std::vector<std::string>{"", "fluorescence", "single", "surface", "alpha", "zeta"});
    CHECK(shown_layer("") == "whole");
    CHECK(shown_layer("single") == "single");
}

// 8 bits are steps of 1/255 in sRGB, in Oklab lightness up to 0.07 near black and 0.004 above 0.2.
TEST_CASE("the colours of the error map grow evenly in lightness from black to white", "[compare]") {
    CHECK(scale_colour(0.0) == std::array<std::uint8_t, 3>{0, 0, 0});
    double before = -1.0;
    for (int i = 0; i <= 64; ++i) {
        const double t = i / 64.0, here = lightness(scale_colour(t));
        CAPTURE(t);
        CHECK(here == Approx(0.97 * t).margin(t < 0.25 ? 0.07 : 0.005));
        CHECK(here >= before);
        CHECK(scale_colour(t) != no_number_colour);
        before = here;
    }
}

TEST_CASE("the error map draws no error black, no number green, and ends where it says", "[compare]") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const ErrorMap map = draw_errors({0.0, 1.0, 2.0, 3.0, nan, 0.5}, 3, 2.0);
    CHECK(map.image.width == 3);
    CHECK(map.image.height == 2);
    CHECK(map.largest_shown == 2.0);
    CHECK(map.above == 1);
    CHECK(map.not_finite == 1);
    const auto colour = [&](std::size_t i) {
        return std::array<std::uint8_t, 3>{map.image.rgb[3 * i], map.image.rgb[3 * i + 1], map.image.rgb[3 * i + 2]};
    };
    CHECK(colour(0) == scale_colour(0.0));
    CHECK(colour(1) == scale_colour(128.0 / 255.0));
    CHECK(colour(2) == scale_colour(1.0));
    CHECK(colour(3) == scale_colour(1.0));
    CHECK(colour(4) == no_number_colour);
    CHECK(colour(5) == scale_colour(64.0 / 255.0));
}

TEST_CASE("the error map's scale ends at the 99th percentile, or where there is an error at all", "[compare]") {
    std::vector<double> errors;
    for (int i = 0; i <= 1000; ++i) errors.push_back(0.01234 * i);
    const ErrorMap map = draw_errors(errors, 1001, {});
    CHECK(map.largest_shown == Approx(13.0));  // 990 * 0.01234 = 12.2, to two digits upwards
    CHECK(map.above == 0);
    std::vector<double> one(1000, 0.0);
    one[7] = 0.0042;
    CHECK(draw_errors(one, 1000, {}).largest_shown == Approx(0.0042));
    CHECK(draw_errors(std::vector<double>(4, 0.0), 2, {}).largest_shown == 1.0);
    CHECK(draw_errors(std::vector<double>(4, std::nan("")), 2, {}).not_finite == 4);
}
