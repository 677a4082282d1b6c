#include <algorithm>
#include <cmath>
#include <limits>

#include "host/core/srgb.hpp"
#include "host/image/colour.hpp"
#include "host/image/develop.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;

namespace {

void set_xyz(FilmImage& film, std::size_t pixel, const glm::dvec3& xyz, Layer component = Layer::surface) {
    for (int c = 0; c < 3; ++c)
        film.xyz[static_cast<std::size_t>(component)][3 * pixel + static_cast<std::size_t>(c)] =
            static_cast<float>(xyz[c]);
}

FilmImage uniform(const glm::dvec3& rgb) {
    FilmImage film(8, 8);
    for (std::size_t i = 0; i < film.pixels(); ++i) set_xyz(film, i, xyz_of_rec709(rgb));
    return film;
}

// A ramp of greys from 1/400 to 1 with a few colours in it, times scale.
FilmImage ramp(double scale) {
    FilmImage film(40, 10);
    for (std::size_t i = 0; i < film.pixels(); ++i)
        set_xyz(film, i, xyz_of_rec709(glm::dvec3(1.0, 0.5, 0.2) * static_cast<double>(i + 1) * scale / 400.0));
    return film;
}

glm::ivec3 byte_pixel(const Rgb8& image, std::size_t pixel) {
    return {image.rgb[3 * pixel], image.rgb[3 * pixel + 1], image.rgb[3 * pixel + 2]};
}

// Bytes follow from the header of develop.hpp and the sRGB function.
int byte_of(double linear) { return static_cast<int>(std::lround(255.0 * srgb_encode(linear))); }

double hue_deg(const glm::dvec3& rgb) {
    const glm::dvec3 lab = oklab_of_rec709(rgb);
    return glm::degrees(std::atan2(lab.z, lab.y));
}

glm::dvec3 decoded(const Rgb8& image, std::size_t pixel) {
    const glm::ivec3 byte = byte_pixel(image, pixel);
    return {srgb_decode(byte.r / 255.0), srgb_decode(byte.g / 255.0), srgb_decode(byte.b / 255.0)};
}

}  // namespace

TEST_CASE("colours below the shoulder are encoded as they are") {
    const Rgb8 image = develop(uniform({0.5, 0.25, 0.1}), 0.0);
    CHECK(byte_pixel(image, 5) == glm::ivec3(byte_of(0.5), byte_of(0.25), byte_of(0.1)));
    const Rgb8 brighter = develop(uniform({0.05, 0.025, 0.01}), std::log2(10.0));
    CHECK(brighter.rgb == image.rgb);
}

TEST_CASE("components add up in the developed picture") {
    FilmImage film(1, 1);
    set_xyz(film, 0, xyz_of_rec709({0.1, 0.1, 0.1}), Layer::fluorescence);
    set_xyz(film, 0, xyz_of_rec709({0.1, 0.1, 0.1}), Layer::single);
    set_xyz(film, 0, xyz_of_rec709({0.1, 0.1, 0.1}), Layer::multiple);
    set_xyz(film, 0, xyz_of_rec709({0.1, 0.1, 0.1}), Layer::surface);
    CHECK(byte_pixel(develop(film, 0.0), 0) == glm::ivec3(byte_of(0.4)));
}

TEST_CASE("highlights approach white without a step and without a shift of hue") {
    int previous = 0;
    for (double value = 0.6; value < 3.0; value += 0.005) {
        const int byte = byte_pixel(develop(uniform(glm::dvec3(value)), 0.0), 0).r;
        CHECK(byte >= previous);
        CHECK(byte - previous <= (previous == 0 ? 255 : 1));
        previous = byte;
    }
    CHECK(previous == 255);
    CHECK(byte_pixel(develop(uniform(glm::dvec3(1.0)), 0.0), 0).r == byte_of(1.0 - 0.2 * std::exp(-1.0)));
    const glm::dvec3 orange = decoded(develop(uniform({8.0, 4.0, 0.8}), 0.0), 0);
    CHECK(orange.g / orange.r == Approx(0.5).margin(0.01));
    CHECK(orange.b / orange.r == Approx(0.1).margin(0.01));
}

