// The light that falls straight from the lights onto diffuse surfaces, by rays and by photons.
#include <cmath>
#include <cstring>

#include "tests/support/catch.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/photon_passes.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

// A diffuse floor below a disk that emits and an oblique beam; a post on it, a diffuse sheet with two sides above it, a
// translucent ball and a lying translucent slab, whose smooth top mirrors post and sheet.
Scene mixed_scene(Direct direct) {
    Scene scene = small_scene(Transport::conserving);
    scene.render.direct = direct;
    scene.render.radius_mm = 1.5;
    scene.render.emission = Emission::random;  // aimed photons would leave out what rays bring
    scene.render.photons_per_pass = 100000;
    scene.media[0].eta = 1.5;
    Material smooth = scene.materials[1];
    smooth.name = "smooth";
    scene.materials.push_back(smooth);
    translucent_of(scene, scene.materials.size() - 1).fresnel = true;
    add_shape(scene, "post", 0, moved(make_prism(4, 8.0, 30.0), {-38.0, 0.0, 5.0}));
    add_shape(scene, "slab", 3, moved(make_box({30.0, 4.0, 40.0}), {38.0, 4.0, 10.0}));
    add_shape(scene, "sheet", 0, moved(make_rectangle(30.0, 20.0), {28.0, 34.0, -12.0})).two_sided = true;
    Light beam = disk_beam({10.0, 0.0, 0.0}, {0.6, -1.0, -0.3}, 40.0, {{300.0, 780.0}, {2.0, 3.0}, Outside::zero});
    scene.lights.push_back(beam);
    scene.film = {24, 18, {}};
    return scene;
}

glm::dvec3 block_mean(const FilmImage& image, int component, int left, int top, int edge) {
    glm::dvec3 sum(0.0);
    for (int y = top; y < top + edge; ++y)
        for (int x = left; x < left + edge; ++x)
            for (int k = 0; k < 3; ++k)
                sum[k] += static_cast<double>(image.xyz[static_cast<std::size_t>(component)]
                                                       [static_cast<std::size_t>((y * image.width + x) * 3 + k)]);
    return sum / static_cast<double>(edge * edge);
}

struct Stored {
    PhotonAccount account;
    std::array<Deposits, STOKES_MAP_COUNT> maps;
};

Stored trace(const Scene& scene) {
    PhotonPasses passes(scene);
    Stored stored{passes.trace(3), {}};
    for (std::size_t m = 0; m < stored.maps.size(); ++m) stored.maps[m] = passes.deposits(m);
    return stored;
}

template <class T>
bool same_end(const std::vector<T>& longer, const std::vector<T>& shorter) {
    return longer.size() >= shorter.size() && std::memcmp(longer.data() + (longer.size() - shorter.size()),
                                                          shorter.data(), shorter.size() * sizeof(T)) == 0;
}

}  // namespace

// Blocks of pixels of the surface layer, in passes with the same wavelengths and photons, so that only the direct light
// differs. The density estimate blurs over 1.5 mm: its bias is allowed for by 2 % of
// the picture's mean. Student's t, all comparisons together wrong once in a thousand seeds.
TEST_CASE("rays and photons bring the same direct light in the mean", "[direct_light]") {
    const std::uint32_t passes = 48;
    const int edge = 3;
    Scene by_photons = mixed_scene(Direct::photons), by_rays = mixed_scene(Direct::rays);
    Renderer photons(test_device(), by_photons), rays(test_device(), by_rays);
    PassImages photon_images(photons), ray_images(rays);
    const int columns = by_rays.film.width / edge, rows = by_rays.film.height / edge;
    std::vector<std::array<Sample, 3>> differences(static_cast<std::size_t>(columns * rows + 1));
    Sample brightness;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const FilmImage a = ray_images.next(pass), b = photon_images.next(pass);
        for (int component = 0; component < 3; ++component)
            CHECK(a.xyz[static_cast<std::size_t>(component)] == b.xyz[static_cast<std::size_t>(component)]);
        for (int i = 0; i <= columns * rows; ++i) {
            const bool whole = i == columns * rows;
            const glm::dvec3 x =
                whole ? mean_xyz(a, Layer::surface) : block_mean(a, 3, i % columns * edge, i / columns * edge, edge);
            const glm::dvec3 y =
                whole ? mean_xyz(b, Layer::surface) : block_mean(b, 3, i % columns * edge, i / columns * edge, edge);
            for (int k = 0; k < 3; ++k)
                differences[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)].add(x[k] - y[k]);
            if (whole) brightness.add(y.y);
        }
    }
    const double level = sidak_level(1e-3, differences.size() * 3);
    for (std::size_t i = 0; i < differences.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const Sample& d = differences[i][k];
            const double beyond =
                std::max(0.0, std::abs(d.mean()) - (i + 1 == differences.size() ? 0.003 : 0.02) * brightness.mean());
            CAPTURE(i, k, d.mean(), d.standard_error(), brightness.mean());
            CHECK((beyond == 0.0 || normal_two_sided(normal_of_t(beyond / d.standard_error(), passes - 1.0)) > level));
        }
    const Sample& whole = differences.back()[1];
    CAPTURE(whole.mean(), whole.standard_error(), brightness.mean());
    CHECK(whole.standard_error() < 0.01 * brightness.mean());
    CHECK(photons.first_radius() == rays.first_radius());
}

