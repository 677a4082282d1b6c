#include "tests/support/catch.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/photon_passes.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

// Excitation and emission overlap, as those of quantum dots do.
Fluorophore overlapping() {
    Fluorophore fluorophore;
    fluorophore.name = "dot";
    fluorophore.excitation = {{300.0, 400.0, 640.0}, {1.0, 0.6, 0.0}, Outside::zero};
    fluorophore.emission = {{450.0, 545.0, 640.0}, {0.0, 1.0, 0.0}, Outside::zero};
    return fluorophore;
}

// A plane of surface fluorescence, c = 1, under a parallel beam; its interior is seen from above.
Scene plane_scene(const Spectrum& irradiance) {
    Scene scene = empty_scene("plane");
    scene.render.transport = Transport::paper;
    scene.fluorophores = {overlapping()};
    scene.materials = {{"paint", TranslucentMaterial{std::nullopt, {{0, 1.0}}, false}}};
    add_shape(scene, "plane", 0, make_rectangle(1000.0, 1000.0));
    scene.lights = {disk_beam({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, 80.0, irradiance)};
    scene.camera = camera_above({0.0, 0.0, 0.0}, 400.0, 60.0);
    scene.film = {8, 8, {}};
    scene.render.photons_per_pass = 20000;
    scene.render.radius_mm = 12.0;
    return scene;
}

// K F(lambda) / pi of eq. 1-2 at each wavelength of the set, sums over the other members with (N-1)/(n-1);
// strictly above the excitation only.
std::array<double, 16> emitted_radiance(const Scene& scene, const WavelengthSet& set, const Spectrum& irradiance) {
    const Fluorophore& dot = scene.fluorophores[0];
    const double pair_weight = double(scene.render.lambda_max_nm - scene.render.lambda_min_nm) / 15.0;
    std::array<double, 16> radiance{};
    for (std::size_t em = 0; em < 16; ++em)
        for (std::size_t ex = 0; ex < 16; ++ex)
            if (set[em] > set[ex])
                radiance[em] += 2.0e-2 * pair_weight * irradiance.at(set[ex]) * dot.excitation.at(set[ex]) *
                                dot.emission.at(set[em]) / M_PI;
    return radiance;
}

// The deposits of a pass, summed over photons: [map][wavelength] [W/nm].
std::array<std::array<double, 16>, STOKES_MAP_COUNT> deposited(const Scene& scene, std::uint32_t pass) {
    PhotonPasses passes(scene);
    passes.trace(pass);
    std::array<std::array<double, 16>, STOKES_MAP_COUNT> sums{};
    for (std::size_t m = 0; m < sums.size(); ++m) {
        const Deposits deposits = passes.deposits(m);
        for (std::size_t i = 0; i < deposits.heads.size(); ++i)
            if (deposits.heads[i].normal != STOKES_EMPTY_SLOT)
                for (std::size_t k = 0; k < 16; ++k) sums[m][k] += static_cast<double>(deposits.flux[i].v[k]);
    }
    return sums;
}

const Spectrum broad = {{300.0, 500.0, 780.0}, {3.0, 1.0, 2.0}, Outside::zero};

}  // namespace

TEST_CASE("a fluorescent plane has radiance K F / pi", "[fluorescence]") {
    const Scene scene = plane_scene(broad);
    Renderer renderer(test_device(), scene);
    PassImages images(renderer);
    std::array<Sample, 3> ratio;
    for (std::uint32_t pass = 0; pass < 16; ++pass) {
        const WavelengthSet set = wavelengths_of(scene, pass);
        const std::array<double, 16> radiance = emitted_radiance(scene, set, broad);
        const glm::dvec3 expected = film_xyz(scene, set, [&](std::size_t i) { return radiance[i]; });
        const FilmImage image = images.next(pass);
        const glm::dvec3 seen = mean_xyz(image, Layer::fluorescence);
        for (int c = 0; c < 3; ++c)
            if (expected[c] > 0.0) ratio[static_cast<std::size_t>(c)].add(seen[c] / expected[c]);
        for (const Layer none : {Layer::single, Layer::multiple, Layer::surface})
            CHECK(mean_xyz(image, none) == glm::dvec3(0.0));
    }
    for (const Sample& r : ratio) {
        CAPTURE(r.mean(), r.standard_error(), r.count());
        CHECK(r.count() > 12);
        CHECK(r.standard_error() < 0.01);
        CHECK(std::abs(normal_of_t(r.z(1.0), static_cast<double>(r.count() - 1))) < 4.5);
    }
}

