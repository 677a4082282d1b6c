// Light of the same irradiance makes the same picture with the same noise, however far beyond the scene the light that
// it comes from reaches.
#include <cmath>

#include "host/render/renderer.hpp"
#include "host/render/translucent_bodies.hpp"
#include "host/scene/mesh/mesh.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

constexpr std::uint32_t passes = 4;
constexpr std::size_t seeds = 6;

// Straight down from y = 200 mm, with the irradiance of flux over 1 mm^2; half_mm: radius, or half of a side.
template <class Kind>
Light beam_down(double half_mm, const Spectrum& flux) {
    Kind beam;
    beam.position_mm = {0.0, 200.0, 0.0};
    beam.half_u_mm = {half_mm, 0.0, 0.0};
    beam.half_v_mm = {0.0, 0.0, half_mm};
    const double area = (std::is_same_v<Kind, DiskBeam> ? M_PI : 4.0) * half_mm * half_mm;
    return {"beam", flux.scaled(area), beam};
}

// A ball of 30 mm on a floor, under a light; no lamp. floor_mm: its side.
Scene ball_under(const Light& light, double floor_mm = 120.0) {
    Scene scene = small_scene(Transport::conserving);
    scene.shapes.resize(2);
    scene.shapes[0].mesh = make_rectangle(floor_mm, floor_mm);
    scene.body_count = 2;
    scene.lights = {light};
    scene.film = {24, 24, {}};
    scene.render.photons_per_pass = 4096;
    scene.render.radius_mm = 4.0;
    return scene;
}

// Light per pixel of what comes out of the ball, seed by seed: its mean over the picture, and the variance of pixels.
struct Glow {
    std::vector<double> means;
    double variance = 0.0, emitted = 0.0, imbalance = 0.0, stored = 0.0;
    std::vector<int> unmet;
};

Glow glow(Scene scene, Emission emission) {
    Glow result;
    scene.render.emission = emission;
    std::vector<Sample> pixels(24 * 24);
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        scene.render.seed = seed;
        Renderer renderer(test_device(), scene);
        for (std::uint32_t pass = 0; pass < passes; ++pass) renderer.render_pass(pass);
        const FilmImage image = renderer.image();
        double sum = 0.0;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            double y = 0.0;
            for (const Layer layer : {Layer::fluorescence, Layer::single, Layer::multiple})
                y += static_cast<double>(image.xyz[static_cast<std::size_t>(layer)][3 * i + 1]);
            pixels[i].add(y);
            sum += y;
        }
        result.means.push_back(sum / static_cast<double>(pixels.size()));
        const Ledger ledger = renderer.book().ledger();
        result.emitted += ledger.power.emitted / seeds;
        result.stored += ledger.power.stored / seeds;
        result.imbalance = std::max(result.imbalance, std::abs(ledger.power.imbalance()));
        result.unmet = renderer.unmet_bodies();
    }
    for (const Sample& pixel : pixels) result.variance += pixel.variance();
    return result;
}

// The same seeds draw the same wavelengths in both, so that the means differ by the noise of the photons alone: 5
// degrees of freedom, 6 standard errors, which chance exceeds once in 500 of ten comparisons with these seeds.
void check_same(const Glow& a, const Glow& b) {
    Sample difference, level;
    for (std::size_t i = 0; i < seeds; ++i) difference.add(b.means[i] - a.means[i]), level.add(a.means[i]);
    CAPTURE(level.mean(), difference.mean(), difference.standard_error(), a.variance, b.variance);
    CHECK(std::abs(difference.mean()) < 6.0 * difference.standard_error());
    CHECK(difference.standard_error() < 0.03 * level.mean());
    CHECK(b.unmet.empty());
    CHECK(b.imbalance < 1e-5);
}

const Spectrum flux = {{300.0, 360.0, 420.0, 780.0}, {0.0, 1e-5, 1e-6, 1e-6}, Outside::zero};

}  // namespace

