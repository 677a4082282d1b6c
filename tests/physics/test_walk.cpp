// Model `walk` in half-spaces against exact transport theory (PHYSICS sections 4 and 5).
#include "tests/support/beam_fixture.hpp"

using namespace stokes;

namespace {

void check_half_space(const Material16& m, double mu, std::uint32_t batches, std::uint32_t photons,
                      double largest_error) {
    CAPTURE(m.eta, m.fresnel, mu);
    const Measured r = measure(beam_scene(m, wide_sheet(), mu), batches, photons);
    CHECK(r.imbalance < 1e-5);
    CHECK(r.missed < 1e-4);
    for (std::size_t k = 0; k < wavelengths; ++k) {
        const Reflected expected = exact(m, k, mu);
        CAPTURE(m.sigma_t[k], m.albedo[k]);
        check_mean(r.total[k], expected.total, largest_error);
        check_mean(r.map[STOKES_MAP_SINGLE][k], expected.single, largest_error);
        CHECK(r.map[STOKES_MAP_FLUORESCENCE][k].mean() == 0.0);
    }
}

}  // namespace

TEST_CASE("a half-space reflects what exact transport says", "[walk]") {
    Material16 m;
    m.albedo = many_albedos;
    for (const double mu : {1.0, 0.5, 0.15}) check_half_space(m, mu, 1, 1u << 18, 1e-3);
}

// The weights of the wavelengths that did not lead.
TEST_CASE("wavelengths of different mean free paths walk together, and each gives its own answer", "[walk]") {
    Material16 m;
    m.albedo = many_albedos;
    m.sigma_t = spread(0.4, 1.6);
    for (const double mu : {1.0, 0.3}) check_half_space(m, mu, 2, 1u << 17, 1.5e-3);
}

// PHYSICS section 4 gives these four.
TEST_CASE("a half-space below a refracting surface reflects what exact transport says", "[walk]") {
    struct {
        double eta, albedo, expected;
    } const known[] = {{1.5, 0.9, 0.2599}, {1.5, 0.99, 0.6020}, {1.33, 0.9, 0.2948}, {1.33, 0.99, 0.6530}};
    for (const auto& c : known) {
        Material16 m;
        m.albedo.fill(c.albedo);
        m.eta = c.eta;
        m.fresnel = true;
        CHECK(exact(m, 0, 1.0).total == Approx(c.expected).margin(5e-5));
    }
    for (const double eta : {1.5, 1.33})
        for (const double mu : {1.0, 0.4}) {
            Material16 m;
            m.albedo = many_albedos;
            m.eta = eta;
            m.fresnel = true;
            m.sigma_t = spread(0.9, 1.1);
            check_half_space(m, mu, 1, 1u << 18, 1.2e-3);
        }
}

TEST_CASE("reflectances to 5e-4", "[.long]") {
    Material16 m;
    m.albedo = many_albedos;
    for (const double mu : {1.0, 0.5, 0.15}) check_half_space(m, mu, 4, 1u << 19, 5e-4);
    m.eta = 1.5;
    m.fresnel = true;
    for (const double mu : {1.0, 0.4}) check_half_space(m, mu, 4, 1u << 19, 5e-4);
    m.fresnel = false;
    m.sigma_t = spread(0.6, 1.2);
    check_half_space(m, 0.7, 6, 1u << 19, 5e-4);
}

// Nearly without loss light gets thousands of mean free paths deep.
TEST_CASE("weak absorption, and none, in a half-space", "[walk]") {
    Material16 m;
    m.albedo = {0.99,    0.995,   0.998,    0.999,    0.9995,    0.9998, 0.9999, 0.99995,
                0.99998, 0.99999, 0.999995, 0.999999, 0.9999995, 1.0,    1.0,    1.0};
    check_half_space(m, 1.0, 1, 1u << 17, 1.1e-3);
    m.eta = 1.5;
    m.fresnel = true;
    check_half_space(m, 0.5, 1, 1u << 17, 1.6e-3);
}

TEST_CASE("without loss everything comes out of a half-space", "[walk]") {
    for (const bool fresnel : {false, true}) {
        Material16 m;
        m.sigma_t = spread(0.8, 1.2);
        m.eta = 1.5;
        m.fresnel = fresnel;
        const Measured r = measure(beam_scene(m, wide_sheet(), 0.6), 1, 1u << 17);
        CHECK(r.absorbed == 0.0);
        CHECK(r.dropped < 1e-4);
        Sample sum;
        for (const Sample& s : r.total) {
            check_mean(s, 1.0, 4e-3);
            sum.add(s.mean());
        }
        CHECK(sum.mean() == Approx(1.0).margin(1e-4));  // weights take from one wavelength what they give to another
    }
}

TEST_CASE("light that leaves beyond the end of a sheet is a missed exit, and counted", "[walk]") {
    Mesh mesh = wide_sheet();
    for (glm::vec3& p : mesh.positions_mm) p *= 2e-6f;
    const Measured r = measure(beam_scene({}, mesh, 1.0), 1, 1u << 14);
    CHECK(r.missed > 0.05);
    CHECK(r.dropped == Approx(r.missed).epsilon(0.02));
    CHECK(r.imbalance < 1e-5);
}
