// Light stays on its side: disks of the density estimate that are larger than walls are thick and gaps are wide.
#include <algorithm>

#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

const Spectrum one = {{300.0, 780.0}, {1.0, 1.0}, Outside::zero};

constexpr double radius_mm = 4.0;

Scene dark_scene(Radii radii) {
    Scene scene = empty_scene("leaks");
    scene.render.photons_per_pass = 20000;
    scene.render.radius_mm = radius_mm;
    scene.render.radii = radii;
    scene.materials = {diffuse_material(0.5), Material{}};
    scene.film = {24, 24, {}};
    return scene;
}

// A box [mm] with its faces outward.
Mesh box(const glm::dvec3& size, const glm::dvec3& centre) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions_mm.push_back(
            glm::vec3(centre + 0.5 * size * glm::dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return mesh;
}

Camera looking(const glm::dvec3& from_mm, const glm::dvec3& to_mm, double angle_deg, const glm::dvec3& up = {0, 1, 0}) {
    Camera camera;
    camera.position_mm = from_mm;
    camera.target_mm = to_mm;
    camera.up = up;
    camera.vertical_fov_deg = angle_deg;
    return camera;
}

struct Seen {
    FilmImage image;
    double radiance = 0.0;  // Y of radiance 0.5 / pi, that of a white beam's irradiance here, in the same passes
};

Seen see(const Scene& scene, std::uint32_t passes = 4) {
    Renderer renderer(test_device(), scene);
    Seen seen{FilmImage(scene.film.width, scene.film.height)};
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        renderer.render_pass(pass);
        seen.radiance += film_xyz(scene, pass, one.scaled(0.5 / M_PI)).y / passes;
    }
    seen.image = renderer.image();
    return seen;
}

// Y of a pixel in all layers.
double brightness(const FilmImage& image, int x, int y) {
    double sum = 0.0;
    for (const auto& layer : image.xyz)
        sum += static_cast<double>(layer[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                              static_cast<std::size_t>(x)) +
                                         1]);
    return sum;
}

double brightest(const FilmImage& image) {
    double most = 0.0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) most = std::max(most, brightness(image, x, y));
    return most;
}

}  // namespace

