// Bodies whose light travels by another transport than the render's.
#include <array>

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

// Every sampler that the transports have, beside what is drawn evenly over the passes.
void use_all_samplers(Scene& scene) {
    scene.render.sampling = Sampling::best;
    scene.render.emission = Emission::random;
    scene.render.branches = Branches::both;
    scene.render.distances = Distances::importance;
    scene.render.exits = 3;
}

// No path is left over, and no light, in energy and in photons, to 1e-5.
void check_account(const PhotonAccount& account) {
    CHECK(account.fates[STOKES_FATE_ALIVE] == 0);
    for (const std::array<double, 8>& s : {account.energy, account.photons})
        CHECK(s[1] + s[2] + s[3] + s[4] + s[5] - s[6] == Approx(s[0]).epsilon(1e-5));
}

// What leaves each of the two bodies, map by map, in the order of its paths.
std::array<std::vector<Flux16>, 2> light_of_bodies(const Scene& scene) {
    PhotonPasses passes(scene);
    check_account(passes.trace(0));
    std::array<std::vector<Flux16>, 2> light;
    for (std::size_t m = 0; m < 3; ++m) {
        const Deposits deposits = passes.deposits(m);
        for (std::size_t i = 0; i < deposits.heads.size(); ++i)
            if (deposits.heads[i].normal != STOKES_EMPTY_SLOT)
                light.at(deposits.heads[i].normal >> 24).push_back(deposits.flux[i]);
    }
    return light;
}

}  // namespace

// A path's random numbers depend on its index and event alone, so that each body does, to the bit, what it does where
// all have its transport; and the transports differ, so that none stands in for another.
TEST_CASE("each body has the light of its own transport", "[transport]") {
    constexpr std::array<Transport, 3> transports = {Transport::paper, Transport::conserving, Transport::walk};
    for (const bool all_samplers : {false, true}) {
        const auto sheets = [&](Transport transport) {
            Scene scene = two_sheets(transport);
            if (all_samplers) use_all_samplers(scene);
            return scene;
        };
        std::array<std::array<std::vector<Flux16>, 2>, 3> alone;
        for (std::size_t t = 0; t < 3; ++t) alone[t] = light_of_bodies(sheets(transports[t]));
        for (std::size_t left = 0; left < 3; ++left)
            for (std::size_t right = 0; right < 3; ++right) {
                if (left == right) continue;
                CAPTURE(all_samplers, word_of(transports[left]), word_of(transports[right]));
                Scene mixed = sheets(transports[left]);
                mixed.body_transports[1] = transports[right];
                const std::array<std::vector<Flux16>, 2> light = light_of_bodies(mixed);
                CHECK(light[0].size() > 100);
                CHECK(same_bits(light[0], alone[left][0]));
                CHECK(same_bits(light[1], alone[right][1]));
                CHECK_FALSE(same_bits(light[1], alone[left][1]));
            }
    }
}

// Below a white ceiling light goes from body to body, event by event.
TEST_CASE("the account closes where light goes between bodies of different transports", "[transport]") {
    for (const Transport right : {Transport::paper, Transport::walk}) {
        CAPTURE(word_of(right));
        Scene scene = two_sheets(Transport::conserving);
        use_all_samplers(scene);
        scene.body_transports[1] = right;
        scene.materials.push_back(diffuse_material(0.9));
        add_shape(scene, "ceiling", 1, moved(turned_over(make_rectangle(4000.0, 4000.0)), {0.0, 300.0, 0.0}));
        for (Light& light : scene.lights) std::get<DiskBeam>(light.kind).position_mm.y = 100.0;
        PhotonPasses passes(scene);
        const PhotonAccount account = passes.trace(0);
        check_account(account);
        CHECK(account.rays > 3 * std::uint64_t{passes.photons});
    }
}

// The maps cannot grow: most deposits are refused, and the paths go on as if they had been stored.
TEST_CASE("a full map costs the deposit, not the path", "[transport]") {
    const Scene scene = two_sheets(Transport::walk);
    PhotonPasses passes(scene), small(scene);
    const PhotonAccount stored = passes.trace(0);
    Device& device = test_device();
    const std::uint64_t budget = device.memory_left() + device.memory_in_use();
    small.pass.prepare(0, small.photons);
    device.set_memory_budget(device.memory_in_use());
    const PhotonAccount refused = small.pass.trace();
    device.set_memory_budget(budget);
    CHECK(stored.refused_slots == 0);
    CHECK(refused.refused_slots > 1000);
    CHECK(refused.energy[7] < 0.1 * stored.energy[7]);
    CHECK(refused.fates == stored.fates);
    for (std::size_t k = 0; k < 7; ++k) CHECK(refused.energy[k] == stored.energy[k]);
}
