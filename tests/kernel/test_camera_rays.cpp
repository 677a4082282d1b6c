#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

#include "host/render/camera_view.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

struct alignas(8) Uint2 {
    std::uint32_t x, y;
};

std::vector<Uint2> pixels_of_rays(std::uint32_t width, std::uint32_t height) {
    const Buffer<Uint2> pixels(test_device(), "pixels", std::size_t{width} * height);
    test_program("tiles.cl")
        .kernel("pixels_of_rays")
        .launch(pixels.size(), Arguments().add("width", width).add("height", height).add("pixels", pixels, "uint2"));
    return pixels.download();
}

Camera test_camera() {
    Camera camera;
    camera.position_mm = {10.0, 20.0, -5.0};
    camera.target_mm = {-4.0, 3.0, 30.0};
    camera.up = {0.1, 1.0, 0.0};
    camera.vertical_fov_deg = 50.0;
    return camera;
}

std::vector<Ray> rays_of_pass(const CameraRecord& record, std::uint32_t pass_index, bool even = true) {
    CameraView view(test_device(), record);
    PassConstants pass{};
    pass.seed = 11;
    pass.pass = pass_index;
    pass.low_discrepancy_pixels = even ? 1 : 0;
    const Buffer<PassConstants> constants(test_device(), "pass", std::vector<PassConstants>{pass});
    const Buffer<Ray> rays(test_device(), "rays", view.ray_count());
    view.make_rays(Arguments("pass", constants), rays);
    return rays.download();
}

// Where a ray crosses the film, in pixels from the top left corner, by plain projection.
glm::dvec2 film_point(const Camera& camera, int width, int height, const Ray& ray) {
    const glm::dvec3 forward = glm::normalize(camera.target_mm - camera.position_mm);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
    const glm::dvec3 d(ray.dx, ray.dy, ray.dz);
    const double scale = 0.5 * height / std::tan(glm::radians(0.5 * camera.vertical_fov_deg)) / glm::dot(d, forward);
    return {0.5 * width + glm::dot(d, right) * scale, 0.5 * height - glm::dot(d, up) * scale};
}

// Where in its pixel each ray goes through, by index of pixel.
std::vector<glm::dvec2> places_in_pixels(int width, int height, std::uint32_t pass_index, bool even) {
    Camera camera = test_camera();
    const std::vector<Ray> rays = rays_of_pass(make_camera_record(camera, width, height), pass_index, even);
    const std::vector<Uint2> pixels = pixels_of_rays(width, height);
    std::vector<glm::dvec2> places(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        places[pixels[i].y * width + pixels[i].x] =
            film_point(camera, width, height, rays[i]) - glm::dvec2(pixels[i].x, pixels[i].y);
    return places;
}

}  // namespace

TEST_CASE("tiles hand every pixel to exactly one ray", "[camera][tiny]") {
    const Uint2 sizes[] = {{1, 1}, {7, 3}, {8, 8}, {17, 9}, {13, 64}, {1, 30}, {30, 1}, {65, 41}};
    for (const Uint2 size : sizes) {
        std::vector<int> seen(size.x * size.y, 0);
        for (const Uint2 pixel : pixels_of_rays(size.x, size.y)) {
            REQUIRE(pixel.x < size.x);
            REQUIRE(pixel.y < size.y);
            ++seen[pixel.y * size.x + pixel.x];
        }
        CHECK(seen == std::vector<int>(seen.size(), 1));
    }
}

TEST_CASE("64 rays in a row see a tile of 8 x 8 pixels", "[camera][tiny]") {
    const std::vector<Uint2> pixels = pixels_of_rays(40, 19);
    for (std::uint32_t i = 0; i < 40 * 16; ++i) {
        CHECK(pixels[i].x / 8 == i / 64 % 5);
        CHECK(pixels[i].y / 8 == i / 64 / 5);
    }
}

// Rays are single precision: a direction is right to 1e-7, a film point to 1e-4 of a pixel here.
TEST_CASE("each ray has unit length and goes through its own pixel", "[camera][tiny]") {
    const int width = 37, height = 21;
    const Camera camera = test_camera();
    const std::vector<Ray> rays = rays_of_pass(make_camera_record(camera, width, height), 0);
    const std::vector<Uint2> pixels = pixels_of_rays(width, height);
    double mean_x = 0.0, mean_y = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Ray& ray = rays[i];
        REQUIRE(ray.ox == 10.0f);
        REQUIRE(ray.oy == 20.0f);
        REQUIRE(ray.oz == -5.0f);
        REQUIRE(ray.t_min == 0.0f);
        REQUIRE(ray.t_max == std::numeric_limits<float>::infinity());
        REQUIRE(glm::length(glm::dvec3(ray.dx, ray.dy, ray.dz)) == Approx(1.0).epsilon(1e-6));
        const glm::dvec2 offset = film_point(camera, width, height, ray) - glm::dvec2(pixels[i].x, pixels[i].y);
        REQUIRE(offset.x > -1e-4);
        REQUIRE(offset.x < 1.0 + 1e-4);
        REQUIRE(offset.y > -1e-4);
        REQUIRE(offset.y < 1.0 + 1e-4);
        mean_x += offset.x / static_cast<double>(rays.size());
        mean_y += offset.y / static_cast<double>(rays.size());
    }
    // The mean of 777 uniforms is 0.5 with a standard error of 0.0104; four of them either side.
    CHECK(std::abs(mean_x - 0.5) < 0.042);
    CHECK(std::abs(mean_y - 0.5) < 0.042);
}

