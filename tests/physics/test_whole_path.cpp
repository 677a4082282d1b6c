#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

Scene prisms() {
    Scene scene = read_scene(source_path("scenes/prisms.json"));
    scene.film = {32, 24, {}};
    scene.render.photons_per_pass = 6000;
    return scene;
}

// Mean Y of each layer in blocks of 8 x 8 pixels, [layer][block].
std::vector<double> blocks_of(const FilmImage& image) {
    const int columns = image.width / 8, rows = image.height / 8;
    std::vector<double> blocks(static_cast<std::size_t>(columns * rows) * layer_count, 0.0);
    for (std::size_t c = 0; c < layer_count; ++c)
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                const auto block =
                    c * static_cast<std::size_t>(columns * rows) + static_cast<std::size_t>(y / 8 * columns + x / 8);
                blocks[block] +=
                    static_cast<double>(image.xyz[c][static_cast<std::size_t>(y * image.width + x) * 3 + 1]) / 64.0;
            }
    return blocks;
}

std::vector<Sample> block_samples(Scene scene, std::uint32_t seed, std::uint32_t passes) {
    scene.render.seed = seed;
    Renderer renderer(test_device(), scene);
    PassImages images(renderer);
    std::vector<Sample> samples;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const std::vector<double> blocks = blocks_of(images.next(pass));
        samples.resize(blocks.size());
        for (std::size_t i = 0; i < blocks.size(); ++i) samples[i].add(blocks[i]);
    }
    return samples;
}

}  // namespace

// PHYSICS section 7: the ledger closes to 1e-4 of what was emitted, every photon has one fate, nothing is
// cut.
TEST_CASE("whole renders account for all light and all photons", "[whole_path]") {
    for (const Scene& scene : {small_scene(), small_scene(Transport::conserving), prisms()}) {
        CAPTURE(scene.file);
        const std::uint32_t passes = 6;
        Renderer renderer(test_device(), scene);
        double expected_w = 0.0;
        for (std::uint32_t pass = 0; pass < passes; ++pass) {
            renderer.render_pass(pass);
            for (const int lambda : wavelengths_of(scene, pass))
                expected_w += scene.lights[0].flux.at(lambda) * image_weight_nm(300, 780) / passes;
        }
        const LedgerBook& book = renderer.book();
        const Ledger account = book.ledger();
        const Balance& ledger = account.power;
        CAPTURE(ledger.imbalance(), ledger.created, ledger.roulette, ledger.dropped, ledger.emitted);
        CHECK(ledger.emitted == Approx(expected_w).epsilon(1e-4));
        CHECK(std::abs(ledger.imbalance()) < 1e-4);
        CHECK(std::abs(account.photons.imbalance()) < 1e-4);
        for (const double part : {ledger.absorbed, ledger.stokes_loss, ledger.escaped, ledger.stored}) {
            CHECK(std::isfinite(part));
            CHECK(part > 0.0);
        }
        CHECK(ledger.dropped >= 0.0);
        CHECK(ledger.created >= 0.0);
        const auto photons = static_cast<std::uint64_t>(scene.render.photons_per_pass) * passes;
        CHECK(account.paths == photons);
        CHECK(account.absorbed_paths + account.escaped_paths + account.dropped_paths == photons);
        CHECK(account.absorbed_paths > 0);
        CHECK(account.escaped_paths > 0);
        const auto dropped = book.dropped();
        CHECK(dropped.at("event_limit") == 0);
        CHECK(dropped.at("map_full") == 0);
        CHECK(dropped.at("overflow") == 0);
        CHECK(account.dropped_paths <= dropped.at("missed_exit"));
        // Roulette has mean zero; its spread over photons is below their own flux.
        CHECK(std::abs(ledger.roulette) < 5.0 * ledger.emitted / std::sqrt(static_cast<double>(photons)));
        const FilmImage image = renderer.image();
        CHECK(count_non_finite(image) == 0);
        for (const Layer c : {Layer::fluorescence, Layer::single, Layer::multiple, Layer::surface})
            CHECK(mean_xyz(image, c).y > 0.0);
    }
}

