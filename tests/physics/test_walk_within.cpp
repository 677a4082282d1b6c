// What lies within a body, by random walks in the body's mesh: cores, lamps, and bodies of another medium.
#include <cmath>
#include <random>

#include "host/render/conflicts.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/photon_passes.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

const Spectrum one = {{300.0, 780.0}, {1.0, 1.0}, Outside::zero};

constexpr double outer_mm = 20.0, core_mm = 14.0;

Scene ball(double sigma_s, double sigma_a) {
    Scene scene = empty_scene("within");
    scene.render.transport = Transport::walk;
    scene.render.photons_per_pass = 20000;
    scene.media = {{"m", Spectrum::constant(sigma_s), Spectrum::constant(sigma_a), 1.0, 1.0}};
    scene.materials = {{"translucent", TranslucentMaterial{0, {}, false}}};
    add_shape(scene, "ball", 0, make_sphere(outer_mm, 160));
    scene.lights = {disk_beam({0.0, 100.0, 0.0}, {0.0, -1.0, 0.0}, 0.99 * outer_mm, one)};
    return scene;
}

Sample escaped_share(const Scene& scene, std::uint32_t passes = 20) {
    PhotonPasses photons(scene);
    Sample sample;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const PhotonAccount account = photons.trace(pass);
        CHECK(account.fates[STOKES_FATE_BEHIND] == 0);
        sample.add(account.energy[3] / account.energy[0]);
    }
    return sample;
}

// A walk of its own, in double precision and perfect spheres: isotropic scattering without loss, a core that reflects
// diffusely or takes light up. from_core: light starts at the core, cosine-distributed, else in the beam. Returns the
// share that leaves.
double walked_share(double sigma_s, double core, double reflectance, bool from_core, int walks) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> uniform;
    const auto about = [&](const glm::dvec3& n) {  // cosine-distributed
        const double turn = 2.0 * M_PI * uniform(random), u = uniform(random);
        const glm::dvec3 other = std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        const glm::dvec3 s = glm::normalize(glm::cross(n, other)), t = glm::cross(n, s);
        return std::sqrt(u) * (std::cos(turn) * s + std::sin(turn) * t) + std::sqrt(1.0 - u) * n;
    };
    // Distance to a sphere about the origin from outside it, or from within.
    const auto distance = [](const glm::dvec3& p, const glm::dvec3& d, double radius, bool outside) {
        const double b = glm::dot(p, d), root = b * b - glm::dot(p, p) + radius * radius;
        if (root < 0.0) return HUGE_VAL;
        const double t = outside ? -b - std::sqrt(root) : -b + std::sqrt(root);
        return t > 0.0 ? t : HUGE_VAL;
    };
    int left = 0;
    for (int i = 0; i < walks; ++i) {
        glm::dvec3 p(0.0, core * (1.0 + 1e-9), 0.0), d = about({0.0, 1.0, 0.0});
        if (!from_core) {
            const double r = 0.99 * outer_mm * std::sqrt(uniform(random)), turn = 2.0 * M_PI * uniform(random);
            p = {r * std::cos(turn), std::sqrt(outer_mm * outer_mm - r * r), r * std::sin(turn)};
            d = {0.0, -1.0, 0.0};
        }
        for (;;) {
            const double free = -std::log(1.0 - uniform(random)) / sigma_s;
            const double out = distance(p, d, outer_mm, false), in = distance(p, d, core, true);
            if (in < free && in < out) {
                if (!(uniform(random) < reflectance)) break;
                p = (p + in * d) * (1.0 + 1e-9);
                d = about(glm::normalize(p));
                continue;
            }
            if (out < free) {
                ++left;
                break;
            }
            p += free * d;
            const double mu = 2.0 * uniform(random) - 1.0, turn = 2.0 * M_PI * uniform(random);
            const double across = std::sqrt(1.0 - mu * mu);
            d = {across * std::cos(turn), mu, across * std::sin(turn)};
        }
    }
    return double(left) / walks;
}

constexpr int walks = 400000;

// Spheres of flat faces are smaller by 2e-4 in radius; four standard errors of both.
void check_share(const Sample& rendered, double expected) {
    const double error = std::hypot(rendered.standard_error(), std::sqrt(expected * (1.0 - expected) / walks));
    CHECK(error < 2.5e-3);
    CHECK(std::abs(rendered.mean() - expected) < 4.0 * error + 1e-3);
}

}  // namespace

TEST_CASE("a core within a body takes light up and throws it back", "[within]") {
    for (const double reflectance : {0.0, 0.5}) {
        CAPTURE(reflectance);
        Scene scene = ball(0.05, 0.0);
        scene.materials.push_back(diffuse_material(reflectance));
        add_shape(scene, "core", 1, make_sphere(core_mm, 160));
        check_share(escaped_share(scene), walked_share(0.05, core_mm, reflectance, false, walks));
    }
}

TEST_CASE("a lamp within a body shines out of it", "[within]") {
    for (const double reflectance : {0.0, 1.0}) {
        CAPTURE(reflectance);
        Scene scene = ball(0.3, 0.0);
        scene.materials.push_back(diffuse_material(reflectance));
        Shape& lamp = add_shape(scene, "lamp", 1, make_sphere(4.0, 160));
        lamp.light = 0;
        scene.lights = {{"lamp", one, SurfaceLight{1}}};
        check_share(escaped_share(scene), walked_share(0.3, 4.0, reflectance, true, walks));
    }
}