// 64 passes, from a multiple of 64 on: of each division of a pixel into 64 rectangles by halves, each rectangle has a
// ray. Rays are single precision: within 1e-4 of a pixel.
TEST_CASE("over passes a pixel's area is covered evenly", "[camera]") {
    const int width = 9, height = 7;
    for (const std::uint32_t first : {0u, 128u, 0xffffffc0u}) {
        std::vector<std::vector<glm::dvec2>> places;
        for (std::uint32_t i = 0; i < 64; ++i) places.push_back(places_in_pixels(width, height, first + i, true));
        for (const double columns : {1.0, 4.0, 8.0, 16.0, 64.0}) {
            const glm::dvec2 cells(columns, 64.0 / columns), slack = 1e-4 * cells;
            int empty = 0;
            for (std::size_t pixel = 0; pixel < places[0].size(); ++pixel) {
                std::map<std::pair<int, int>, int> rays;  // by cell; beside an edge, in those on both sides
                for (const std::vector<glm::dvec2>& of_pass : places) {
                    const glm::dvec2 at = of_pass[pixel] * cells, low = glm::floor(at - slack),
                                     high = glm::floor(at + slack);
                    for (double x = low.x; x <= high.x; ++x)
                        for (double y = low.y; y <= high.y; ++y) ++rays[{static_cast<int>(x), static_cast<int>(y)}];
                }
                for (int x = 0; x < static_cast<int>(cells.x); ++x)
                    for (int y = 0; y < static_cast<int>(cells.y); ++y) empty += rays.count({x, y}) == 0;
            }
            CHECK(empty == 0);
        }
    }
}

// All passes together are wrong once in 1000.
TEST_CASE("places in pixels are uniform over pixels", "[camera]") {
    for (const std::uint32_t pass : {0u, 1u, 63u, 0xffffffffu}) {
        std::vector<double> counts(256, 0.0);
        for (const glm::dvec2& place : places_in_pixels(160, 120, pass, true)) {
            const glm::dvec2 cell = glm::clamp(glm::floor(place * 16.0), 0.0, 15.0);
            counts[static_cast<std::size_t>(cell.y * 16.0 + cell.x)] += 1.0;
        }
        CHECK(chi_square_uniform(counts) > sidak_level(1e-3, 4));
    }
}

// Domain 5, the camera's: the first two of each pixel's four numbers.
TEST_CASE("plain places are independent random numbers", "[camera][tiny]") {
    const int width = 9, height = 7;
    const std::uint32_t n = width * height;
    const Buffer<float> buffer(test_device(), "uniforms", n * 4);
    test_program("rng.cl")
        .kernel("uniforms")
        .launch(n, Arguments().add("seed", 11u).add("pass", 3u).add("dimension", 5u).add("out", buffer).add("n", n));
    const std::vector<float> uniforms = buffer.download();
    const std::vector<glm::dvec2> places = places_in_pixels(width, height, 3, false);
    for (std::size_t pixel = 0; pixel < n; ++pixel) {
        CHECK(places[pixel].x == Approx(uniforms[pixel * 4]).margin(1e-4));
        CHECK(places[pixel].y == Approx(uniforms[pixel * 4 + 1]).margin(1e-4));
    }
}

TEST_CASE("passes jitter differently", "[camera][tiny]") {
    const CameraRecord record = make_camera_record(test_camera(), 5, 4);
    const std::vector<Ray> first = rays_of_pass(record, 0), second = rays_of_pass(record, 1);
    for (std::size_t i = 0; i < first.size(); ++i) CHECK(first[i].dx != second[i].dx);
}

// 90 degrees: the middles of the top and bottom edges lie 45 degrees off the axis.
TEST_CASE("the field of view spans the height of the picture", "[camera]") {
    Camera camera;
    camera.position_mm = {0.0, 0.0, 0.0};
    camera.target_mm = {0.0, 0.0, -7.0};
    camera.up = {0.0, 3.0, 0.0};
    camera.vertical_fov_deg = 90.0;
    const CameraRecord record = make_camera_record(camera, 400, 200);
    CHECK(record.corner_x == Approx(-2.0));
    CHECK(record.corner_y == Approx(1.0));
    CHECK(record.corner_z == Approx(-1.0));
    CHECK(record.corner_x + 400 * record.right_x == Approx(2.0));
    CHECK(record.corner_y + 200 * record.down_y == Approx(-1.0));
}

