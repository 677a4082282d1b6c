#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "host/core/csv_table.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;

namespace {

// A render of more passes than anyone waits for, on a terminal of 80 columns.
class TerminalRender {
  public:
    explicit TerminalRender(const std::vector<std::string>& extra, const std::string& cache = "") {
        std::vector<std::string> words = {stokes_program(), "render", sphere_scene, "--passes", "100000000",
                                          "--photons",      "4000",   "--size",     "24x16"};
        words.insert(words.end(), extra.begin(), extra.end());
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        winsize size{24, 80, 0, 0};
        child_ = ::forkpty(&terminal_, nullptr, nullptr, &size);
        if (child_ < 0) throw std::runtime_error("no terminal to be had");
        if (child_ == 0) {
            if (!cache.empty()) ::setenv("POCL_CACHE_DIR", cache.c_str(), 1);
            ::execv(arguments[0], arguments.data());
            ::_exit(127);
        }
    }
    TerminalRender(const TerminalRender&) = delete;
    TerminalRender& operator=(const TerminalRender&) = delete;
    ~TerminalRender() {
        if (child_ > 0) {
            ::kill(child_, SIGKILL);
            ::waitpid(child_, nullptr, 0);
        }
        ::close(terminal_);
    }

    // Reads until text has come; false when the program ends or two minutes pass before.
    bool wait_for(const std::string& text) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        while (shown_.find(text) == std::string::npos)
            if (std::chrono::steady_clock::now() > end || !read_some()) return false;
        return true;
    }
    void press_ctrl_c() { CHECK(::write(terminal_, "\x03", 1) == 1); }
    // Exit code, or 128 + the signal.
    int end() {
        wait_for("no such text");
        int status = 0;
        ::waitpid(child_, &status, 0);
        child_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    const std::string& shown() const { return shown_; }

  private:
    bool read_some() {
        pollfd ready{terminal_, POLLIN, 0};
        char bytes[4096];
        if (::poll(&ready, 1, 1000) == 0) return true;
        const ssize_t count = ::read(terminal_, bytes, sizeof bytes);
        if (count > 0) shown_.append(bytes, static_cast<std::size_t>(count));
        return count > 0;
    }
    pid_t child_ = -1;
    int terminal_ = -1;
    std::string shown_;
};

}  // namespace

TEST_CASE("an interrupted render writes the passes it has", "[command line]") {
    const TemporaryFolder folder;
    TerminalRender render({"--stats", folder.file("a.json"), "--png", folder.file("a.png")});
    REQUIRE(render.wait_for("remaining "));
    render.press_ctrl_c();
    CHECK(render.end() == 130);
    CHECK(render.shown().find("preparing") < render.shown().find("pass "));
    CHECK(folder.names() == std::vector<std::string>{"a.json", "a.png"});
    const auto stats = nlohmann::json::parse(file_content(folder.file("a.json")));
    CHECK(stats["passes"] >= 1);
    CHECK(stats["passes"] < 100000000);
}

TEST_CASE("an interrupted or killed render leaves its error curve up to there", "[command line]") {
    const TemporaryFolder folder;
    const std::string reference = folder.file("r.exr"), csv = folder.file("e.csv");
    REQUIRE(run_stokes("render " + sphere_scene + small_render + "--quiet -o " + reference).code == 0);
    {
        TerminalRender render({"--rmse-against", reference, "--csv", csv, "--stats", folder.file("a.json")});
        REQUIRE(render.wait_for("pass 3"));
        render.press_ctrl_c();
        CHECK(render.end() == 130);
    }
    const CsvTable curve = read_csv(csv);
    REQUIRE(curve.lines.size() >= 3);
    CHECK(curve.values[0][0] == 1);
    CHECK(curve.values[0][1] == 2);
    CHECK(curve.values[0].back() == nlohmann::json::parse(file_content(folder.file("a.json")))["passes"]);
    {
        TerminalRender render({"--rmse-against", reference, "--csv", csv, "--every", "1", "--quiet"});
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        // The curve of the render before is replaced by that of this one, which has every pass.
        for (CsvTable rows = curve; rows.lines.size() < 30 || rows.values[0][29] != 30.0; rows = read_csv(csv)) {
            if (std::chrono::steady_clock::now() > end) FAIL("no row after two minutes");
            ::usleep(1000);
        }
    }  // killed
    const CsvTable left = read_csv(csv);
    CHECK(left.lines.size() >= 30);
    CHECK(left.values[0].back() == static_cast<double>(left.lines.size()));
    CHECK(file_content(csv).back() == '\n');
}

// With no compiled kernels at hand, so that the signal falls into a build: the driver's linker must not die
// of it.
TEST_CASE("a render interrupted before its first pass says so and writes nothing", "[command line]") {
    const TemporaryFolder folder;
    for (const useconds_t delay_us : {0u, 300000u, 900000u}) {
        const TemporaryFolder cache;
        TerminalRender render({"--png", folder.file("a.png")}, cache.path());
        REQUIRE(render.wait_for("preparing (compiling kernels ...)"));
        ::usleep(delay_us);
        render.press_ctrl_c();
        CHECK(render.end() == 130);
        CAPTURE(delay_us, render.shown());
        CHECK(render.shown().find("stokes: interrupted before the first pass: nothing was written") !=
              std::string::npos);
        CHECK(render.shown().find("rror") == std::string::npos);
        CHECK(folder.names().empty());
    }
}

TEST_CASE("a quiet render says nothing", "[command line]") {
    const TemporaryFolder folder;
    const Outcome outcome =
        run_stokes("render " + sphere_scene + small_render + "--quiet --png " + folder.file("a.png"));
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
    CHECK(outcome.out.empty());
}