// Light from the middle goes through a radius of the ball: exp(-sigma_a R), but for the faces, which are up to 4e-3 mm
// nearer.
TEST_CASE("a beam that starts within a body is dimmed on its way out", "[within]") {
    Scene scene = ball(1e-9, 0.05);
    scene.lights = {disk_beam({0.0, -1.0, 0.0}, {0.0, -1.0, 0.0}, 0.5, one)};
    check_share(escaped_share(scene), std::exp(-0.05 * outer_mm));
}

// Light goes from one core into the other, or past them; nothing takes it up. The third lies at the ball's wall.
TEST_CASE("cores that touch lose no light between them", "[within]") {
    for (const int material : {0, 1}) {
        Scene scene = ball(0.2, 0.0);
        scene.media.push_back({"n", Spectrum::constant(1.0), Spectrum::constant(0.0), 1.0, 1.0});
        scene.materials.push_back(material == 0 ? Material{"inner", TranslucentMaterial{1, {}, false}}
                                                : diffuse_material(1.0));
        scene.materials.push_back({"other", TranslucentMaterial{1, {}, false}});
        scene.shapes[0].mesh = make_box({30.0, 30.0, 30.0});
        scene.lights = {disk_beam({0.0, 100.0, 0.0}, {0.0, -1.0, 0.0}, 12.0, one)};
        add_shape(scene, "left", 1, moved(make_box({8.0, 8.0, 8.0}), {-4.0, 0.0, 0.0}));
        add_shape(scene, "right", 2, moved(make_box({8.0, 8.0, 8.0}), {4.0, 0.0, 0.0}));
        add_shape(scene, "at the wall", 2, moved(make_box({8.0, 8.0, 8.0}), {0.0, 11.0, 0.0}));
        CHECK(escaped_share(scene, 4).mean() == Approx(1.0).margin(1e-4));
    }
}

// Balls without loss give all light back, and one in the other takes none from it.
TEST_CASE("bodies within bodies pass light on", "[within]") {
    Scene scene = ball(0.2, 0.0);
    scene.media.push_back({"n", Spectrum::constant(1.0), Spectrum::constant(0.0), 1.0, 1.0});
    scene.materials.push_back({"inner", TranslucentMaterial{1, {}, false}});
    add_shape(scene, "inner", 1, make_sphere(core_mm, 160));
    Sample open = escaped_share(scene, 4);
    CHECK(open.mean() == Approx(1.0).margin(1e-5));
    // What is black in the middle is found through both.
    scene.materials.push_back({"black", BlackMaterial{}});
    add_shape(scene, "core", 2, make_sphere(9.0, 160));
    const double through_both = escaped_share(scene).mean();
    CHECK(through_both < 0.95);
    CHECK(through_both > 0.3);
}

TEST_CASE("what a transport does not see within a body is refused or said", "[within]") {
    Scene scene = ball(0.3, 0.01);
    scene.camera.position_mm = {0.0, 0.0, 100.0};
    scene.materials.push_back({"black", BlackMaterial{}});
    add_shape(scene, "core", 1, make_sphere(4.0));
    CHECK(find_conflicts(scene).empty());
    scene.render.transport = Transport::conserving;
    const std::vector<std::string> lines = find_conflicts(scene);
    REQUIRE(lines.size() == 1);
    CHECK_THAT(lines[0], Catch::Contains("shape \"core\" lies within shape \"ball\" and is not seen"));

    Scene lamp = scene;
    lamp.shapes[1].light = 0;
    lamp.lights = {{"lamp", one, SurfaceLight{1}}};
    CHECK_THROWS_WITH(find_conflicts(lamp),
                      Catch::Contains("light \"lamp\": lies within the translucent shape \"ball\""));
    lamp.render.transport = Transport::walk;
    CHECK(find_conflicts(lamp).empty());
    lamp.shapes[1].mesh = moved(lamp.shapes[1].mesh, {outer_mm, 0.0, 0.0});
    CHECK_THROWS_WITH(find_conflicts(lamp), Catch::Contains("lies partly within the translucent shape \"ball\""));

    scene.camera.position_mm = {0.0, 15.0, 0.0};
    CHECK_THROWS_WITH(find_conflicts(scene), Catch::Contains("camera: lies within the translucent shape \"ball\""));
}

TEST_CASE("bodies that pass through one another are said", "[within]") {
    Scene scene = ball(0.3, 0.01);
    scene.camera.position_mm = {0.0, 0.0, 100.0};
    add_shape(scene, "other", 0, moved(make_sphere(5.0), {18.0, 0.0, 0.0}));
    std::vector<std::string> lines = find_conflicts(scene);
    REQUIRE(lines.size() == 1);
    CHECK_THAT(lines[0], Catch::Contains("shape \"ball\" and shape \"other\" pass through one another"));
    // A table that a body is sunk into: a walk sees it, tables do not.
    scene.shapes.pop_back();
    scene.body_count = 1;
    scene.materials.push_back(diffuse_material(0.5));
    add_shape(scene, "table", 1, moved(make_rectangle(90.0, 90.0), {0.0, -19.0, 0.0}));
    CHECK(find_conflicts(scene).empty());
    scene.render.transport = Transport::paper;
    lines = find_conflicts(scene);
    REQUIRE(lines.size() == 1);
    CHECK_THAT(lines[0], Catch::Contains("does not see what lies within a body"));
    // Standing on it is well.
    scene.shapes[1].mesh = moved(make_rectangle(90.0, 90.0), {0.0, -outer_mm, 0.0});
    CHECK(find_conflicts(scene).empty());
}
