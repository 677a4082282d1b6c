#include <cmath>

#include "host/render/transport/green_walk.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/input_error.hpp"

using namespace stokes;

namespace {

double u1_of(const GreenTable& nodes, std::size_t a, std::size_t z) { return nodes.u1[a * nodes.z.size() + z]; }

}  // namespace

// Against the deterministic totals. Escapes beyond 600 mfp are not scored: for the albedos below 1 fewer than
// 1e-6.
TEST_CASE("random walks let as much light leave as exact transport", "[walk_green]") {
    for (const double eta : {1.0, 1.33, 1.5}) {
        const GreenTable nodes = green_table_nodes(eta);
        GreenWalker walker(test_device(), nodes);
        for (const std::size_t z : {0u, 2u, 16u, 24u, 33u}) {
            const GreenScores scores = walker.walk(nodes.z[z], static_cast<std::uint32_t>(1000 + z), 40000);
            CHECK(scores.total[0] == 0.0);
            for (const std::size_t a : {2u, 8u, 16u, 24u, 29u}) {
                CAPTURE(eta, nodes.z[z], nodes.albedo[a]);
                const double error = scores.standard_error[a];
                CHECK(std::abs(scores.total[a] - u1_of(nodes, a, z)) < 3.5 * error + 1e-6);
                if (nodes.albedo[a] > 0.9 && nodes.z[z] < 3.0) CHECK(error < 0.015 * u1_of(nodes, a, z));
            }
        }
    }
}

// A source below the depth at which walks hand over to diffusion, and one walk's light at every albedo.
TEST_CASE("light from the deep spreads as diffusion has it", "[walk_green]") {
    const GreenTable nodes = green_table_nodes(1.5);
    GreenWalker walker(test_device(), nodes);
    const std::size_t deepest = nodes.z.size() - 1;
    const GreenScores scores = walker.walk(nodes.z[deepest], 7, 10000);
    for (std::size_t a = 20; a + 1 < nodes.albedo.size(); ++a) {
        CAPTURE(nodes.albedo[a]);
        CHECK(std::abs(scores.total[a] - u1_of(nodes, a, deepest)) < 3.5 * scores.standard_error[a] + 1e-6);
    }
}

TEST_CASE("random walks give the same bits for any work-group size", "[walk_green]") {
    const GreenTable nodes = green_table_nodes(1.33);
    Device& device = test_device();
    const std::size_t before = device.local_size();
    std::vector<GreenScores> results;
    for (const std::size_t size : {16u, 128u}) {
        device.set_local_size(size);
        results.push_back(GreenWalker(device, nodes).walk(0.4, 3, 5000));
    }
    device.set_local_size(before);
    CHECK((results[0].escape == results[1].escape));
    CHECK(results[0].total[16] > 0.0);
    CHECK_FALSE((GreenWalker(device, nodes).walk(0.4, 4, 5000).escape == results[0].escape));
}

TEST_CASE("random walks need as many albedos as the kernel carries", "[walk_green]") {
    GreenTable nodes = green_table_nodes(1.0);
    nodes.albedo.pop_back();
    CHECK(input_error([&] { GreenWalker(test_device(), nodes); }) == "31 albedos: expected 32");
}

TEST_CASE("a few random walks leave few scores", "[walk_green][tiny]") {
    const GreenTable nodes = green_table_nodes(1.5);
    const GreenScores scores = GreenWalker(test_device(), nodes).walk(0.5, 1, 256);
    CHECK(scores.total[31] > 0.3);
    CHECK(scores.total[31] < 2.0);
    double sum = 0.0;
    for (std::size_t bin = 0; bin < nodes.rho.size(); ++bin) sum += scores.escape[bin * 32 + 31];
    CHECK(sum == Approx(scores.total[31]));
}
