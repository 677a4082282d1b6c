#include <chrono>
#include <cmath>

#include "host/render/assumptions.hpp"
#include "host/render/transport/transport_model.hpp"
#include "host/scene/mesh/mesh.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

// sigma_s 1.5 and sigma_a 0.01 per mm: a diffuse length of 4.698 mm and a mean free path of 0.662 mm; at 600
// nm sigma_a is 0.0025, and the diffuse length 9.419 mm.
Scene one_thing(const Mesh& mesh) {
    Scene scene;
    scene.file = "s.json";
    Medium medium;
    medium.sigma_s = Spectrum::constant(1.5);
    medium.sigma_a = {{599.0, 600.0, 601.0}, {0.01, 0.0025, 0.01}, Outside::hold};
    scene.media = {medium};
    scene.materials = {{"wax", TranslucentMaterial{0, {}, false}}};
    add_shape(scene, "thing", 0, mesh);
    return scene;
}

using Lines = std::vector<std::string>;

Lines failures_of(const Mesh& mesh) { return failed_assumptions(one_thing(mesh)); }

}  // namespace

TEST_CASE("A plate thinner than the longest diffuse length fails, a thicker one and a sheet do not") {
    CHECK(failures_of(make_box({200, 9.3, 200})) ==
          Lines{"s.json: materials.wax: shape \"thing\" is thinner than its light reaches: half of its "
                "surface is within 9.3 "
                "mm of the other side (optical thickness 14), the light reaches 9.42 mm at 600 nm; transport "
                "\"conserving\" "
                "takes it for a half-space"});
    CHECK(failures_of(make_box({200, 9.5, 200})).empty());
    CHECK(failures_of(make_rectangle(200, 200)).empty());
    CHECK(failures_of(make_rectangle(1e-3, 1e-3)).empty());
}

TEST_CASE("Only the render's wavelengths count") {
    Scene scene = one_thing(make_box({200, 9.3, 200}));
    scene.render.lambda_max_nm = 599;
    CHECK(failed_assumptions(scene).empty());
    scene.shapes[0].mesh = make_box({200, 4.6, 200});
    REQUIRE(failed_assumptions(scene).size() == 1);
    CHECK(failed_assumptions(scene)[0].find("reaches 4.7 mm at 300 nm") != std::string::npos);
}

TEST_CASE("Where absorption is strong, three mean free paths count") {
    Scene scene = one_thing(make_box({200, 2.9, 200}));
    scene.media[0].sigma_s = Spectrum::constant(0.1);
    scene.media[0].sigma_a = Spectrum::constant(0.9);
    REQUIRE(failed_assumptions(scene).size() == 1);
    CHECK(failed_assumptions(scene)[0].find("(optical thickness 2.9), the light reaches 3 mm") != std::string::npos);
    scene.shapes[0].mesh = make_box({200, 3.1, 200});
    CHECK(failed_assumptions(scene).empty());
}

TEST_CASE("Without absorption every closed body is thin") {
    Scene scene = one_thing(make_sphere(1e4));
    scene.media[0].sigma_a = Spectrum::constant(0.0);
    REQUIRE(failed_assumptions(scene).size() == 1);
    CHECK(failed_assumptions(scene)[0].find("the light reaches any distance at 300 nm") != std::string::npos);
    scene.shapes[0].mesh = make_rectangle(10, 10);
    CHECK(failed_assumptions(scene).empty());
}

TEST_CASE("A ball fails when its radius is less than the diffuse length, and so does a cave") {
    CHECK(failures_of(make_sphere(9.0)) ==
          Lines{"s.json: materials.wax: shape \"thing\" is curved within a diffuse length: its mean radius of "
                "curvature is 9 "
                "mm, the diffuse length 9.42 mm at 600 nm; transport \"conserving\" takes it for a half-space"});
    CHECK(failures_of(turned_over(make_sphere(9.0))).size() == 1);
    CHECK(failures_of(make_sphere(9.6)).empty());
    CHECK(failures_of(turned_over(make_sphere(9.6))).empty());
    // Thin as well as curved: one line.
    REQUIRE(failures_of(make_sphere(4.0)).size() == 1);
    CHECK(failures_of(make_sphere(4.0))[0].find("thinner") != std::string::npos);
}

TEST_CASE("A material has one line, of its worst body") {
    Scene scene = one_thing(make_box({200, 5, 200}));
    for (const double thickness : {30.0, 2.0, 4.0}) {
        Shape shape = scene.shapes[0];
        shape.name = "plate " + std::to_string(scene.body_count);
        shape.body = scene.body_count++;
        shape.mesh = make_box({200, thickness, 200});
        scene.shapes.push_back(shape);
    }
    Material other = scene.materials[0];
    other.name = "soap";
    scene.materials.push_back(other);
    Shape soap = scene.shapes[0];
    soap.name = "soap plate";
    soap.material = 1;
    soap.body = scene.body_count++;
    scene.shapes.push_back(soap);
    const Lines lines = failed_assumptions(scene);
    REQUIRE(lines.size() == 2);
    CHECK(lines[0].find("materials.wax: shape \"plate 2\" (and 2 more) is thinner") != std::string::npos);
    CHECK(lines[0].find("within 2 mm") != std::string::npos);
    CHECK(lines[1].find("materials.soap: shape \"soap plate\" is thinner") != std::string::npos);
}

TEST_CASE("Walks take bodies as they are, and surface fluorescence has no depth") {
    Scene scene = one_thing(make_box({200, 1, 200}));
    scene.render.transport = Transport::paper;
    CHECK(failed_assumptions(scene).size() == 1);
    scene.render.transport = Transport::walk;
    CHECK(failed_assumptions(scene).empty());
    scene.render.transport = Transport::conserving;
    translucent_of(scene).medium.reset();
    CHECK(failed_assumptions(scene).empty());
}

TEST_CASE("The shipped scenes are as good as half-spaces") {
    for (const char* file : {"prisms.json", "sphere.json"}) {
        INFO(file);
        CHECK(failed_assumptions(read_scene(source_path("scenes/") + file)) == Lines{});
    }
    CHECK(failed_assumptions(slab_scene(0.5, 30.0)).empty());
}

TEST_CASE("A mesh of a million triangles is measured in no time that a person would notice") {
    Mesh mesh = make_sphere(4.0, 1000);
    REQUIRE(mesh.triangles.size() > 990000);
    const Scene scene = one_thing(mesh);
    const auto start = std::chrono::steady_clock::now();
    CHECK(failed_assumptions(scene).size() == 1);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    CAPTURE(seconds);
    CHECK(seconds < 3.0);  // on a busy machine
}

TEST_CASE("What transport paper makes of a scene is said, and only of paper") {
    Scene scene = one_thing(make_sphere(100.0));
    Fluorophore dye;
    dye.name = "dye";
    dye.excitation = Spectrum::constant(1.0);
    dye.emission = {{500.0, 510.0, 520.0}, {0.0, 1.0, 0.0}, Outside::zero};  // sums to 10
    dye.conversion = 0.101;
    Fluorophore weak = dye;
    weak.conversion = 0.1;
    scene.fluorophores = {dye, weak};
    scene.render.transport = Transport::paper;
    CHECK(transport_model(scene.render.transport).remarks(scene) ==
          Lines{"s.json: fluorophores.dye: emits up to 1.01 times what it takes up (conversion_per_nm times the "
                "sum of its "
                "emission)"});
    for (const Transport other : {Transport::conserving, Transport::walk}) {
        scene.render.transport = other;
        CHECK(transport_model(scene.render.transport).remarks(scene).empty());
    }
}
