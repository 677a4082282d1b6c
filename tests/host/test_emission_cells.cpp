#include <cmath>
#include <random>

#include "host/render/emission_cells.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

// A beam, a surface, and a light that never shines.
const std::vector<EmittingLight> lights = {{0.7, 2}, {0.3, 4}, {0.0, 4}};

double volume(const EmissionCell& cell) {
    double result = lights[cell.light].probability;
    for (const float size : cell.size) result *= static_cast<double>(size);
    return result;
}

bool holds(const EmissionCell& cell, const std::array<float, 4>& place) {
    for (std::size_t d = 0; d < place.size(); ++d)
        if (!(place[d] >= cell.low[d] && place[d] < cell.low[d] + cell.size[d])) return false;
    return true;
}

// Photons of random emission, whose squares are these; each counts as one of count.
template <class Square>
std::vector<EmissionSample> samples_of(std::size_t count, Square square) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    std::vector<EmissionSample> samples(count);
    for (EmissionSample& sample : samples) {
        sample.light = static_cast<double>(uniform(generator)) < lights[0].probability ? 0 : 1;
        for (std::size_t d = 0; d < lights[sample.light].dimensions; ++d)
            sample.place[d] = std::min(uniform(generator), 0x1.fffffep-1f);
        sample.square = square(sample) / static_cast<double>(count);
    }
    return samples;
}

// Bright where the beam's coordinates lie in the middle tenth, a hundredth of its area, and nowhere else but for a
// little.
double spot(const EmissionSample& sample) {
    if (sample.light != 0) return 0.0;
    const bool inside = std::abs(sample.place[0] - 0.5f) < 0.05f && std::abs(sample.place[1] - 0.5f) < 0.05f;
    return inside ? 100.0 : 1e-4;
}

}  // namespace

TEST_CASE("cells partition the lights, whatever the samples", "[emission]") {
    const auto random = [](const EmissionSample& s) {
        return std::exp(8.0 * static_cast<double>(s.place[0] * s.place[3]));
    };
    for (const EmissionCells& cells : {EmissionCells::stratified(lights, 20000),
                                       EmissionCells::aimed(lights, samples_of(20000, spot), 0.1, 300, 20000),
                                       EmissionCells::aimed(lights, samples_of(20000, random), 0.2, 300, 20000),
                                       EmissionCells::aimed(lights, {}, 0.2, 300, 20000)}) {
        double all = 0.0, shares = 0.0;
        for (std::size_t c = 0; c < cells.records().size(); ++c) {
            const EmissionCell& cell = cells.records()[c];
            CHECK(cell.light != 2);
            all += volume(cell);
            shares += cells.shares()[c];
            CHECK(static_cast<double>(cell.probability) == Approx(volume(cell)).epsilon(1e-6));
            CHECK(cells.shares()[c] >= 1.5 / 20000);
        }
        CHECK(all == Approx(1.0).epsilon(1e-12));
        CHECK(shares == Approx(1.0).epsilon(1e-12));
        std::mt19937 generator(2);
        std::uniform_real_distribution<float> uniform(0.0f, 0.9999999f);
        for (int i = 0; i < 200; ++i) {
            const std::array<float, 4> place = {uniform(generator), uniform(generator), uniform(generator),
                                                uniform(generator)};
            for (const std::uint32_t light : {0u, 1u}) {
                std::size_t found = 0;
                for (const EmissionCell& cell : cells.records())
                    found += cell.light == light && holds(cell, place) ? 1 : 0;
                CHECK(found == 1);
            }
        }
    }
}

TEST_CASE("even cells are the lights themselves", "[emission]") {
    const EmissionCells cells = EmissionCells::stratified(lights, 1000000);
    REQUIRE(cells.records().size() == 2);
    CHECK(cells.shares()[0] == Approx(0.7).epsilon(1e-5));
    CHECK(cells.records()[0].probability == Approx(0.7f));
    CHECK(cells.records()[1].light == 1);
    CHECK(cells.records()[1].probability == Approx(0.3f));
    // With fewer than three photons a cell emission is random.
    CHECK(EmissionCells::stratified(lights, 6).records().size() == 2);
    CHECK(EmissionCells::stratified(lights, 5).records().empty());
}

