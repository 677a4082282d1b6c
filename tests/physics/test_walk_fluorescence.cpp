// Fluorescence by model `walk` against exact transport theory (PHYSICS sections 4 and 5).
#include "host/render/pass_spectra.hpp"
#include "tests/support/beam_fixture.hpp"

using namespace stokes;

namespace {

// c times the re-radiation matrix.
double conversion(const Scene& scene, std::size_t ex, std::size_t em) {
    const PassWavelengths w = test_wavelengths();
    const auto rows = reradiation_rows(scene.fluorophores[0], Transport::walk, w.set, w.pair_weight_nm);
    return fluorescent_fraction(as_translucent(scene.materials[0])->dyes) * static_cast<double>(rows[ex].v[em]);
}

Material16 fluorescent() {
    Material16 m;
    m.albedo = {0.6, 0.7, 0.5, 0.55, 0.65, 0.75, 0.8, 0.85, 0.9, 0.95, 0.3, 0.98, 0.99, 0.35, 0.92, 0.88};
    m.fraction = 0.8;
    m.excitation = all(0.0);
    m.excitation[0] = 1.0;
    m.excitation[1] = 0.5;
    m.excitation[2] = 0.25;
    m.emission = all(0.5);
    m.emission[0] = 0.0;
    return m;
}

}  // namespace

// The escaping share of the re-emitted light is (1 - sqrt(1 - a) H(1/k))/a at normal incidence, eta = 1; escaping_share
// is checked against H elsewhere.
TEST_CASE("fluorescence of the first collision leaves as exact transport says", "[walk]") {
    for (const bool fresnel : {false, true}) {
        Material16 m = fluorescent();
        m.sigma_t = spread(0.5, 1.5);
        m.eta = 1.5;
        m.fresnel = fresnel;
        const double mu = 0.8, within = cosine_within(1.5, mu);
        const double entering = fresnel ? 1.0 - internal_reflectance(within, 1.5) : 1.0;
        const Scene scene = beam_scene(m, wide_sheet(), mu);
        const Measured r = measure(scene, 2, 1u << 17);
        CHECK(r.imbalance < 1e-5);
        for (std::size_t em = 0; em < wavelengths; ++em) {
            double expected = 0.0;
            for (std::size_t ex = 0; ex < std::min(em, std::size_t{3}); ++ex)
                expected +=
                    entering * conversion(scene, ex, em) *
                    escaping_share(fresnel ? 1.5 : 1.0, within, m.albedo[em], m.sigma_t[em] / m.sigma_t[ex]).total;
            CAPTURE(em, fresnel, expected);
            check_mean(r.map[STOKES_MAP_FLUORESCENCE][em], expected, 0.03 * expected + 1e-9);
            const Reflected without = exact(m, em, mu);
            const double other = 1.0 - m.fraction * m.excitation[em];
            check_mean(r.map[STOKES_MAP_SINGLE][em], other * without.single, 1.5e-3);
            CHECK(r.total[em].mean() - r.map[STOKES_MAP_FLUORESCENCE][em].mean() ==
                  Approx(without.specular + other * (without.total - without.specular)).margin(5e-3));
        }
    }
}

// With one extinction coefficient, light that scatters with albedo a reflects R(a) = a X(a), X(a) = <s, (1 - a K)^-1
// u>, s the first collisions, K from emission to the next collision, u the direct escape. Light taken up at any
// collision is re-emitted and scatters with another albedo b: <s, (1 - a K)^-1 (1 - b K)^-1 u> = (R(a) - R(b))/(a - b);
// where that light is taken up again, at its collisions, and re-emitted to scatter with albedo d: <s, (1 - a K)^-1 (1 -
// b K)^-1 K (1 - d K)^-1 u> = R(a)/((a - b)(a - d)) + R(b)/((b - a)(b - d)) + R(d)/((d - a)(d - b)).
TEST_CASE("fluorescence at every collision, re-absorption included, is exact", "[walk]") {
    Material16 m = fluorescent();
    m.first_collision_only = false;
    m.excitation[2] = 0.0;
    m.eta = 1.5;
    m.fresnel = true;
    const double within = cosine_within(1.5, 1.0), specular = internal_reflectance(within, 1.5);
    const Scene scene = beam_scene(m, wide_sheet(), 1.0);
    const PassWavelengths pass = test_wavelengths();
    const auto albedo = [&](std::size_t k) { return m.albedo[k] * (1.0 - m.fraction * m.excitation[k]); };
    const auto reflectance = [&](double a) { return (1.0 - specular) * a * escaping_share(1.5, within, a).total; };
    const Measured r = measure(scene, 2, 1u << 17);
    CHECK(r.imbalance < 1e-5);
    const double a0 = albedo(0), a1 = albedo(1), r0 = reflectance(a0), r1 = reflectance(a1);
    for (std::size_t em = 0; em < wavelengths; ++em) {
        const double b = albedo(em), rb = reflectance(b);
        double expected = 0.0;
        if (em == 1) expected = conversion(scene, 0, 1) * (r0 - rb) / (a0 - b);
        if (em >= 2) {
            expected =
                conversion(scene, 0, em) * (r0 - rb) / (a0 - b) + conversion(scene, 1, em) * (r1 - rb) / (a1 - b);
            const double twice = r0 / ((a0 - a1) * (a0 - b)) + r1 / ((a1 - a0) * (a1 - b)) + rb / ((b - a0) * (b - a1));
            expected += conversion(scene, 0, 1) * conversion(scene, 1, em) * pass.chain[1] * twice;
        }
        CAPTURE(em);
        check_mean(r.map[STOKES_MAP_FLUORESCENCE][em], expected, 0.03 * expected + 1e-9);
        CHECK(r.total[em].mean() - r.map[STOKES_MAP_FLUORESCENCE][em].mean() == Approx(specular + rb).margin(5e-3));
    }
}