// The whole picture has 80 x 60 pixels, the crop 24 x 9 of them from (20, 30).
TEST_CASE("the rays of a crop are those of its part of the whole picture", "[camera][tiny]") {
    const Camera whole = test_camera();
    Camera cropped = whole;
    cropped.crop = {20.0 / 80.0, 30.0 / 60.0, 24.0 / 80.0, 9.0 / 60.0};
    const CameraRecord full = make_camera_record(whole, 80, 60), part = make_camera_record(cropped, 24, 9);
    CHECK(part.width == 24);
    CHECK(part.height == 9);
    for (int x : {0, 11, 24})
        for (int y : {0, 5, 9}) {
            const auto direction = [](const CameraRecord& c, int column, int row) {
                const double i = column, j = row;
                return glm::dvec3(c.corner_x + i * c.right_x + j * c.down_x, c.corner_y + i * c.right_y + j * c.down_y,
                                  c.corner_z + i * c.right_z + j * c.down_z);
            };
            CHECK(glm::length(direction(part, x, y) - direction(full, x + 20, y + 30)) < 1e-6);
        }
    const std::vector<Ray> rays = rays_of_pass(part, 3);
    const std::vector<Uint2> pixels = pixels_of_rays(24, 9);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const glm::dvec2 offset =
            film_point(whole, 80, 60, rays[i]) - glm::dvec2(pixels[i].x + 20.0, pixels[i].y + 30.0);
        REQUIRE(offset.x > -1e-4);
        REQUIRE(offset.x < 1.0 + 1e-4);
        REQUIRE(offset.y > -1e-4);
        REQUIRE(offset.y < 1.0 + 1e-4);
    }
}

// Of a picture of 1600 x 400 pixels a window of 40 x 20: each pixel is one of that picture, and square.
TEST_CASE("a crop has square pixels, as many as the film, in a whole picture of their own number", "[camera]") {
    Camera camera = test_camera();
    camera.crop = {0.5, 0.9, 0.025, 0.05};
    const CameraRecord record = make_camera_record(camera, 40, 20);
    const double pixel = 2.0 * std::tan(glm::radians(25.0)) / 400.0;
    const glm::dvec3 right(record.right_x, record.right_y, record.right_z);
    const glm::dvec3 down(record.down_x, record.down_y, record.down_z);
    CHECK(glm::length(right) == Approx(pixel).epsilon(1e-5));
    CHECK(glm::length(down) == Approx(pixel).epsilon(1e-5));
    Ray first{};
    first.dx = record.corner_x;
    first.dy = record.corner_y;
    first.dz = record.corner_z;
    const glm::dvec2 corner = film_point(camera, 1600, 400, first);
    CHECK(corner.x == Approx(800.0).margin(1e-3));
    CHECK(corner.y == Approx(360.0).margin(1e-3));
}

TEST_CASE("the whole picture around a crop has the film's pixels and the crop's proportions", "[camera]") {
    Camera camera = test_camera();
    const CameraRecord plain = make_camera_record(camera, 80, 60);
    camera.crop = {0.3, 0.1, 0.25, 0.25};
    const CameraRecord whole = make_whole_record(camera, 80, 60);
    CHECK(std::memcmp(&whole, &plain, sizeof plain) == 0);
    camera.crop = {0.3, 0.1, 0.5, 0.25};  // 160 x 240 pixels
    const CameraRecord narrow = make_whole_record(camera, 80, 60), tall = make_camera_record(test_camera(), 160, 240);
    CHECK(narrow.width == 80);
    CHECK(narrow.corner_x == Approx(tall.corner_x));
    CHECK(narrow.corner_y == Approx(tall.corner_y));
    CHECK(narrow.corner_z == Approx(tall.corner_z));
    CHECK(narrow.right_x == Approx(2.0 * tall.right_x));
    CHECK(narrow.down_y == Approx(4.0 * tall.down_y));
}

TEST_CASE("a camera that cannot look is refused", "[camera]") {
    Camera camera = test_camera();
    CHECK_THROWS_AS(make_camera_record(camera, 0, 10), InputError);
    CHECK_THROWS_AS(make_camera_record(camera, 65536, 65536), InputError);
    camera.up = camera.target_mm - camera.position_mm;
    CHECK_THROWS_AS(make_camera_record(camera, 10, 10), InputError);
    camera = test_camera();
    camera.target_mm = camera.position_mm;
    CHECK_THROWS_AS(make_camera_record(camera, 10, 10), InputError);
    camera = test_camera();
    camera.vertical_fov_deg = 180.0;
    CHECK_THROWS_AS(make_camera_record(camera, 10, 10), InputError);
    camera = test_camera();
    camera.crop.width = 0.0;
    CHECK_THROWS_AS(make_camera_record(camera, 10, 10), InputError);
}