// Sixteen integers and sixteen wavelengths: all are in the set of every pass, 560 nm among them. The beam has
// light at 560 nm alone, the fluorophore could emit at all of them.
TEST_CASE("light of one wavelength is re-radiated above it only", "[fluorescence]") {
    const Spectrum line = {{559.5, 560.0, 560.5}, {0.0, 5.0, 0.0}, Outside::zero};
    for (const bool subsurface : {false, true}) {
        CAPTURE(subsurface);
        Scene scene = subsurface ? slab_scene(1.0, 0.0) : plane_scene(line);
        if (subsurface) {
            scene.fluorophores = {overlapping()};
            scene.lights[0].flux = line.scaled(1e-3);
        }
        scene.render.lambda_min_nm = 552;
        scene.render.lambda_max_nm = 567;
        const auto sums = deposited(scene, 0);
        const WavelengthSet set = wavelengths_of(scene, 0);
        REQUIRE(set.front() == 552);
        REQUIRE(set.back() == 567);
        for (std::size_t k = 0; k < 16; ++k) {
            CAPTURE(set[k]);
            if (set[k] > 560)
                CHECK(sums[STOKES_MAP_FLUORESCENCE][k] > 0.0);
            else
                CHECK(sums[STOKES_MAP_FLUORESCENCE][k] == 0.0);
            for (const int none : {STOKES_MAP_SINGLE, STOKES_MAP_MULTIPLE, STOKES_MAP_SURFACE})
                CHECK(sums[static_cast<std::size_t>(none)][k] == 0.0);
        }
        if (subsurface) continue;
        // K is eta E Phi dlambda of the one line; dlambda is 1 nm, for all the wavelengths are there.
        const double flux = scene.lights[0].flux.at(560.0);
        const Fluorophore& dot = scene.fluorophores[0];
        for (std::size_t k = 9; k < 16; ++k)
            CHECK(sums[STOKES_MAP_FLUORESCENCE][k] ==
                  Approx(2e-2 * flux * dot.excitation.at(560.0) * dot.emission.at(set[k])).epsilon(1e-4));
    }
}

// All light that leaves a slab is in a picture that is wide enough: pi times the integral of radiance over
// the area is the flux in the maps (which test_paper_slab compares with the model). The same pass, so the
// same photons: what remains is the draw of one point a pixel. Light leaves within 9.9 mm of the beam, 1 mm
// thin; the density estimate spreads it by 3 mm; the picture's half edge is 20 mm. Of 96 pixels
// instead of 192 one pass was off by 0.5 %.
TEST_CASE("a wide picture of a slab holds all the light that leaves it", "[fluorescence]") {
    Scene scene = slab_scene(0.5, 0.0);
    const double edge_mm = 40.0;
    scene.camera = camera_above({0.0, 0.0, 0.0}, 200.0, edge_mm);
    scene.film = {192, 192, {}};
    scene.render.photons_per_pass = 20000;
    scene.render.radius_mm = 3.0;
    for (const std::uint32_t pass : {0u, 1u}) {
        CAPTURE(pass);
        Renderer renderer(test_device(), scene);
        renderer.render_pass(pass);
        const FilmImage image = renderer.image();
        const auto sums = deposited(scene, pass);
        const WavelengthSet set = wavelengths_of(scene, pass);
        for (std::size_t m = 0; m < STOKES_MAP_COUNT; ++m) {
            CAPTURE(m);
            const glm::dvec3 expected = film_xyz(scene, set, [&](std::size_t i) { return sums[m][i]; });
            const glm::dvec3 seen = mean_xyz(image, static_cast<Layer>(m)) * M_PI * edge_mm * edge_mm * 1e-6;
            for (int c = 0; c < 3; ++c) {
                CAPTURE(c);
                if (m == STOKES_MAP_SURFACE)
                    CHECK(seen[c] == 0.0);
                else
                    CHECK(seen[c] == Approx(expected[c]).epsilon(0.005));
            }
        }
    }
}
