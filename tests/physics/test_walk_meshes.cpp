// Model `walk` in closed meshes (PHYSICS section 5).
#include "host/scene/mesh/shapes.hpp"
#include "tests/support/beam_fixture.hpp"
#include "tests/support/input_error.hpp"

using namespace stokes;

namespace {

// Its top face centred on the origin.
Mesh box_below(double width_mm, double height_mm) {
    Mesh mesh = make_box({width_mm, height_mm, width_mm});
    for (glm::vec3& p : mesh.positions_mm) p.y -= static_cast<float>(0.5 * height_mm);
    return mesh;
}

}  // namespace

TEST_CASE("without loss everything comes out of a closed mesh", "[walk]") {
    Mesh sphere = make_sphere(3.0, 48);
    for (glm::vec3& p : sphere.positions_mm) p.y -= 2.9f;
    for (const Mesh& mesh : {sphere, box_below(4.0, 2.0)})
        for (const bool fresnel : {false, true}) {
            Material16 m;
            m.sigma_t = spread(0.5, 2.0);
            m.eta = 1.4;
            m.fresnel = fresnel;
            const Measured r = measure(beam_scene(m, mesh, 0.9), 1, 1u << 15);
            CAPTURE(fresnel, mesh.triangles.size());
            CHECK(r.missed == 0.0);
            CHECK(r.dropped == 0.0);
            CHECK(r.absorbed == 0.0);
            CHECK(r.imbalance < 1e-5);
            for (const Sample& s : r.total) check_mean(s, 1.0, 0.01);
        }
}

// Beer's law, for the wavelengths that led and those that did not. Unscattered light is in the single-scattering map.
TEST_CASE("light that does not scatter goes straight through a thin mesh", "[walk]") {
    Material16 m;
    m.sigma_t = spread(0.1, 3.0);
    m.albedo = all(0.0);
    m.eta = 1.5;
    const double mu = 0.6, way = 0.5 / cosine_within(1.5, mu);
    const Measured r = measure(beam_scene(m, box_below(10.0, 0.5), mu), 1, 1u << 16);
    CHECK(r.missed == 0.0);
    for (std::size_t k = 0; k < wavelengths; ++k) {
        check_mean(r.map[STOKES_MAP_SINGLE][k], std::exp(-m.sigma_t[k] * way), 4e-3);
        CHECK(r.map[STOKES_MAP_MULTIPLE][k].mean() == 0.0);
    }
}

TEST_CASE("a thick closed mesh reflects as a half-space", "[walk]") {
    for (const bool fresnel : {false, true}) {
        Material16 m;
        m.albedo = many_albedos;
        m.sigma_t = spread(9.0, 11.0);
        m.eta = 1.5;
        m.fresnel = fresnel;
        const double mu = 0.7;
        const Measured r = measure(beam_scene(m, box_below(20.0, 10.0), mu), 1, 1u << 16);
        CHECK(r.missed == 0.0);
        for (std::size_t k = 0; k < wavelengths; ++k) {
            const Reflected expected = exact(m, k, mu);
            CAPTURE(fresnel, m.albedo[k]);
            check_mean(r.total[k], expected.total, 2.5e-3);
            check_mean(r.map[STOKES_MAP_SINGLE][k], expected.single, 2e-3);
        }
    }
}

TEST_CASE("a mesh with a hole in it is refused", "[walk]") {
    Mesh mesh = box_below(4.0, 2.0);
    mesh.triangles.pop_back();
    const Scene walked = beam_scene({}, mesh, 1.0);
    CHECK(input_error([&] { DeviceScene(test_device(), walked); }).find("body") != std::string::npos);
    Scene tabulated = walked;
    tabulated.render.transport = Transport::paper;
    tabulated.media[0].sigma_s = Spectrum::constant(1.0);
    CHECK_NOTHROW(DeviceScene(test_device(), tabulated));
}