// The light meets nothing but the lit side, and what that reflects leaves the scene: the rest is exactly black.
TEST_CASE("the dark side of a thin wall stays black", "[leaks]") {
    for (const Radii radii : {Radii::one, Radii::local}) {
        Scene scene = dark_scene(radii);
        add_shape(scene, "wall", 0, box({40.0, 40.0, 0.1}, {0.0, 0.0, 0.0}));
        scene.lights = {disk_beam({0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, 15.0, one)};
        scene.camera = looking({0.0, 0.0, -100.0}, {0.0, 0.0, 0.0}, 20.0);
        CHECK(brightest(see(scene).image) == 0.0);
        scene.camera = looking({0.0, 0.0, 100.0}, {0.0, 0.0, 0.0}, 20.0);
        CHECK(brightest(see(scene).image) > 0.0);
    }
}

TEST_CASE("a lit top does not shine through the edge onto a dark side", "[leaks]") {
    for (const Radii radii : {Radii::one, Radii::local}) {
        Scene scene = dark_scene(radii);
        add_shape(scene, "box", 0, box({20.0, 20.0, 20.0}, {0.0, 0.0, 0.0}));
        scene.lights = {disk_beam({0.0, 10.0, 8.0}, {0.0, -1.0, 0.0}, 4.0, one)};
        scene.camera = looking({0.0, 6.0, 100.0}, {0.0, 6.0, 10.0}, 4.0);
        CHECK(brightest(see(scene).image) == 0.0);
    }
}

// Where the lit sheet ends, the dark one below is seen, in the light of neither: the beam ends on the upper sheet,
// which throws none down. The gap is 0.075 of the radius.
TEST_CASE("a sheet close above another does not light it", "[leaks]") {
    for (const Radii radii : {Radii::one, Radii::local}) {
        Scene scene = dark_scene(radii);
        add_shape(scene, "below", 0, make_rectangle(60.0, 60.0));
        add_shape(scene, "above", 0, moved(make_rectangle(30.0, 60.0), {-15.0, 0.3, 0.0}));
        scene.lights = {disk_beam({-4.0, 0.3, 0.0}, {0.0, -1.0, 0.0}, 3.9, one)};
        scene.camera = camera_above({4.1, 0.0, 0.0}, 400.0, 8.0);  // from 0.1 mm beyond the edge on
        CHECK(brightest(see(scene).image) == 0.0);
        // And is as bright itself as without the other, up to its edge.
        scene.camera = camera_above({-4.1, 0.3, 0.0}, 400.0, 0.5);
        scene.lights = {disk_beam({-4.0, 0.3, 0.0}, {0.0, -1.0, 0.0}, 12.0, one)};
        const Seen lit = see(scene, 16);
        CHECK(mean_xyz(lit.image, Layer::surface).y == Approx(lit.radiance).epsilon(0.03));
    }
}

// One body: only the height test is left, which holds down to a step of a quarter of the radius. Lower steps let light
// of the lit side count on the dark one, until the radius has shrunk.
TEST_CASE("a step of one body is dark below when it is higher than a quarter of the radius", "[leaks]") {
    for (const Radii radii : {Radii::one, Radii::local})
        for (const double height_mm : {4.2, 1.05}) {
            Scene scene = dark_scene(radii);
            // Half as wide where the factor of a point is up to 4, so that the largest disk is as above.
            scene.render.radius_mm = (radii == Radii::local ? 0.25 : 1.0) * 4.0 * height_mm / 1.05;
            Mesh stair = make_rectangle(60.0, 60.0);
            const Mesh upper = moved(make_rectangle(30.0, 60.0), {-15.0, height_mm, 0.0});
            const auto first = static_cast<unsigned>(stair.positions_mm.size());
            stair.positions_mm.insert(stair.positions_mm.end(), upper.positions_mm.begin(), upper.positions_mm.end());
            for (const glm::uvec3& t : upper.triangles) stair.triangles.push_back(t + glm::uvec3(first));
            add_shape(scene, "stair", 0, stair);
            scene.lights = {disk_beam({-4.0, height_mm, 0.0}, {0.0, -1.0, 0.0}, 3.9, one)};
            scene.camera = camera_above({4.1, 0.0, 0.0}, 400.0, 8.0);
            CHECK(brightest(see(scene).image) == 0.0);
        }
}

// A slab lower than a quarter of the radius stands on a floor in the beam. Both are diffuse here, so that they share a
// map, and the slab is black: nothing of what the floor stores is seen in it.
TEST_CASE("a low slab has no light of the floor that it stands on", "[leaks]") {
    for (const Radii radii : {Radii::one, Radii::local}) {
        Scene scene = dark_scene(radii);
        add_shape(scene, "floor", 0, make_rectangle(200.0, 200.0));
        add_shape(scene, "slab", 0, box({20.0, 0.5, 20.0}, {0.0, 0.25, 0.0}));
        scene.lights = {disk_beam({20.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, 9.9, one)};
        scene.camera = camera_above({5.0, 0.5, 0.0}, 400.0, 9.9);
        CHECK(brightest(see(scene).image) == 0.0);
    }
}

// Translucent, lit from above: what the floor and the slab show is what stands in their own maps.
TEST_CASE("a translucent slab and its floor keep to their own layers", "[leaks]") {
    for (const Radii radii : {Radii::one, Radii::local}) {
        Scene scene = small_scene();
        scene.render.radius_mm = radius_mm;
        scene.render.radii = radii;
        scene.shapes[1].mesh = box({30.0, 0.5, 30.0}, {0.0, 0.25, 0.0});
        const auto in_layers = [](const FilmImage& image, bool surface) {
            double sum = 0.0;
            for (std::size_t c = 0; c < layer_count; ++c)
                if ((c == static_cast<std::size_t>(Layer::surface)) == surface)
                    for (const float v : image.xyz[c]) sum += static_cast<double>(v);
            return sum;
        };
        scene.camera = looking({0.0, 60.0, 40.0}, {0.0, 0.5, 0.0}, 8.0, {0, 1, 0});
        const FilmImage slab = see(scene).image;
        CHECK(in_layers(slab, true) == 0.0);
        CHECK(in_layers(slab, false) > 0.0);
        scene.camera = looking({19.0, 60.0, 40.0}, {19.0, 0.0, 0.0}, 3.0, {0, 1, 0});
        const FilmImage floor = see(scene).image;
        CHECK(in_layers(floor, true) > 0.0);
        CHECK(in_layers(floor, false) == 0.0);
    }
}
