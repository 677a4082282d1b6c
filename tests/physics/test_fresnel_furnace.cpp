#include "host/subsurface/quadrature.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

constexpr double eta = 1.5;

// A hollow sphere of 100 mm radius whose black wall shines inward with radiance 1. Material 1, for what stands in it,
// is a medium that absorbs nothing, of mean free path 0.005 mm, below a smooth surface.
Scene furnace_with_smooth_material() {
    Scene scene = furnace_scene(0.0);
    Medium medium;
    medium.name = "lossless";
    medium.sigma_s = Spectrum::constant(200.0);
    medium.sigma_a = Spectrum::constant(0.0);
    medium.eta = eta;
    scene.media = {medium};
    scene.materials.push_back({"smooth", TranslucentMaterial{0, {}, true}});
    scene.render.transport = Transport::conserving;
    scene.render.photons_per_pass = 50000;
    scene.render.emission = Emission::aimed;
    scene.render.radius_mm = 6.0;
    return scene;
}

// Towards the origin from that distance, at an angle from +y over +x.
void look(Scene& scene, double angle_deg, double distance_mm, double fov_deg) {
    const double angle = angle_deg * M_PI / 180.0;
    scene.camera.target_mm = {0.0, 0.0, 0.0};
    scene.camera.position_mm = distance_mm * glm::dvec3(std::sin(angle), std::cos(angle), 0.0);
    scene.camera.up = {0.0, 0.0, 1.0};
    scene.camera.vertical_fov_deg = fov_deg;
    scene.film = {16, 16, {}};
}

struct Seen {
    Sample radiance;  // mean over the picture, a value a pass
    Sample surface;   // the part of it that is seen of the furnace's wall
};

Seen see(const Scene& scene, std::uint32_t passes) {
    Renderer renderer(test_device(), scene);
    PassImages images(renderer);
    Seen seen;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const double one = film_xyz(scene, pass, Spectrum::constant(1.0)).y;
        const FilmImage image = images.next(pass);
        double sum = 0.0;
        for (std::size_t c = 0; c < layer_count; ++c) sum += mean_xyz(image, static_cast<Layer>(c)).y / one;
        seen.radiance.add(sum);
        seen.surface.add(mean_xyz(image, Layer::surface).y / one);
    }
    const Balance power = renderer.book().ledger().power;
    CHECK(std::abs(power.imbalance()) < 1e-4);
    CHECK(power.dropped < 1e-3 * power.emitted);
    return seen;
}

// A case makes two or three such comparisons, 4.5 of a normal variable each: 7e-6 by chance.
void check_mean(const Sample& sample, double expected, double most_error) {
    CAPTURE(sample.mean(), expected, sample.standard_error());
    CHECK(sample.standard_error() < most_error);
    CHECK(std::abs(normal_of_t(sample.z(expected), static_cast<double>(sample.count() - 1))) < 4.5);
}

double reflectance(double mu) {
    const double within = std::sqrt(1.0 - (1.0 - mu * mu) / (eta * eta));
    const double s = (mu - eta * within) / (mu + eta * within), p = (eta * mu - within) / (eta * mu + within);
    return 0.5 * (s * s + p * p);
}

// Mean of the reflectance of the plane y = 0 over the picture.
double mean_reflectance(const Scene& scene) {
    const CameraRecord camera = make_camera_record(scene.camera, scene.film.width, scene.film.height);
    const GaussLegendre quadrature(20);
    double sum = 0.0;
    for (std::size_t i = 0; i < quadrature.node.size(); ++i)
        for (std::size_t j = 0; j < quadrature.node.size(); ++j) {
            const double x = quadrature.node[i] * camera.width, y = quadrature.node[j] * camera.height;
            const glm::dvec3 d(camera.corner_x + x * camera.right_x + y * camera.down_x,
                               camera.corner_y + x * camera.right_y + y * camera.down_y,
                               camera.corner_z + x * camera.right_z + y * camera.down_z);
            sum += quadrature.weight[i] * quadrature.weight[j] * reflectance(-d.y / glm::length(d));
        }
    return sum;
}

}  // namespace

// PHYSICS section 4: what enters comes out, and with what is mirrored makes radiance 1 in every direction. What
// the slab's edges lose is a mean free path over their distance, below 1e-3.
TEST_CASE("a smooth lossless slab in a furnace of radiance 1 has radiance 1 at all angles", "[fresnel_furnace]") {
    struct View {
        double angle_deg, fov_deg;
    };
    for (const View& view : {View{0.0, 40.0}, View{60.0, 25.0}, View{80.0, 8.0}}) {
        CAPTURE(view.angle_deg);
        Scene scene = furnace_with_smooth_material();
        add_shape(scene, "slab", 1, make_rectangle(120.0, 120.0));
        look(scene, view.angle_deg, 60.0, view.fov_deg);
        const Seen seen = see(scene, 32);
        check_mean(seen.radiance, 1.0, 0.002);
        check_mean(seen.surface, mean_reflectance(scene), 0.01);
    }
}

TEST_CASE("a smooth lossless sphere in a furnace of radiance 1 has radiance 1", "[fresnel_furnace]") {
    for (const double angle_deg : {0.0, 65.0}) {
        CAPTURE(angle_deg);
        Scene scene = furnace_with_smooth_material();
        add_shape(scene, "sphere", 1, moved(make_sphere(40.0, 256), {0.0, -40.0, 0.0}));
        look(scene, angle_deg, 50.0, angle_deg == 0.0 ? 30.0 : 6.0);
        const Seen seen = see(scene, 16);
        check_mean(seen.radiance, 1.0, 0.006);
    }
}

// Most of what comes to one slab has left the other at less than 45 degrees from its normal: light goes to and fro with
// the directions of PHYSICS section 4, and the camera between the two sees what is mirrored several times.
TEST_CASE("two smooth lossless slabs that face each other in a furnace of radiance 1 have radiance 1",
          "[fresnel_furnace]") {
    Scene scene = furnace_with_smooth_material();
    add_shape(scene, "floor", 1, make_rectangle(120.0, 120.0));
    add_shape(scene, "ceiling", 1, moved(turned_over(make_rectangle(120.0, 120.0)), {0.0, 45.0, 0.0}));
    look(scene, 0.0, 40.0, 50.0);
    const Seen seen = see(scene, 32);
    check_mean(seen.radiance, 1.0, 0.006);
}
