#include <random>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/photon_fixture.hpp"

using namespace stokes;

namespace {

std::vector<PathLedger> random_ledgers(std::uint32_t count) {
    std::mt19937 generator(count);
    std::uniform_real_distribution<float> uniform(-0.5f, 2.0f);
    std::vector<PathLedger> ledgers(count);
    for (PathLedger& l : ledgers) {
        for (LightSum* x :
             {&l.emitted, &l.absorbed, &l.stokes_loss, &l.escaped, &l.dropped, &l.roulette, &l.created, &l.stored})
            *x = {uniform(generator), 500.0f * uniform(generator)};
        l.reference_flux = uniform(generator);
        l.reflections = std::uint32_t(generator() % 5);
        l.fate = std::uint32_t(generator() % STOKES_FATE_COUNT);
        l.missed_exits = std::uint32_t(generator() % 3);
        l.rays = std::uint32_t(generator() % 1000);
    }
    return ledgers;
}

// The sums over each chunk in double precision; a sum of 500 values in single precision rounds to some 1e-5.
void check_sums(std::uint32_t count, std::uint32_t chunk_size) {
    CAPTURE(count, chunk_size);
    const std::vector<PathLedger> ledgers = random_ledgers(count);
    const std::uint32_t chunks = (count + chunk_size - 1) / chunk_size;
    LedgerSums blank{};
    blank.rays = 0xabababab;
    const Buffer<LedgerSums> out = on_device(std::vector<LedgerSums>(chunks + 2, blank));
    Program(test_device(), "sum_ledgers.cl")
        .kernel("sum_ledgers")
        .launch(chunks, Arguments()
                            .add("count", count)
                            .add("chunk_size", chunk_size)
                            .add("ledgers", on_device(ledgers))
                            .add("sums", out));
    const std::vector<LedgerSums> sums = out.download();
    for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
        std::vector<double> energy(8, 0.0), photons(8, 0.0);
        std::vector<std::uint32_t> fates(STOKES_FATE_COUNT, 0);
        std::uint32_t missed = 0, rays = 0, reflections = 0;
        for (std::uint32_t i = chunk * chunk_size; i < std::min(count, (chunk + 1) * chunk_size); ++i) {
            const PathLedger& l = ledgers[i];
            const LightSum values[] = {l.emitted, l.absorbed, l.stokes_loss, l.escaped,
                                       l.dropped, l.roulette, l.created,     l.stored};
            for (std::size_t k = 0; k < 8; ++k) {
                energy[k] += static_cast<double>(values[k].energy);
                photons[k] += static_cast<double>(values[k].photons);
            }
            ++fates[l.fate];
            missed += l.missed_exits;
            rays += l.rays;
            reflections += l.reflections;
        }
        for (std::size_t k = 0; k < 8; ++k) {
            CHECK(static_cast<double>(sums[chunk].light[k].energy) == Approx(energy[k]).epsilon(1e-5).margin(1e-3));
            CHECK(static_cast<double>(sums[chunk].light[k].photons) == Approx(photons[k]).epsilon(1e-5).margin(0.5));
        }
        CHECK(sums[chunk].reflections == reflections);
        for (std::size_t k = 0; k < fates.size(); ++k) CHECK(sums[chunk].fates[k] == fates[k]);
        CHECK(sums[chunk].missed_exits == missed);
        CHECK(sums[chunk].rays == rays);
    }
    for (std::uint32_t chunk = chunks; chunk < chunks + 2; ++chunk) CHECK(sums[chunk].rays == blank.rays);
}

}  // namespace

TEST_CASE("ledgers are added up chunk by chunk", "[sum_ledgers][tiny]") {
    for (const std::uint32_t count : {1u, 15u, 16u, 17u, 200u}) check_sums(count, 16);
}

TEST_CASE("many ledgers are added up", "[sum_ledgers]") {
    check_sums(100001, 512);
    check_sums(512, 512);
}
