// Where light leaves: distances drawn by importance, and draws that go with the place where the photon started.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/subsurface_fixture.hpp"

using namespace stokes;

namespace {

constexpr std::uint32_t garbage = 0xabababab;

struct Exits {
    std::vector<ExitPoint> exits;
    std::vector<Probe> probes;
};

EventRound round_of(std::uint32_t component, std::size_t count) {
    EventRound round{};
    round.count = static_cast<std::uint32_t>(count);
    round.component = component;
    round.exits = 1;
    return round;
}

// Of the elastic paths. even: PassConstants.low_discrepancy_exits; words by path.
Exits sample(const SubsurfaceArrivals& a, const EventRound& round, bool even, const std::vector<EventSample>& words) {
    static const MadeUpTables tables;
    const Buffer<PassConstants> pass = pass_on_device(9);
    PassConstants constants = pass.download().front();
    constants.low_discrepancy_exits = even ? 1 : 0;
    pass.upload(&constants, 1);
    const Buffer<ExitPoint> exits(test_device(), "exits", a.elastic.size());
    const Buffer<Probe> probes(test_device(), "probes", a.elastic.size());
    Program(test_device(), "deposit_subsurface.cl")
        .kernel("sample_exits")
        .launch(a.elastic.size(), Arguments()
                                      .add("round", round)
                                      .add("pass", pass)
                                      .add("event_lists", on_device(a.elastic))
                                      .add("points", on_device(a.points))
                                      .add("rays", on_device(a.rays))
                                      .add("materials", on_device(translucent_materials()))
                                      .add("spectra", on_device(translucent_spectra()))
                                      .add("table_shapes", on_device(tables.shapes))
                                      .add("mean_rows", on_device(tables.mean_rows))
                                      .add("cumulative_rows", on_device(tables.cumulative_rows))
                                      .add("event_samples", on_device(words))
                                      .add("exits", exits)
                                      .add("probes", probes));
    return {exits.download(), probes.download()};
}

unsigned table_of(const ExitPoint& exit_point, std::uint32_t component) {
    return translucent_materials()[exit_point.material].medium * 3 + component;
}

double azimuth(const SubsurfaceArrivals& a, const Exits& e, std::size_t i) {
    const SurfacePoint& p = a.points[a.elastic[i]];
    const Probe& probe = e.probes[i];
    return azimuth_about({p.nx, p.ny, p.nz}, {static_cast<double>(probe.x) - static_cast<double>(p.x),
                                              static_cast<double>(probe.y) - static_cast<double>(p.y),
                                              static_cast<double>(probe.z) - static_cast<double>(p.z)});
}

constexpr std::uint32_t components[] = {STOKES_MAP_FLUORESCENCE, STOKES_MAP_SINGLE, STOKES_MAP_MULTIPLE};

}  // namespace

// Weighted with the scale, the share of the distances in each cell of the r axis is the integral of the table's density
// over it. 3 components of 4 to 9 cells in two media, at 5 standard errors: wrong by chance once in 40,000.
TEST_CASE("distances drawn from another density have the weight of the table's over it", "[exit_draws]") {
    const MadeUpTables tables;
    const SubsurfaceArrivals a(60000);
    for (const std::uint32_t component : components) {
        EventRound round = round_of(component, a.elastic.size());
        const Exits plain = sample(a, round, false, {EventSample{}});
        round.drawn_rows = tables.drawn_rows;
        const Exits e = sample(a, round, false, {EventSample{}});
        std::array<std::array<Sample, 16>, 2> differences;
        for (std::size_t i = 0; i < e.exits.size(); ++i) {
            const ExitPoint& exit_point = e.exits[i];
            const unsigned table = table_of(exit_point, component);
            const TableShape& shape = tables.shapes[table];
            const double row = static_cast<double>(exit_point.row), r = static_cast<double>(exit_point.r_mm);
            CAPTURE(component, row, r);
            REQUIRE(static_cast<double>(exit_point.scale) ==
                    Approx(tables.density(table, row, r, 0) / tables.density(table, row, r, tables.drawn_rows))
                        .epsilon(1e-4));
            REQUIRE(plain.exits[i].scale == 1.0f);
            const double first = static_cast<double>(shape.r_first), step = static_cast<double>(shape.r_step);
            for (unsigned cell = 0; cell + 1 < shape.r_count; ++cell) {
                const double begin = first + cell * step;
                const double expected =
                    0.5 * step * (tables.density(table, row, begin, 0) + tables.density(table, row, begin + step, 0));
                const bool inside = r >= begin && r < begin + step;
                const double weighted = inside ? static_cast<double>(exit_point.scale) : 0.0;
                differences[exit_point.material][cell].add(weighted - expected);
            }
        }
        for (const auto& medium : differences)
            for (const Sample& cell : medium)
                if (cell.count() > 0) CHECK(std::abs(cell.mean()) < 5.0 * cell.standard_error());
    }
}