// The least variance is that of shares in proportion to the root of the mean square: nearly all photons in the spot, of
// which cells can cover as little as 1/64 of the beam's area (four by four cells of 1/32 by 1/32), or miss a rim.
TEST_CASE("aimed photons go where the light comes from", "[emission]") {
    const EmissionCells cells = EmissionCells::aimed(lights, samples_of(200000, spot), 0.1, 300, 200000);
    double inside = 0.0, most = 0.0;
    for (std::size_t c = 0; c < cells.records().size(); ++c) {
        const EmissionCell& cell = cells.records()[c];
        most = std::max(most, static_cast<double>(cell.probability) / cells.shares()[c]);
        const double x = static_cast<double>(cell.low[0] + 0.5f * cell.size[0]) - 0.5;
        const double y = static_cast<double>(cell.low[1] + 0.5f * cell.size[1]) - 0.5;
        if (cell.light == 0 && std::abs(x) < 0.05 && std::abs(y) < 0.05) inside += cells.shares()[c];
    }
    CHECK(inside > 0.7);
    CHECK(most <= 10.0 * 1.01);  // 1 / uniform_share, and what goes to least photons
    CHECK(cells.records().size() <= 300);
}

// Of two halves with squares 16 and 1 the shares must be 4 to 1, without an even share.
TEST_CASE("shares follow the root of the mean square", "[emission]") {
    const std::vector<EmittingLight> beam = {{1.0, 2}};
    std::vector<EmissionSample> samples =
        samples_of(100000, [](const EmissionSample& s) { return s.place[0] < 0.5f ? 16.0 : 1.0; });
    for (EmissionSample& sample : samples) sample.light = 0;
    const EmissionCells cells = EmissionCells::aimed(beam, samples, 0.0, 2, 100000);
    REQUIRE(cells.records().size() == 2);
    CHECK(cells.shares()[0] == Approx(0.8).epsilon(0.02));
}

TEST_CASE("every pass gives a cell its share to the photon, and the mean of all passes exactly", "[emission]") {
    constexpr std::uint32_t photons = 1000, passes = 4096;
    const EmissionCells cells = EmissionCells::aimed(lights, samples_of(20000, spot), 0.1, 40, photons);
    std::vector<double> sums(cells.shares().size(), 0.0);
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const std::vector<std::uint32_t> first = cells.first_photons(3, pass);
        REQUIRE(first.size() == sums.size() + 1);
        CHECK(first.front() == 0);
        CHECK(first.back() == photons);
        for (std::size_t c = 0; c < sums.size(); ++c) {
            REQUIRE(first[c + 1] >= first[c]);
            const double count = first[c + 1] - first[c], wanted = cells.shares()[c] * photons;
            REQUIRE(std::abs(count - wanted) < 1.0 + 1e-9);
            REQUIRE(count <= cells.records()[c].stride);
            REQUIRE(count >= 1.0);
            sums[c] += count;
        }
    }
    // The offset's discrepancy over that many passes is below 10/passes.
    for (std::size_t c = 0; c < sums.size(); ++c)
        CHECK(std::abs(sums[c] / passes - cells.shares()[c] * photons) < 20.0 / passes + 1e-6);
    CHECK(cells.first_photons(3, 7) == cells.first_photons(3, 7));
    Sample first_cell;  // over seeds
    for (std::uint32_t seed = 0; seed < 2000; ++seed) first_cell.add(cells.first_photons(seed, 5)[1]);
    CHECK(std::abs(first_cell.z(cells.shares()[0] * photons)) < 4.0);
}
