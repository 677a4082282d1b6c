#include <cmath>
#include <cstring>

#include "host/core/error.hpp"
#include "host/image/colour.hpp"
#include "host/render/device_lights.hpp"
#include "host/render/device_materials.hpp"
#include "host/render/pass_spectra.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

Spectrum ramp(double at_300, double at_780) { return {{300.0, 780.0}, {at_300, at_780}, Outside::zero}; }

// A surface light, a beam and a dark one; two materials and a fluorophore.
Scene spectral_scene() {
    Scene scene;
    scene.render.transport = Transport::paper;
    scene.file = "spectra.json";
    scene.render.seed = 5;
    Beam beam;
    beam.half_u_mm = {3.0, 0.0, 0.0};
    beam.half_v_mm = {0.0, 0.0, 2.0};
    scene.lights = {{"surface", ramp(1.0, 3.0), SurfaceLight{0}},
                    {"beam", ramp(0.5, 0.0), RectangleBeam{beam}},
                    {"dark", Spectrum::constant(0.0), DiskBeam{beam}}};
    scene.materials = {diffuse_material(0.5), {"red", DiffuseMaterial{ramp(0.0, 0.9), nullptr, {}}}};
    Fluorophore dye;
    dye.excitation = ramp(1.0, 0.0);
    dye.emission = ramp(0.0, 1.0);
    scene.fluorophores = {dye};
    return scene;
}

const std::vector<double> spread = {M_PI * 25.0, 24.0, 4.0};

}  // namespace

// Powers by the sum over 300..780 nm of the ramps: mean of the ends times 481.
TEST_CASE("lights are chosen in proportion to their power", "[pass_spectra]") {
    const std::vector<double> p = light_probabilities(spectral_scene());
    REQUIRE(p.size() == 3);
    CHECK(p[0] == Approx(2.0 / 2.25).epsilon(1e-12));
    CHECK(p[1] == Approx(0.25 / 2.25).epsilon(1e-12));
    CHECK(p[2] == 0.0);
}

TEST_CASE("a scene whose lights are dark in the rendered range is refused", "[pass_spectra]") {
    Scene scene = spectral_scene();
    for (Light& light : scene.lights) light.flux = {{200.0, 250.0}, {1.0, 1.0}, Outside::zero};
    CHECK_THROWS_AS(light_probabilities(scene), InputError);
    scene.lights.clear();
    CHECK_THROWS_AS(light_probabilities(scene), InputError);
}

TEST_CASE("the photons of a light carry its flux in the mean", "[pass_spectra]") {
    const Scene scene = spectral_scene();
    const std::vector<double> p = light_probabilities(scene);
    constexpr std::uint32_t photons = 10000;
    const PassSpectra pass = make_pass_spectra(scene, p, spread, 3, photons);
    const WavelengthSet set = draw_wavelengths(5, 3, 300, 780);
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        for (std::size_t k = 0; k < set.size(); ++k) {
            const double flux = scene.lights[i].flux.at(set[k]);
            CHECK(static_cast<double>(pass.photon_flux[i].v[k]) * p[i] * photons == Approx(flux).epsilon(1e-6));
        }
}

// A diffuse emitter of flux Phi and area A has radiance Phi / (pi A), a beam of section A the irradiance Phi / A.
TEST_CASE("the radiance of an emitter is its flux over pi and its area, that of a beam its irradiance",
          "[pass_spectra]") {
    Scene scene = spectral_scene();
    scene.shapes.resize(1);  // a square of 5 mm
    scene.shapes[0].mesh.positions_mm = {{0.0f, 0.0f, 0.0f}, {5.0f, 0.0f, 0.0f}};
    const std::vector<Triangle> square = {{0, 0, 0, 0, 5, 0, 0, 0, 0, 5, 0, 0}, {5, 5, 0, 0, -5, 0, 0, 0, 0, -5, 0, 0}};
    const std::vector<double> p = light_probabilities(scene);
    const LightTables tables = light_tables(scene, p, std::vector<EmissionBounds>(scene.lights.size()), square, {0, 2});
    const PassSpectra pass = make_pass_spectra(scene, p, tables.spread, 3, 100);
    CHECK(tables.spread[2] == Approx(M_PI * 6.0));  // a disk, or an ellipse
    for (std::size_t k = 0; k < STOKES_WAVELENGTHS; ++k) {
        const double lambda_nm = pass.constants.lambda_nm[k];
        const double flux = scene.lights[0].flux.at(lambda_nm);
        CHECK(static_cast<double>(pass.radiance[0].v[k]) == Approx(flux / (M_PI * 25.0)).epsilon(1e-6));
        const double beam = scene.lights[1].flux.at(lambda_nm);
        CHECK(static_cast<double>(pass.radiance[1].v[k]) == Approx(beam / 24.0).epsilon(1e-6));
        CHECK(pass.radiance[2].v[k] == 0.0f);
    }
}