// The beams of 90 mm cover the floor, whose corners lie 85 mm from its middle.
TEST_CASE("a beam of 30 m makes the picture of one that covers the scene", "[wide_beams]") {
    for (const Emission emission : {Emission::random, Emission::stratified, Emission::aimed}) {
        CAPTURE(static_cast<int>(emission));
        const Glow narrow = glow(ball_under(beam_down<DiskBeam>(90.0, flux)), emission);
        for (const Light& light : {beam_down<DiskBeam>(30000.0, flux), beam_down<RectangleBeam>(30000.0, flux)}) {
            const Glow wide = glow(ball_under(light), emission);
            check_same(narrow, wide);
            CHECK(wide.variance < 2.0 * narrow.variance);
            CHECK(narrow.variance < 4.0 * wide.variance);
            // The ledger has the power of the whole beam, and what is stored is that of the picture.
            const double section = std::holds_alternative<DiskBeam>(light.kind) ? M_PI * 9e8 : 36e8;
            CHECK(wide.emitted / section == Approx(narrow.emitted / (M_PI * 8100.0)).epsilon(1e-4));
            CHECK(wide.stored == Approx(narrow.stored).epsilon(0.05));
        }
    }
}

// At 100 m the light of a lamp is a beam, whose irradiance is its radiance times its area over the square of the
// distance: flux/(pi d^2). The lamp's directions differ by the ball's 15 mm over 100 m.
TEST_CASE("a lamp 100 m away lights as a beam of the same irradiance", "[wide_beams]") {
    constexpr double d = 1e5;
    const Glow beam = glow(ball_under(beam_down<DiskBeam>(90.0, flux)), Emission::stratified);
    Scene scene = ball_under(Light{});
    Shape& lamp = add_shape(scene, "lamp", 2, moved(turned_over(make_disk(100.0, 24)), {0.0, d, 0.0}));
    lamp.light = 0;
    scene.lights = {{"lamp", flux.scaled(M_PI * d * d), SurfaceLight{2}}};
    for (const Emission emission : {Emission::stratified, Emission::aimed}) check_same(beam, glow(scene, emission));
}

// The floor is 2 million times as large as the ball, so that none of the even photons met it; what the floor itself
// sends to the ball is left out by a black floor.
TEST_CASE("aimed photons find a small body in a wide scene", "[wide_beams]") {
    Scene narrow = ball_under(beam_down<DiskBeam>(90.0, flux)),
          wide = ball_under(beam_down<DiskBeam>(30000.0, flux), 40000.0);
    narrow.shapes[0].material = wide.shapes[0].material = 2;
    const Glow reference = glow(narrow, Emission::aimed), found = glow(wide, Emission::aimed);
    check_same(reference, found);
    CHECK(found.variance < 4.0 * reference.variance);
    const Glow even = glow(wide, Emission::stratified);
    CHECK(even.unmet == std::vector<int>{1});
}

TEST_CASE("bodies that no photon met are named", "[wide_beams]") {
    Scene scene = ball_under(beam_down<DiskBeam>(90.0, flux));
    CHECK(glow(scene, Emission::stratified).unmet.empty());
    add_shape(scene, "roof", 2, moved(make_rectangle(1000.0, 1000.0), {0.0, 100.0, 0.0}));
    const Glow shaded = glow(scene, Emission::stratified);
    CHECK(shaded.unmet == std::vector<int>{1});
    const std::vector<std::string> lines = unmet_body_lines(scene, shaded.unmet);
    REQUIRE(lines.size() == 1);
    CHECK_THAT(lines.front(), Catch::Matchers::StartsWith("no photon met the translucent body \"ball\""));
    CHECK(unmet_body_lines(scene, {}).empty());
    for (int i = 0; i < 5; ++i) add_shape(scene, "more", 1, moved(make_sphere(5.0, 8), {0.0, 5.0, 40.0}));
    const std::vector<std::string> many = unmet_body_lines(scene, {1, 3, 4, 5, 6, 7});
    REQUIRE(many.size() == 1);
    CHECK_THAT(many.front(), Catch::Matchers::StartsWith("no photon met 6 translucent bodies, \"ball\", \"more\""));
}
