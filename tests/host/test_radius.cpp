#include <cmath>

#include "host/core/error.hpp"
#include "host/render/camera_view.hpp"
#include "host/render/radius.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;

namespace {

constexpr double photons_per_disk = 20.0;  // as radius.hpp states

// A square of 20 mm in the plane z = 0.
Scene square_scene() {
    Scene scene;
    Shape shape;
    shape.mesh.positions_mm = {{-10, -10, 0}, {10, -10, 0}, {10, 10, 0}, {-10, 10, 0}};
    shape.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.shapes.push_back(shape);
    return scene;
}

// Each pixel's ray against the plane z = 0.
std::vector<GatherPoint> points_on_plane(const CameraRecord& c) {
    std::vector<GatherPoint> points;
    for (unsigned y = 0; y < c.height; ++y)
        for (unsigned x = 0; x < c.width; ++x) {
            const float fx = static_cast<float>(x) + 0.5f, fy = static_cast<float>(y) + 0.5f;
            const float dx = c.corner_x + fx * c.right_x + fy * c.down_x;
            const float dy = c.corner_y + fx * c.right_y + fy * c.down_y;
            const float dz = c.corner_z + fx * c.right_z + fy * c.down_z;
            const float t = -c.position_z / dz;
            GatherPoint p{};
            p.x = c.position_x + t * dx;
            p.y = c.position_y + t * dy;
            p.nz = 1.0f;
            p.pixel = y * c.width + x;
            p.maps = 1u << STOKES_MAP_SURFACE;
            points.push_back(p);
        }
    return points;
}

// Photons on a grid of that spacing over the square.
std::vector<PhotonHead> photon_grid(float spacing_mm) {
    std::vector<PhotonHead> photons;
    for (float x = -9.99f; x < 10.0f; x += spacing_mm)
        for (float y = -9.99f; y < 10.0f; y += spacing_mm) photons.push_back({x, y, 0.0f, 0u});
    return photons;
}

}  // namespace

TEST_CASE("the radius in closed form follows the recurrence of PPPM", "[radius]") {
    for (const double alpha : {0.5, 2.0 / 3.0, 0.9}) {
        double square = 1.7 * 1.7;
        for (std::uint32_t pass = 0; pass < 5000; ++pass) {
            REQUIRE(pass_radius_mm(1.7, alpha, pass) == Approx(std::sqrt(square)).epsilon(1e-10));
            const double i = pass + 1.0;
            square *= (i + alpha) / (i + 1.0);
        }
    }
}

TEST_CASE("the first pass has the first radius, and with alpha 1 every pass has", "[radius]") {
    CHECK(pass_radius_mm(0.3, 2.0 / 3.0, 0) == Approx(0.3).epsilon(1e-14));
    for (const std::uint32_t pass : {0u, 1u, 17u, 100000u})
        CHECK(pass_radius_mm(0.3, 1.0, pass) == Approx(0.3).epsilon(1e-9));
}

// Gamma(k + 1 + alpha) / Gamma(k + 2) -> k^(alpha - 1) for large k.
TEST_CASE("the radius shrinks as pass^((alpha - 1) / 2)", "[radius]") {
    const double ratio = pass_radius_mm(1.0, 2.0 / 3.0, 4000000000u) / pass_radius_mm(1.0, 2.0 / 3.0, 4000000u);
    CHECK(ratio == Approx(std::pow(1000.0, -1.0 / 6.0)).epsilon(1e-5));
}

// 400 mm^2, 1000 photons: each takes 0.4 mm^2.
TEST_CASE("without photons in view the radius spreads a pass over the scene's surface", "[radius]") {
    const Scene scene = square_scene();
    CHECK(spread_radius_mm(scene, 1000) == Approx(std::sqrt(photons_per_disk * 0.4 / M_PI)).epsilon(1e-6));
    CHECK(spread_radius_mm(scene, 4000) == Approx(0.5 * spread_radius_mm(scene, 1000)).epsilon(1e-12));

    Scene with_light = scene;  // emitters keep no photons
    with_light.shapes.push_back(scene.shapes.front());
    with_light.shapes.back().light = 0;
    CHECK(spread_radius_mm(with_light, 1000) == Approx(spread_radius_mm(scene, 1000)).epsilon(1e-12));

    Scene layered = scene;  // a hundred squares within a sphere of 200 mm^2 pi
    for (int i = 0; i < 99; ++i) layered.shapes.push_back(scene.shapes.front());
    CHECK(spread_radius_mm(layered, 1000) == Approx(std::sqrt(photons_per_disk * 4.0 * 200.0 / 1000.0)).epsilon(1e-6));
}

TEST_CASE("a scene without surfaces has no radius", "[radius]") {
    CHECK_THROWS_AS(spread_radius_mm(Scene{}, 1000), RunError);
}

// Photons lie at 1 / spacing^2 per mm^2, so n of them take pi r^2 = n spacing^2. A tile of 16 x 16
// pixels holds some hundred photons; the median over tiles is within 3 % of the density.
TEST_CASE("the first radius catches its photons where the camera looks", "[radius]") {
    for (const glm::dvec3 eye : {glm::dvec3(0.0, 0.0, 20.0), glm::dvec3(12.0, -3.0, 14.0)}) {
        Camera camera;
        camera.position_mm = eye;
        camera.target_mm = glm::dvec3(0.0);
        camera.vertical_fov_deg = 25.0;
        const CameraRecord record = make_camera_record(camera, 80, 64);
        const std::vector<GatherPoint> points = points_on_plane(record);
        for (const float spacing_mm : {0.1f, 0.05f}) {
            const double expected = spacing_mm * std::sqrt(photons_per_disk / M_PI);
            CHECK(first_radius_mm(record, points, photon_grid(spacing_mm)) == Approx(expected).epsilon(0.03));
        }
        // A third of the pixels see something in a reflection, anywhere.
        std::vector<GatherPoint> partly = points;
        for (std::size_t i = 0; i < partly.size(); i += 3) {
            partly[i].reflected = 1;
            partly[i].maps = i % 2 == 0 ? partly[i].maps : 0;
            partly[i].x += 500.0f;
            partly[i].z -= 300.0f;
        }
        CHECK(first_radius_mm(record, partly, photon_grid(0.1f)) ==
              Approx(0.1 * std::sqrt(photons_per_disk / M_PI)).epsilon(0.03));
        for (GatherPoint& point : partly) point.reflected = 1;
        CHECK(first_radius_mm(record, partly, photon_grid(0.1f)) == 0.0);
        std::vector<PhotonHead> empty = photon_grid(0.1f);
        for (PhotonHead& photon : empty) photon.normal = STOKES_EMPTY_SLOT;
        CHECK(first_radius_mm(record, points, empty) == 0.0);
        CHECK(first_radius_mm(record, points, {}) == 0.0);
    }
}
