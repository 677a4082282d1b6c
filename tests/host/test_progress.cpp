#include <chrono>
#include <ctime>
#include <thread>

#include "host/commands/progress.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;

namespace {

const ProgressState half{32, 64, 32 * 262144ull, 75.0};
const ProgressState longest{12345678, 100000000, 12345678ull * 268435456ull, 360000.0};

bool has(const std::string& line, const std::string& text) { return line.find(text) != std::string::npos; }

}  // namespace

TEST_CASE("a progress line fits the terminal and always tells the remaining time", "[progress]") {
    for (std::size_t columns = 39; columns < 200; ++columns)
        for (const ProgressState& state : {half, longest, ProgressState{0, 64, 0, 0.0}}) {
            const std::string line = progress_line(state, columns, true);
            CAPTURE(columns, line);
            CHECK(line.size() <= columns);
            CHECK(has(line, "remaining "));
        }
    CHECK(has(progress_line(half, 39, true), "remaining 1:15"));
    CHECK(has(progress_line(longest, 39, true), "remaining 710:00:00"));
}

TEST_CASE("a terminal of 80 columns shows everything and a bar", "[progress]") {
    const std::string line = progress_line(half, 79, true);
    CHECK(has(line, "pass 32/64  0.11 M photons/s  elapsed 1:15  remaining 1:15"));
    CHECK(line.find("[##") == 0);
    CHECK(progress_line(half, 200, true).find("[############............] pass 32/64") == 0);
}

TEST_CASE("what a progress line has no room for goes in order", "[progress]") {
    bool bar = true, rate = true, elapsed = true, pass = true;
    for (std::size_t columns = 200; columns >= 14; --columns) {
        const std::string line = progress_line(half, columns, true);
        CAPTURE(columns, line);
        CHECK((bar || !has(line, "[")));
        CHECK((rate || !has(line, "M photons/s")));
        CHECK((elapsed || !has(line, "elapsed")));
        CHECK((pass || !has(line, "pass")));
        bar = has(line, "[");
        rate = has(line, "M photons/s");
        elapsed = has(line, "elapsed");
        pass = has(line, "pass");
        CHECK((rate || !bar));
        CHECK((elapsed || !rate));
        CHECK((pass || !elapsed));
    }
    CHECK_FALSE(pass);
}

TEST_CASE("lines of a log have no bar", "[progress]") {
    CHECK(progress_line(half, std::string::npos, false) ==
          "pass 32/64  0.11 M photons/s  elapsed 1:15  remaining 1:15");
}

TEST_CASE("what pauses the passes is not counted", "[progress]") {
    Progress progress(4, true);
    progress.start();
    const double before_s = progress.elapsed_s();
    progress.pause([] { std::this_thread::sleep_for(std::chrono::milliseconds(400)); });
    CHECK(progress.elapsed_s() - before_s < 0.3);
    CHECK(progress.elapsed_s() >= before_s);
}

TEST_CASE("processor time counts work, not waiting, and what pauses the passes not at all", "[progress]") {
    const auto work = [] {
        const std::clock_t end = std::clock() + CLOCKS_PER_SEC / 5;
        while (std::clock() < end) {
        }
    };
    Progress progress(4, true);
    work();
    progress.start();
    CHECK(progress.processor_s() < 0.05);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    progress.pause(work);
    CHECK(progress.processor_s() < 0.1);
    work();
    CHECK(progress.processor_s() > 0.19);
    CHECK(progress.processor_s() < 0.3);
}
