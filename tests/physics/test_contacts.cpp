// Bodies that touch, and surfaces that lie in one place: light goes from one to the other, and not between them.
#include <array>
#include <cmath>

#include "host/render/renderer.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/photon_passes.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

const Spectrum one = {{300.0, 780.0}, {1.0, 1.0}, Outside::zero};

// Places of one scene: as it is, turned by an odd angle so that no coordinate is exact, small, large and off the
// origin.
struct Setting {
    double turn = 0.0, scale = 1.0;
    glm::dvec3 shift_mm{0.0};
};
const std::array<Setting, 4> settings = {
    {{}, {0.7, 1.0, {0.0, 0.0, 0.0}}, {0.3, 1e-3, {0.0, 0.0, 0.0}}, {1.1, 30.0, {2000.0, -500.0, 900.0}}}};

glm::dvec3 placed(const glm::dvec3& p, const Setting& s, bool direction = false) {
    const double c = std::cos(s.turn), k = std::sin(s.turn);
    const glm::dvec3 about_z(c * p.x - k * p.y, k * p.x + c * p.y, p.z);
    const glm::dvec3 about_x(about_z.x, c * about_z.y - k * about_z.z, k * about_z.y + c * about_z.z);
    return direction ? about_x : s.scale * about_x + s.shift_mm;
}

Mesh placed(Mesh mesh, const Setting& s) {
    for (glm::vec3& p : mesh.positions_mm) p = glm::vec3(placed(glm::dvec3(p), s));
    return mesh;
}

Scene scene_of(Transport transport, double sigma_s, double sigma_a, const Setting& s) {
    Scene scene = empty_scene("contacts");
    scene.render.transport = transport;
    scene.render.photons_per_pass = 20000;
    scene.media = {{"m", Spectrum::constant(sigma_s / s.scale), Spectrum::constant(sigma_a / s.scale), 1.4, 1.0}};
    scene.materials = {
        {"translucent", TranslucentMaterial{0, {}, false}}, diffuse_material(0.8), {"black", BlackMaterial{}}};
    return scene;
}

void light_from_above(Scene& scene, double radius_mm, const Setting& s) {
    scene.lights = {
        disk_beam(placed({0.0, 100.0, 0.0}, s), placed({0.0, -1.0, 0.0}, s, true), radius_mm * s.scale, one)};
}

// Share of the emitted light, by index of PhotonAccount::energy, with its standard error over the passes.
constexpr std::size_t emitted = 0, absorbed = 1, escaped = 3;
Sample share(const Scene& scene, std::size_t what, std::uint32_t passes = 12) {
    PhotonPasses photons(scene);
    Sample sample;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const PhotonAccount account = photons.trace(pass);
        sample.add(account.energy[what] / account.energy[emitted]);
    }
    return sample;
}

}  // namespace

// Nothing takes light up: all of it leaves. `conserving` misses exits beyond the edges; the share is checked against
// one block of both, which has no joint.
TEST_CASE("two blocks without loss that are glued together give all light back", "[contacts]") {
    for (const Transport transport : {Transport::walk, Transport::conserving})
        for (const Setting& s : settings) {
            CAPTURE(word_of(transport), s.turn, s.scale);
            Scene scene = scene_of(transport, 2.0, 0.0, s);
            light_from_above(scene, 9.0, s);
            for (const double x : {-5.0, 5.0})
                add_shape(scene, "block", 0, placed(moved(make_box({10.0, 20.0, 20.0}), {x, 0.0, 0.0}), s));
            CHECK(std::abs(share(scene, absorbed, 4).mean()) < 2e-3);
        }
}

