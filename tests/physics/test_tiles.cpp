// Light below the surface of a slab of two tiles: what enters one leaves through the other as if there were
// no border.
#include <cmath>

#include "host/scene/mesh/shapes.hpp"
#include "host/subsurface/fresnel.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/photon_fixture.hpp"
#include "tests/support/photon_passes.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

constexpr double size_mm = 120.0;
constexpr double border_mm = 0.8;  // from the beam to the border between the tiles

// A slab of two tiles, the border at x = 0; a narrow beam falls straight down at x = -border_mm, on the tile
// whose material is number 0 (a green dye in marble). The tile at x > 0 has number `other`: 1 has another
// medium and a red dye.
Scene two_tiles(Transport transport, int other) {
    Scene scene = slab_scene(0.5, 0.0, transport);
    Medium dark = scene.media[0];
    dark.sigma_s = Spectrum::constant(0.4);
    dark.sigma_a = Spectrum::constant(0.3);
    dark.eta = 1.33;
    scene.media.push_back(dark);
    Fluorophore red = scene.fluorophores[0];
    red.emission = {{620.0, 650.0, 680.0}, {0.0, 1.0, 0.0}, Outside::zero};
    scene.fluorophores.push_back(red);
    for (const bool fresnel : {false, true})
        scene.materials.push_back({"second", TranslucentMaterial{1, {{1, 0.9}}, fresnel}});
    const std::vector<Mesh> tiles = make_tiles({size_mm, size_mm, size_mm}, 2, 1, 2);
    scene.shapes.clear();
    for (int k = 0; k < 2; ++k) {
        const Mesh tile = moved(tiles[static_cast<std::size_t>(k)], {0.0, -0.5 * size_mm, 0.0});
        add_shape(scene, "tile", k == 0 ? 0 : other, tile).body = 0;
    }
    scene.body_count = 1;
    scene.render.photons_per_pass = 16384;
    Beam& beam = std::get<DiskBeam>(scene.lights[0].kind);
    beam.position_mm.x = -border_mm;
    beam.half_u_mm *= 0.01;
    beam.half_v_mm *= 0.01;
    return scene;
}

// The maps F, S and M after one pass.
std::array<Deposits, 3> stored_light(const Scene& scene) {
    PhotonPasses passes(scene);
    CHECK(passes.trace(0).missed_exits == 0);
    return {passes.deposits(0), passes.deposits(1), passes.deposits(2)};
}

constexpr Transport transports[] = {Transport::paper, Transport::conserving, Transport::walk};

}  // namespace

// Under a beam at right angles all azimuths are alike: of the light that leaves at distance r > d from the
// beam the share acos(d/r)/pi leaves beyond a straight border at distance d.
TEST_CASE("a tile gets the share of its neighbour's light that leaves beyond the border") {
    for (const Transport transport : transports) {
        CAPTURE(static_cast<int>(transport));
        const std::array<Deposits, 3> maps = stored_light(two_tiles(transport, 1));
        for (std::size_t m = 0; m < 3; ++m) {
            CAPTURE(m);
            Sample difference;
            double beyond = 0.0, all = 0.0;
            for (std::size_t i = 0; i < maps[m].heads.size(); ++i) {
                const PhotonHead& head = maps[m].heads[i];
                if (head.normal == STOKES_EMPTY_SLOT) continue;
                const double dx = static_cast<double>(head.x) + border_mm,
                             r = std::hypot(dx, static_cast<double>(head.z));
                const double flux = sum_of(maps[m].flux[i]);
                const double expected = r > border_mm ? std::acos(border_mm / r) / M_PI : 0.0;
                difference.add(flux * ((head.x > 0.0f ? 1.0 : 0.0) - expected));
                beyond += head.x > 0.0f ? flux : 0.0;
                all += flux;
            }
            CAPTURE(beyond / all, difference.z(0.0), difference.count());
            CHECK(difference.count() > 1000);
            CHECK(beyond > 0.02 * all);
            CHECK(beyond < 0.5 * all);
            CHECK(std::abs(difference.z(0.0)) < 4.5);
        }
    }
}

TEST_CASE("what leaves a slab of two media is what leaves a slab of the first, bit for bit") {
    for (const Transport transport : transports) {
        CAPTURE(static_cast<int>(transport));
        const std::array<Deposits, 3> one = stored_light(two_tiles(transport, 0)),
                                      two = stored_light(two_tiles(transport, 1));
        for (std::size_t m = 0; m < 3; ++m) {
            CHECK(same_bits(one[m].heads, two[m].heads));
            CHECK(same_bits(one[m].flux, two[m].flux));
        }
    }
}

namespace {

// A picture of a square of the second tile beside the border.
FilmImage seen_second_tile(Scene scene) {
    scene.camera = camera_above({1.5, 0.0, 0.0}, 400.0, 2.0);
    scene.film = {16, 16, {}};
    scene.render.radius_mm = 0.5;
    Renderer renderer(test_device(), scene);
    for (std::uint32_t pass = 0; pass < 4; ++pass) renderer.render_pass(pass);
    return renderer.image();
}

}  // namespace

// The maps hold light that has left already: nothing of the second tile's medium or dye is in what the camera
// sees there.
TEST_CASE("the second tile glows in the light of the first's dye, as bright as the first would there") {
    for (const Transport transport : transports) {
        CAPTURE(static_cast<int>(transport));
        const FilmImage one = seen_second_tile(two_tiles(transport, 0)),
                        two = seen_second_tile(two_tiles(transport, 1));
        for (std::size_t c = 0; c < layer_count; ++c) CHECK(one.xyz[c] == two.xyz[c]);
        const glm::dvec3 glow = mean_xyz(two, Layer::fluorescence);
        CHECK(glow.y > 0.0);
        CHECK(glow.y > glow.x);  // green; the red dye's Y is less than half of its X
    }
}

// The surface is the second tile's: where it reflects, light from below is seen as T/(1 - R_d), T = 1 - R(0)
// along the normal, R(0) = ((eta - 1)/(eta + 1))^2 = 0.02. 1024 camera rays choose between mirror and
// surface: 0.0044 of the mean.
TEST_CASE("light of the first tile is seen through the surface of the second") {
    const Scene plain = two_tiles(Transport::conserving, 1), smooth = two_tiles(Transport::conserving, 2);
    const double eta = smooth.media[1].eta, r = (eta - 1.0) / (eta + 1.0);
    const double expected = (1.0 - r * r) / (1.0 - diffuse_reflectance(eta));
    const double before = mean_xyz(seen_second_tile(plain), Layer::fluorescence).y;
    const double after = mean_xyz(seen_second_tile(smooth), Layer::fluorescence).y;
    CHECK(after / before == Approx(expected).epsilon(0.02));
}