// Quantum dots emit in lines some 30 nm wide: near the spectral locus, outside Rec. 709; 405 nm is the lamp's
// line.
TEST_CASE("colours outside the gamut keep hue and lightness and reach its edge") {
    for (const double peak : {405.0, 450.0, 525.0, 545.0, 585.0, 655.0}) {
        Spectrum emission;
        for (int lambda = 360; lambda <= 780; ++lambda) {
            emission.lambda_nm.push_back(lambda);
            emission.value.push_back(std::exp(-std::pow((lambda - peak) / 13.0, 2.0)));
        }
        const glm::dvec3 spectral = rec709_of_xyz(xyz_of(emission));
        const glm::dvec3 rgb = spectral * (0.5 / std::max({spectral.r, spectral.g, spectral.b}));
        REQUIRE(std::min({rgb.r, rgb.g, rgb.b}) < 0.0);
        FilmImage film(1, 1);
        set_xyz(film, 0, xyz_of_rec709(rgb));
        const glm::dvec3 shown = decoded(develop(film, 0.0), 0);
        CAPTURE(peak, rgb.r, rgb.g, rgb.b, shown.r, shown.g, shown.b);
        CHECK(std::min({shown.r, shown.g, shown.b}) == 0.0);
        CHECK(hue_deg(shown) == Approx(hue_deg(rgb)).margin(1.0));
        CHECK(oklab_of_rec709(shown).x == Approx(oklab_of_rec709(rgb).x).epsilon(0.01));
    }
}

TEST_CASE("every exposure has a picture") {
    const double infinity = std::numeric_limits<double>::infinity();
    const FilmImage grey = uniform({0.5, 0.5, 0.5});
    CHECK(byte_pixel(develop(grey, infinity), 0) == glm::ivec3(255));
    CHECK(byte_pixel(develop(grey, 1e308), 0) == glm::ivec3(255));
    CHECK(byte_pixel(develop(grey, -infinity), 0) == glm::ivec3(0));
    CHECK(byte_pixel(develop(grey, -1e308), 0) == glm::ivec3(0));
    CHECK(byte_pixel(develop(grey, std::numeric_limits<double>::quiet_NaN()), 0) == glm::ivec3(0));
}

TEST_CASE("automatic exposure follows the scale of the film") {
    const double ev = automatic_exposure_ev(ramp(1.0));
    CHECK(automatic_exposure_ev(ramp(2.0)) == Approx(ev - 1.0).margin(1e-9));
    CHECK(automatic_exposure_ev(ramp(1024.0)) == Approx(ev - 10.0).margin(1e-9));
    CHECK(automatic_exposure_ev(ramp(1.0e-6)) == Approx(ev - std::log2(1.0e-6)).margin(1e-5));
    CHECK(develop(ramp(1.0), ev).rgb == develop(ramp(2.0), ev - 1.0).rgb);
}

TEST_CASE("automatic exposure puts a uniform picture where the shoulder begins") {
    CHECK(automatic_exposure_ev(uniform({0.2, 0.1, 0.05})) == Approx(2.0).margin(1e-5));
}

TEST_CASE("neither a dark surround nor stray bright pixels change the exposure") {
    FilmImage film(100, 100);
    const glm::dvec3 object = xyz_of_rec709({0.1, 0.8, 0.1});
    for (std::size_t i = 0; i < film.pixels(); ++i) set_xyz(film, i, i < 2500 ? object : object * 1e-4);
    CHECK(automatic_exposure_ev(film) == Approx(0.0).margin(1e-5));
    for (std::size_t i = 4000; i < 4020; ++i) set_xyz(film, i, object * 1e5);
    CHECK(automatic_exposure_ev(film) == Approx(0.0).margin(1e-5));
}

TEST_CASE("a black film is black at exposure 0") {
    const FilmImage film(3, 2);
    CHECK(automatic_exposure_ev(film) == 0.0);
    CHECK(develop(film, 20.0).rgb == std::vector<std::uint8_t>(18, 0));
    CHECK(automatic_exposure_ev(FilmImage()) == 0.0);
}

TEST_CASE("non-finite and negative pixels become black and only the former are counted") {
    FilmImage film = uniform(glm::dvec3(0.8));
    set_xyz(film, 3, {std::numeric_limits<double>::quiet_NaN(), 1.0, 1.0});
    set_xyz(film, 4, {1.0, std::numeric_limits<double>::infinity(), 1.0}, Layer::single);
    set_xyz(film, 5, {-1.0, -1.0, -1.0});
    CHECK(count_non_finite(film) == 2);
    CHECK(automatic_exposure_ev(film) == Approx(0.0).margin(1e-5));
    const Rgb8 image = develop(film, 0.0);
    for (const std::size_t pixel : {3, 4, 5}) CHECK(byte_pixel(image, pixel) == glm::ivec3(0));
    CHECK(byte_pixel(image, 6) == glm::ivec3(byte_of(0.8)));
}

TEST_CASE("extreme exposures neither overflow nor wrap around") {
    const FilmImage film = uniform({0.5, 0.25, 0.0});
    CHECK(byte_pixel(develop(film, 5000.0), 0) == glm::ivec3(255, byte_of(0.5), 0));
    CHECK(byte_pixel(develop(film, -5000.0), 0) == glm::ivec3(0));
    CHECK(byte_pixel(develop(uniform(glm::dvec3(1e37)), 0.0), 0) == glm::ivec3(255));
}