// The words of path list[i] are the digits of i, so that the draws are a van der Corput sequence, scrambled. Of n in
// eight equal steps there are as many in each, but for one.
TEST_CASE("the first event's exits follow the words of their photons", "[exit_draws]") {
    const MadeUpTables tables;
    SubsurfaceArrivals a(12000);
    for (SurfacePoint& p : a.points) p.nx = p.nz = 0.0f, p.ny = 1.0f;  // so that azimuths are from one axis
    for (Ray& ray : a.rays) ray.dy = -std::abs(ray.dy);
    std::vector<EventSample> words(12000, EventSample{garbage, garbage});
    for (std::uint32_t i = 0; i < a.elastic.size(); ++i) words[a.elastic[i]] = {i, i};
    const double n = static_cast<double>(a.elastic.size());
    std::array<std::vector<double>, 3> azimuths;
    for (const std::uint32_t component : components) {
        CAPTURE(component);
        const EventRound round = round_of(component, a.elastic.size());
        const Exits e = sample(a, round, true, words);
        std::array<double, 8> turns{}, quantiles{};
        for (std::size_t i = 0; i < e.exits.size(); ++i) {
            const double turn = azimuth(a, e, i);
            azimuths[component].push_back(turn);
            turns[std::min(static_cast<std::size_t>(turn * 8.0), std::size_t{7})] += 1.0;
            const unsigned table = table_of(e.exits[i], component);
            const TableShape& shape = tables.shapes[table];
            double below = 0.0;
            const double r = static_cast<double>(e.exits[i].r_mm), row = static_cast<double>(e.exits[i].row);
            const double first = static_cast<double>(shape.r_first), step = static_cast<double>(shape.r_step);
            for (unsigned cell = 0; cell + 1 < shape.r_count; ++cell) {
                const double begin = first + cell * step, end = std::min(begin + step, r);
                if (end > begin)
                    below += 0.5 * (end - begin) *
                             (tables.density(table, row, begin, 0) + tables.density(table, row, end, 0));
            }
            quantiles[std::min(static_cast<std::size_t>(below * 8.0), std::size_t{7})] += 1.0;
        }
        // Rounding can take some across a border.
        for (const double count : turns) CHECK(std::abs(count - n / 8.0) <= 4.0);
        for (const double count : quantiles) CHECK(std::abs(count - n / 8.0) <= 4.0);
    }
    for (std::size_t i = 0; i < 8; ++i) CHECK(azimuths[1][i] != Approx(azimuths[2][i]).margin(1e-3));
}

TEST_CASE("later events, and photons that start at random, do not read words", "[exit_draws][tiny]") {
    const SubsurfaceArrivals a(150);
    for (const std::uint32_t component : components) {
        EventRound round = round_of(component, a.elastic.size());
        const Exits first = sample(a, round, false, {EventSample{}}),
                    words = sample(a, round, true, std::vector<EventSample>(150, EventSample{garbage, garbage}));
        round.event = 1;
        const Exits later = sample(a, round, false, {EventSample{}}),
                    later_even = sample(a, round, true, {EventSample{}});
        for (std::size_t i = 0; i < first.exits.size(); ++i) {
            CHECK(later.exits[i].r_mm == later_even.exits[i].r_mm);
            CHECK(later.probes[i].x == later_even.probes[i].x);
            CHECK(first.exits[i].r_mm != later.exits[i].r_mm);
            CHECK(first.exits[i].r_mm != words.exits[i].r_mm);
        }
    }
}