// Two seeds have the same expectation. Sixteen integers are the whole range, so that all passes have the same
// wavelengths; passes differ by their photons. Normal deviates of Welch's t by block and layer; all of them
// together may be wrong once in 1000 choices of the seeds.
TEST_CASE("two seeds give the same picture within their noise", "[whole_path]") {
    Scene scene = small_scene();
    scene.render.lambda_min_nm = 500;
    scene.render.lambda_max_nm = 515;
    scene.render.radius_mm = 6.0;
    const std::uint32_t passes = 32;
    const std::vector<Sample> one = block_samples(scene, 11, passes), two = block_samples(scene, 12, passes);
    const double level = sidak_level(1e-3, one.size());
    std::size_t lit = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        const double error = std::hypot(one[i].standard_error(), two[i].standard_error());
        CAPTURE(i, one[i].mean(), two[i].mean(), error);
        if (error == 0.0) {
            CHECK(one[i].mean() == two[i].mean());
            continue;
        }
        ++lit;
        CHECK(normal_two_sided(normal_of_t((one[i].mean() - two[i].mean()) / error, passes - 1.0)) > level);
    }
    // The floor in all twelve blocks, and the ball's three components in two at least.
    CHECK(lit >= 18);
}

// Two rooms of one closed box, 200 x 100 x 100 mm, behind and before a wall 0.5 mm thick that reaches into
// the box's own walls. A density estimate of radius r knows no wall between a point of the floor and photons
// nearer than r; the wall itself, and all that is further from it than r, must stay black to the last bit.
// Nearer, less than half of the disk lies beyond the wall.
TEST_CASE("no light goes through a thin wall", "[whole_path]") {
    const double radius_mm = 5.0, thickness_mm = 0.5;
    Scene scene = empty_scene("rooms");
    scene.render.transport = Transport::paper;
    scene.materials = {diffuse_material(0.9), Material{}};
    add_shape(scene, "box", 0, turned_over(make_box({200.0, 100.0, 100.0})));
    add_shape(scene, "wall", 0, make_box({thickness_mm, 104.0, 104.0}));
    add_shape(scene, "lamp", 1, moved(turned_over(make_rectangle(50.0, 50.0)), {50.0, 49.0, 0.0})).light = 0;
    scene.lights = {{"lamp", Spectrum::constant(1e-3), SurfaceLight{2}}};
    scene.film = {24, 24, {}};
    scene.render.photons_per_pass = 20000;
    scene.render.radius_mm = radius_mm;
    const auto seen = [&](const glm::dvec3& from, const glm::dvec3& to, double fov_deg) {
        scene.camera.position_mm = from;
        scene.camera.target_mm = to;
        scene.camera.vertical_fov_deg = fov_deg;
        Renderer renderer(test_device(), scene);
        for (std::uint32_t pass = 0; pass < 4; ++pass) renderer.render_pass(pass);
        CHECK(std::abs(renderer.book().ledger().power.imbalance()) < 1e-4);
        CHECK(renderer.book().ledger().power.escaped == 0.0);
        return mean_xyz(renderer.image(), Layer::surface).y;
    };
    // The dark side of the wall but for its rim; the floor from 10 to 50 mm; both again in the lit room.
    CHECK(seen({-90.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 40.0) == 0.0);
    CHECK(seen({-30.0, 40.0, 1.0}, {-30.0, -50.0, 0.0}, 25.0) == 0.0);
    const double lit_wall = seen({90.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 40.0);
    CHECK(lit_wall > 0.0);
    // A strip of the floor from 0.25 to 2.75 mm beyond the wall, and the same strip in the lit room.
    const double dark_strip = seen({-1.5, -2.0, 1.0}, {-1.5, -50.0, 0.0}, 2.9);
    const double lit_strip = seen({1.5, -2.0, 1.0}, {1.5, -50.0, 0.0}, 2.9);
    CAPTURE(dark_strip, lit_strip);
    CHECK(lit_strip > 0.0);
    CHECK(dark_strip < 0.5 * lit_strip);
}