// What leaves the foot of a block is taken up by the floor on which it stands, as through a narrow gap: 8 comparisons
// at 4.5 standard errors.
TEST_CASE("a block that stands on a floor loses no light through it", "[contacts]") {
    for (const Transport transport : {Transport::walk, Transport::conserving})
        for (const Setting& s : settings) {
            CAPTURE(word_of(transport), s.turn, s.scale);
            std::array<Sample, 2> lost;
            for (std::size_t raised = 0; raised < 2; ++raised) {
                Scene scene = scene_of(transport, 1.0, 0.01, s);
                light_from_above(scene, 8.0, s);
                add_shape(scene, "floor", 2, placed(make_rectangle(60.0, 60.0), s));
                add_shape(scene, "block", 0,
                          placed(moved(make_box({20.0, 2.0, 20.0}), {0.0, 1.0 + 0.02 * double(raised), 0.0}), s));
                lost[raised] = share(scene, escaped);
            }
            const double error = std::hypot(lost[0].standard_error(), lost[1].standard_error());
            CHECK(error < 6e-3);
            CHECK(std::abs(lost[0].mean() - lost[1].mean()) < 4.5 * error);
        }
}

// What lies on the block: a label, whose back takes up what leaves below it, or a lamp that shines into it. Three
// comparisons at 4.5 standard errors.
TEST_CASE("a label or a lamp that lies on a block is as near as one just above it", "[contacts]") {
    for (const Transport transport : {Transport::walk, Transport::conserving})
        for (const bool lamp : {false, true}) {
            if (lamp && transport == Transport::conserving) continue;  // a block as thin as this is no half-space
            CAPTURE(word_of(transport), lamp);
            std::array<Sample, 2> lost;
            for (std::size_t raised = 0; raised < 2; ++raised) {
                const Setting& s = settings[1];
                Scene scene = scene_of(transport, 1.0, 0.01, s);
                light_from_above(scene, 8.0, s);
                add_shape(scene, "block", 0, placed(moved(make_box({20.0, 2.0, 20.0}), {0.0, 1.0, 0.0}), s));
                Mesh sheet = make_rectangle(9.0, 9.0);
                if (lamp) sheet = turned_over(sheet);
                add_shape(scene, "sheet", 2, placed(moved(sheet, {0.0, 2.0 + 0.02 * double(raised), 0.0}), s));
                if (lamp) {
                    scene.shapes[1].light = 0;
                    scene.lights = {{"lamp", one, SurfaceLight{1}}};
                }
                lost[raised] = share(scene, escaped);
            }
            const double error = std::hypot(lost[0].standard_error(), lost[1].standard_error());
            CHECK(error < 6e-3);
            CHECK(lost[1].mean() > 0.1);
            CHECK(std::abs(lost[0].mean() - lost[1].mean()) < 4.5 * error);
        }
}

namespace {

// X, Y and Z of the middle half of a picture, the least and the most over the pixels, in all layers.
std::array<double, 2> range_of_y(const FilmImage& image) {
    std::array<double, 2> range = {INFINITY, 0.0};
    for (int y = image.height / 4; y < 3 * image.height / 4; ++y)
        for (int x = image.width / 4; x < 3 * image.width / 4; ++x) {
            double sum = 0.0;
            for (const auto& layer : image.xyz)
                sum += double(layer[3 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) + 1]);
            range = {std::min(range[0], sum), std::max(range[1], sum)};
        }
    return range;
}

Camera from_above(double fov_deg, const Setting& s, double height_mm = 100.0) {
    Camera camera;
    camera.position_mm = placed({0.0, height_mm, 0.0}, s);
    camera.target_mm = placed({0.0, 0.0, 0.0}, s);
    camera.up = placed({0.0, 0.0, -1.0}, s, true);
    camera.vertical_fov_deg = fov_deg;
    return camera;
}

}  // namespace