// By rays the surface map lacks what is in it after the first round of events, and that alone.
TEST_CASE("photons are the same, but for those that are not stored", "[direct_light]") {
    for (const Transport transport : {Transport::conserving, Transport::paper, Transport::walk}) {
        CAPTURE(word_of(transport));
        Scene scene = mixed_scene(Direct::photons);
        scene.render.photons_per_pass = 8192;
        scene.render.transport = transport;
        const Stored all = trace(scene);
        scene.render.direct = Direct::rays;
        const Stored rest = trace(scene);
        for (std::size_t m = 0; m < STOKES_MAP_COUNT; ++m) {
            CAPTURE(m);
            CHECK(same_end(all.maps[m].heads, rest.maps[m].heads));
            CHECK(same_end(all.maps[m].flux, rest.maps[m].flux));
            if (m != STOKES_MAP_SURFACE) CHECK(all.maps[m].heads.size() == rest.maps[m].heads.size());
        }
        const std::size_t direct =
            all.maps[STOKES_MAP_SURFACE].heads.size() - rest.maps[STOKES_MAP_SURFACE].heads.size();
        CHECK(direct > 1000);
        CHECK(direct < 8192);
        CHECK(rest.maps[STOKES_MAP_SURFACE].heads.size() > 500);
        CHECK(all.account.deposits - rest.account.deposits == direct);
        CHECK(all.account.fates == rest.account.fates);
        CHECK(all.account.rays == rest.account.rays);
        for (std::size_t k = 0; k + 1 < all.account.energy.size(); ++k) {
            CHECK(all.account.energy[k] == rest.account.energy[k]);
            CHECK(all.account.photons[k] == rest.account.photons[k]);
        }
        double lacking = 0.0;
        for (std::size_t i = 0; i < direct; ++i)
            for (const float v : all.maps[STOKES_MAP_SURFACE].flux[i].v) lacking += static_cast<double>(v);
        CHECK(all.account.energy[7] - rest.account.energy[7] == Approx(lacking).epsilon(1e-4));
    }
}

// Nothing that a convex body reflects falls on it again.
TEST_CASE("where nothing is lit but by lights, the surface map is empty", "[direct_light]") {
    Scene scene = empty_scene("ball");
    scene.materials = {diffuse_material(0.6)};
    add_shape(scene, "ball", 0, make_sphere(10.0, 48));
    scene.lights = {disk_beam({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, 30.0, Spectrum::constant(1.0))};
    scene.camera = camera_above({0.0, 0.0, 0.0}, 400.0, 10.0);
    scene.film = {8, 8, {}};
    scene.render.photons_per_pass = 4096;
    scene.render.direct = Direct::rays;
    const Stored stored = trace(scene);
    for (const Deposits& map : stored.maps) CHECK(map.heads.empty());
    CHECK(stored.account.deposits == 0);
    CHECK(stored.account.energy[7] == 0.0);
    CHECK(stored.account.energy[0] > 0.0);
    scene.render.direct = Direct::photons;
    CHECK(trace(scene).maps[STOKES_MAP_SURFACE].heads.size() > 100);
}
