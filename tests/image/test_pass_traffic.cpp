// What a pass moves between host and device, and that it makes no buffers.
#include "host/render/renderer.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

struct Traffic {
    std::uint64_t bytes_read, allocations;
};

// Of one pass, after two others.
Traffic traffic_of(Transport transport, int edge, std::int64_t photons) {
    Scene scene = small_scene(transport);
    scene.film.width = scene.film.height = edge;
    scene.render.photons_per_pass = photons;
    const Device& device = test_device();
    Renderer renderer(device, scene);
    renderer.render_pass(0);
    renderer.render_pass(1);
    const std::uint64_t bytes = device.bytes_read(), allocations = device.allocations();
    renderer.render_pass(2);
    return {device.bytes_read() - bytes, device.allocations() - allocations};
}

}  // namespace

TEST_CASE("a pass reads back counts and the ledger's sums only, and allocates nothing") {
    for (const Transport transport : {Transport::paper, Transport::conserving, Transport::walk}) {
        CAPTURE(word_of(transport));
        const Traffic small = traffic_of(transport, 16, 8192), wide = traffic_of(transport, 64, 8192),
                      many = traffic_of(transport, 16, 65536);
        CHECK(small.allocations == 0);
        CHECK(wide.allocations == 0);
        CHECK(many.allocations == 0);
        // Sixteen bytes a round of events and the sums of 512 photons each: nothing a pixel, and a quarter of a byte a
        // photon.
        CHECK(small.bytes_read > 0);
        CHECK(wide.bytes_read < small.bytes_read + 4096);
        CHECK(many.bytes_read < 16384 + 65536 / 4);
    }
}