// A surface of reflectance rho in a beam of irradiance E = 1 has the radiance rho / pi.
TEST_CASE("of two sheets in one place the later one is seen", "[contacts]") {
    for (const Setting& s : settings)
        for (const bool light_is_later : {false, true}) {
            // Far away a ray knows its distance less well than surfaces in one place are apart.
            const double height_mm = light_is_later ? 5000.0 : 100.0;
            CAPTURE(s.turn, s.scale, light_is_later);
            Scene scene = scene_of(Transport::conserving, 1.0, 0.01, s);
            scene.materials.push_back(diffuse_material(0.2));
            light_from_above(scene, 40.0, s);
            const int first = light_is_later ? 3 : 1, second = light_is_later ? 1 : 3;
            add_shape(scene, "large", first, placed(make_rectangle(90.0, 90.0), s));
            add_shape(scene, "small", second, placed(make_rectangle(40.0, 41.0), s));
            scene.camera = from_above(1000.0 / height_mm, s, height_mm);
            scene.film = {32, 32, {}};
            Renderer renderer(test_device(), scene);
            renderer.render_pass(0);
            const double expected = film_xyz(scene, 0, one.scaled((light_is_later ? 0.8 : 0.2) / M_PI)).y;
            const std::array<double, 2> range = range_of_y(renderer.image());
            CHECK(range[0] == Approx(expected).epsilon(1e-3));
            CHECK(range[1] == Approx(expected).epsilon(1e-3));
        }
}

// All light that meets the tile is thrown back, from however far it comes.
TEST_CASE("photons meet the tile that lies on a floor, not the floor", "[contacts]") {
    for (const double height_mm : {100.0, 3000.0}) {
        Scene scene = scene_of(Transport::conserving, 1.0, 0.01, {});
        scene.materials.push_back(diffuse_material(1.0));
        scene.lights = {disk_beam({0.0, height_mm, 0.0}, {0.01, -1.0, 0.0}, 10.0, one)};
        std::get<DiskBeam>(scene.lights[0].kind).position_mm.x = -0.01 * height_mm;
        add_shape(scene, "floor", 2, make_rectangle(100.0, 100.0));
        add_shape(scene, "tile", 3, make_rectangle(60.0, 60.0));
        CHECK(share(scene, absorbed, 2).mean() == 0.0);
    }
}

// The radiance of a diffuse emitter of flux 1 and area A is 1 / (pi A), in whatever order the shapes stand.
TEST_CASE("a lamp that is flush with a ceiling is seen whole", "[contacts]") {
    for (const bool lamp_is_first : {false, true}) {
        Scene scene = scene_of(Transport::conserving, 1.0, 0.01, {});
        const Mesh ceiling = make_rectangle(90.0, 90.0), lamp = make_rectangle(40.0, 40.0);
        if (!lamp_is_first) add_shape(scene, "ceiling", 1, ceiling);
        add_shape(scene, "lamp", 2, lamp).light = 0;
        if (lamp_is_first) add_shape(scene, "ceiling", 1, ceiling);
        scene.lights = {{"lamp", one, SurfaceLight{lamp_is_first ? 0 : 1}}};
        scene.camera = from_above(10.0, {});
        scene.film = {32, 32, {}};
        Renderer renderer(test_device(), scene);
        renderer.render_pass(0);
        const double expected = film_xyz(scene, 0, one.scaled(1e6 / (M_PI * 1600.0))).y;
        const std::array<double, 2> range = range_of_y(renderer.image());
        CHECK(range[0] == Approx(expected).epsilon(1e-4));
        CHECK(range[1] == Approx(expected).epsilon(1e-4));
    }
}

TEST_CASE("a floor is dark from below, also under a lit block that stands on it", "[contacts]") {
    for (const Transport transport : {Transport::walk, Transport::conserving}) {
        Scene scene = scene_of(transport, 1.0, 0.001, {});
        light_from_above(scene, 9.0, {});
        add_shape(scene, "floor", 1, make_rectangle(60.0, 60.0));
        add_shape(scene, "block", 0, moved(make_box({20.0, 2.0, 20.0}), {0.0, 1.0, 0.0}));
        scene.camera = from_above(20.0, {});
        scene.camera.position_mm.y = -100.0;
        scene.film = {24, 24, {}};
        Renderer renderer(test_device(), scene);
        for (std::uint32_t pass = 0; pass < 2; ++pass) renderer.render_pass(pass);
        CHECK(range_of_y(renderer.image())[1] == 0.0);
        scene.camera.position_mm.y = 100.0;
        Renderer above(test_device(), scene);
        above.render_pass(0);
        CHECK(range_of_y(above.image())[0] > 0.0);
    }
}