TEST_CASE("rows stand where the layout says", "[pass_spectra]") {
    Scene scene = spectral_scene();
    scene.fluorophores.push_back(scene.fluorophores.front());
    scene.fluorophores.back().conversion = 0.05;
    for (const int f : {1, 0})
        scene.materials.push_back({"dyed", TranslucentMaterial{std::nullopt, {{f, 0.3}}, false}});
    const SpectraLayout layout(scene);
    const PassSpectra pass = make_pass_spectra(scene, light_probabilities(scene), spread, 1, 100);
    REQUIRE(pass.rows.size() == layout.row_count);
    const WavelengthSet set = draw_wavelengths(5, 1, 300, 780);
    const auto value = [&](std::uint32_t row, std::size_t k) { return static_cast<double>(pass.rows[row].v[k]); };
    for (std::size_t k = 0; k < set.size(); ++k) {
        CHECK(value(0, k) == 0.5);
        CHECK(value(1, k) == Approx(as_diffuse(scene.materials[1])->reflectance.at(set[k])).epsilon(1e-6));
    }
    for (const std::size_t m : {std::size_t{2}, std::size_t{3}}) {
        const Fluorophore& dye = scene.fluorophores[3 - m];
        const std::uint32_t excitation = layout.excitation_row[m];
        const auto expected = reradiation_rows(dye, Transport::paper, set, 32.0);
        for (std::uint32_t ex = 0; ex < STOKES_WAVELENGTHS; ++ex) {
            CHECK(value(excitation, ex) == Approx(dye.excitation.at(set[ex])).epsilon(1e-6));
            CHECK(std::memcmp(&pass.rows[excitation + 1 + ex], &expected[ex], sizeof(Flux16)) == 0);
        }
    }
}

// Kernels take c times the rows: of 0.1 and 0.3 the rows are a quarter of the first dye's and three of the second's.
TEST_CASE("the rows of several fluorophores are sums of each one's by its share", "[pass_spectra]") {
    Scene scene = spectral_scene();
    Fluorophore other = scene.fluorophores.front();
    other.excitation = ramp(0.2, 0.7);
    other.emission = ramp(0.4, 0.3);
    scene.fluorophores.push_back(other);
    scene.materials = {{"both", TranslucentMaterial{std::nullopt, {{0, 0.1}, {1, 0.3}}, false}},
                       {"first", TranslucentMaterial{std::nullopt, {{0, 0.1}}, false}},
                       {"second", TranslucentMaterial{std::nullopt, {{1, 0.3}}, false}}};
    for (const Transport transport : {Transport::paper, Transport::conserving}) {
        scene.render.transport = transport;
        const SpectraLayout layout(scene);
        const PassSpectra pass = make_pass_spectra(scene, light_probabilities(scene), spread, 1, 100);
        for (std::uint32_t row = 0; row < 17; ++row)
            for (std::size_t k = 0; k < STOKES_WAVELENGTHS; ++k) {
                const auto of = [&](std::size_t m) {
                    return static_cast<double>(pass.rows[layout.excitation_row[m] + row].v[k]);
                };
                CHECK(of(0) == Approx(0.25 * of(1) + 0.75 * of(2)).epsilon(1e-6));
            }
        const std::vector<MaterialRecord> records = material_records(scene);
        CHECK(records[0].fluorescent_fraction == 0.4f);
        CHECK(
            (records[0].flags == STOKES_MATERIAL_FLUORESCENT && records[0].excitation_row == layout.excitation_row[0]));
    }
    CHECK(dye_weights({{0, 0.3}}) == std::vector<double>{1.0});
    CHECK(dye_weights({{0, 0.0}, {1, 0.0}}) == std::vector<double>{0.5, 0.5});
}

// Photons come out as the quantum yield says, for each excitation wavelength: the mean over many sets of the row's sum
// of photons, by the pair weight, is that of the full sum over all wavelengths above it.
TEST_CASE("conserving re-radiation emits the quantum yield in photons", "[pass_spectra]") {
    Fluorophore dye = spectral_scene().fluorophores.front();
    dye.quantum_yield = 0.7;
    const auto [ex, rule] = GENERATE(table<int, std::optional<StokesRule>>({{330, std::nullopt},
                                                                            {400, StokesRule::keep_yield},
                                                                            {470, std::nullopt},
                                                                            {400, StokesRule::truncate},
                                                                            {470, StokesRule::truncate}}));
    dye.stokes_rule = rule;
    {
        // Of all that is emitted, what lies above the excitation, or all of it; of that, what lies within the render.
        const bool keep = rule != StokesRule::truncate;
        const double whole = dye.emission.sum_1nm(keep ? ex + 1 : 300, 830);
        const double expected = 0.7 * dye.excitation.at(ex) * dye.emission.sum_1nm(ex + 1, 780) / whole;
        Sample photons;
        for (std::uint32_t pass = 0; pass < 200000 && photons.count() < 4000; ++pass) {
            const WavelengthSet set = draw_wavelengths(8, pass, 300, 780);
            const auto at = std::find(set.begin(), set.end(), ex);
            if (at == set.end()) continue;
            const auto rows = reradiation_rows(dye, Transport::conserving, set, pair_weight_nm(300, 780));
            double total = 0.0;
            for (std::size_t em = 0; em < set.size(); ++em)
                total += static_cast<double>(rows[static_cast<std::size_t>(at - set.begin())].v[em]) * set[em] / ex;
            photons.add(total);
        }
        CAPTURE(ex, expected, photons.mean());
        CHECK(photons.standard_error() < 0.05 * 0.7);
        CHECK(std::abs(photons.mean() - expected) <= 4.0 * photons.standard_error() + 1e-9);
    }
}

