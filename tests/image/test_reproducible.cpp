#include <cstdlib>
#include <optional>

#include "host/image/exr.hpp"
#include "host/render/renderer.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

FilmImage rendered(const Scene& scene, std::size_t local_size, std::initializer_list<std::uint32_t> passes,
                   std::optional<RayShape> shape = {}) {
    static Device& device = *new Device(Device::open("cpu"));
    device.set_local_size(local_size);
    device.set_ray_shape(shape.value_or(choose_ray_shape(device.description())));
    Renderer renderer(device, scene);
    for (const std::uint32_t pass : passes) renderer.render_pass(pass);
    return renderer.image();
}

}  // namespace

TEST_CASE("a picture has the same bits for any work-group size", "[reproducible]") {
    Scene scene = small_scene();
    scene.render.emission = Emission::aimed;
    const FilmImage first = rendered(scene, 64, {0, 1});
    const FilmImage second = rendered(scene, 16, {0, 1});
    double sum = 0.0;
    for (std::size_t c = 0; c < layer_count; ++c) {
        CHECK(same_bits(first.xyz[c], second.xyz[c]));
        for (const float v : first.xyz[c]) sum += static_cast<double>(v);
    }
    CHECK(sum > 0.0);
}

// Halves of the fraction have weights of one half, which add up without rounding.
TEST_CASE("two equal fluorophores with half of the fraction each make the same picture as one", "[reproducible]") {
    for (const Transport transport : {Transport::paper, Transport::conserving, Transport::walk}) {
        CAPTURE(static_cast<int>(transport));
        Scene scene = small_scene(transport);
        scene.render.emission = Emission::random;  // aimed photons follow what each fluorophore counts for
        const FilmImage one = rendered(scene, 64, {0});
        scene.fluorophores.push_back(scene.fluorophores[0]);
        translucent_of(scene, 1).dyes = {{0, 0.25}, {1, 0.25}};
        const FilmImage two = rendered(scene, 64, {0});
        for (std::size_t c = 0; c < layer_count; ++c) CHECK(same_bits(one.xyz[c], two.xyz[c]));
    }
}

TEST_CASE("a picture with local radii has the same bits for any work-group size, and others than with one radius",
          "[reproducible]") {
    Scene scene = small_scene();
    const FilmImage one = rendered(scene, 64, {0, 1});
    scene.render.radii = Radii::local;
    const FilmImage first = rendered(scene, 64, {0, 1});
    const FilmImage second = rendered(scene, 16, {0, 1});
    bool different = false;
    for (std::size_t c = 0; c < layer_count; ++c) {
        CHECK(same_bits(first.xyz[c], second.xyz[c]));
        different = different || !same_bits(first.xyz[c], one.xyz[c]);
    }
    CHECK(different);
}

TEST_CASE("a picture has the same bits for every shape of the ray kernels", "[reproducible]") {
    const auto same = [](Transport transport, std::initializer_list<RayShape> shapes) {
        const Scene scene = small_scene(transport);
        const FilmImage usual = rendered(scene, 64, {0});
        for (const RayShape shape : shapes) {
            const FilmImage other = rendered(scene, 64, {0}, shape);
            double sum = 0.0;
            for (std::size_t c = 0; c < layer_count; ++c) {
                CAPTURE(c, static_cast<int>(shape));
                CHECK(same_bits(usual.xyz[c], other.xyz[c]));
                for (const float v : other.xyz[c]) sum += static_cast<double>(v);
            }
            CHECK(sum > 0.0);
        }
    };
    same(Transport::conserving, {RayShape::avx2, RayShape::portable, RayShape::scalar});
    same(Transport::walk, {RayShape::scalar});
}

TEST_CASE("a pass does not depend on the passes before it", "[reproducible]") {
    const Scene scene = small_scene();
    const FilmImage alone = rendered(scene, 64, {5});
    const FilmImage again = rendered(scene, 64, {5});
    const FilmImage other = rendered(scene, 64, {6});
    const FilmImage both = rendered(scene, 64, {6, 5});
    for (std::size_t c = 0; c < layer_count; ++c) {
        CHECK(same_bits(alone.xyz[c], again.xyz[c]));
        for (std::size_t i = 0; i < alone.xyz[c].size(); ++i)
            CHECK(both.xyz[c][i] == Approx(0.5 * (alone.xyz[c][i] + other.xyz[c][i])).margin(1e-12));
    }
    CHECK_FALSE(same_bits(alone.xyz[0], other.xyz[0]));
}

TEST_CASE("a picture has the same bits for one thread and two", "[reproducible]") {
    const TemporaryFolder folder;
    std::vector<ExrImage> images;
    for (const std::string threads : {"1", "2"}) {
        const std::string file = folder.path() + "/" + threads + ".exr";
        const std::string command = stokes_program() + " render " + source_path("") +
                                    "scenes/sphere.json --passes 1 --photons 20000 --size 40x30 --quiet --threads " +
                                    threads + " -o " + file;
        REQUIRE(std::system(command.c_str()) == 0);
        images.push_back(read_exr(file));
    }
    REQUIRE(images[0].layers.size() == 5);
    for (const auto& [name, values] : images[0].layers) {
        CAPTURE(name);
        CHECK(same_bits(values, images[1].layers.at(name)));
    }
}
