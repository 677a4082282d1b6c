// Bodies whose light travels by another transport than the render's.
#include <cstring>

#include "host/scene/mesh/shapes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/photon_passes.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

// Two sheets of one material side by side, each under a beam of its own. Light leaves them upward and meets nothing
// more, so that a photon has one event.
Scene two_sheets(Transport transport) {
    Scene scene = slab_scene(0.5, 0.0, transport);
    scene.shapes.clear();
    scene.body_count = 0;
    add_shape(scene, "left", 0, moved(make_rectangle(400.0, 400.0), {-300.0, 0.0, 0.0}));
    add_shape(scene, "right", 0, moved(make_rectangle(400.0, 400.0), {300.0, 0.0, 0.0}));
    Light right = scene.lights[0];
    std::get<DiskBeam>(scene.lights[0].kind).position_mm.x = -300.0;
    std::get<DiskBeam>(right.kind).position_mm.x = 300.0;
    scene.lights.push_back(right);
    scene.render.sampling = Sampling::plain;
    scene.render.photons_per_pass = 4096;
    return scene;
}

// What leaves one of the bodies, map by map, in the order of its paths.
std::vector<Flux16> light_of_body(const Scene& scene, std::uint32_t body) {
    PhotonPasses passes(scene);
    passes.trace(0);
    std::vector<Flux16> light;
    for (std::size_t m = 0; m < 3; ++m) {
        const Deposits deposits = passes.deposits(m);
        for (std::size_t i = 0; i < deposits.heads.size(); ++i)
            if (deposits.heads[i].normal != STOKES_EMPTY_SLOT && deposits.heads[i].normal >> 24 == body)
                light.push_back(deposits.flux[i]);
    }
    return light;
}

bool same(const std::vector<Flux16>& a, const std::vector<Flux16>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Flux16)) == 0;
}

}  // namespace

// A path's random numbers depend on its index and event alone, so that each body does, to the bit, what it does where
// all have its transport; and the transports differ, so that none stands in for another.
TEST_CASE("each body has the light of its own transport", "[transport]") {
    for (const Transport left : {Transport::paper, Transport::conserving, Transport::walk})
        for (const Transport right : {Transport::paper, Transport::conserving, Transport::walk}) {
            CAPTURE(word_of(left), word_of(right));
            Scene mixed = two_sheets(left);
            mixed.body_transports[1] = right;
            const std::vector<Flux16> of_left = light_of_body(mixed, 0), of_right = light_of_body(mixed, 1);
            CHECK(of_left.size() > 100);
            CHECK(same(of_left, light_of_body(two_sheets(left), 0)));
            CHECK(same(of_right, light_of_body(two_sheets(right), 1)));
            if (left != right) CHECK_FALSE(same(of_right, light_of_body(two_sheets(left), 1)));
        }
}