TEST_CASE("the last rows are the extinction coefficient and the albedo of the media", "[pass_spectra]") {
    Scene scene = spectral_scene();
    Medium medium;
    medium.sigma_s = {{300.0, 800.0}, {1.0, 2.0}, Outside::hold};
    medium.sigma_a = Spectrum::constant(0.5);
    scene.media = {Medium{}, medium};
    scene.media[0].sigma_s = scene.media[0].sigma_a = Spectrum::constant(1.0);
    const SpectraLayout layout(scene);
    const PassSpectra pass = make_pass_spectra(scene, light_probabilities(scene), spread, 1, 100);
    REQUIRE(layout.sigma_row(1) + 2 == layout.row_count);
    for (std::size_t k = 0; k < STOKES_WAVELENGTHS; ++k) {
        const double s = medium.sigma_s.at(static_cast<double>(pass.constants.lambda_nm[k]));
        CHECK(static_cast<double>(pass.rows[layout.sigma_row(1)].v[k]) == Approx(s + 0.5).epsilon(1e-6));
        CHECK(static_cast<double>(pass.rows[layout.sigma_row(1) + 1].v[k]) == Approx(s / (s + 0.5)).epsilon(1e-6));
        CHECK(pass.rows[layout.sigma_row(0)].v[k] == 2.0f);
    }
}

TEST_CASE("the constants of a pass are its own", "[pass_spectra]") {
    const Scene scene = spectral_scene();
    const PassSpectra pass = make_pass_spectra(scene, light_probabilities(scene), spread, 3, 12345);
    const WavelengthSet set = draw_wavelengths(5, 3, 300, 780);
    for (std::size_t k = 0; k < set.size(); ++k) CHECK(pass.constants.lambda_nm[k] == static_cast<float>(set[k]));
    CHECK(pass.constants.seed == 5);
    CHECK(pass.constants.pass == 3);
    CHECK(pass.constants.photons == 12345);
    CHECK(pass.constants.chain[0] == 1.0f);
    CHECK(pass.constants.chain[1] == Approx(479.0 / 14.0 / 32.0));
    CHECK(pass.constants.chain[14] == Approx(466.0 / 1.0 / 32.0));
    CHECK(pass.constants.chain[15] == 0.0f);  // no sixteenth wavelength after the first
}

// xyz_of() sums over every nanometre of 300..830; light beyond 780 nm is not rendered, so the spectrum ends
// there. The mean over passes is within 3.5 standard errors, and those are below 0.5 %.
TEST_CASE("the tristimulus weights of many passes give the colour of a spectrum", "[pass_spectra]") {
    const Scene scene = spectral_scene();
    const Spectrum radiance{{380.0, 550.0, 780.0}, {0.2, 1.0, 0.6}, Outside::zero};  // [W m^-2 sr^-1 nm^-1]
    const std::vector<double> p = light_probabilities(scene);
    std::array<Sample, 3> xyz;
    for (std::uint32_t pass = 0; pass < 20000; ++pass) {
        const PassConstants c = make_pass_spectra(scene, p, spread, pass, 1).constants;
        std::array<double, 3> sum{};
        for (std::size_t k = 0; k < STOKES_WAVELENGTHS; ++k) {
            const double per_mm2 = 1e-6 * radiance.at(c.lambda_nm[k]);
            sum[0] += static_cast<double>(c.to_x[k]) * per_mm2;
            sum[1] += static_cast<double>(c.to_y[k]) * per_mm2;
            sum[2] += static_cast<double>(c.to_z[k]) * per_mm2;
        }
        for (std::size_t k = 0; k < 3; ++k) xyz[k].add(sum[k]);
    }
    const glm::dvec3 expected = xyz_of(radiance);
    for (int k = 0; k < 3; ++k) {
        const Sample& sample = xyz[static_cast<std::size_t>(k)];
        CAPTURE(k, expected[k], sample.mean());
        CHECK(sample.standard_error() < 0.005 * expected[k]);
        CHECK(std::abs(sample.z(expected[k])) < 3.5);
    }
}
