#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "host/image/exr.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;

namespace {

struct Outcome {
    int code;
    std::string out, err;
};

Outcome run(const std::string& arguments, const std::string& environment = "") {
    const TemporaryFolder folder;
    const std::string command = environment + " " + STOKES_BINARY + " " + arguments + " > " + folder.file("out") +
                                " 2> " + folder.file("err") + " < /dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), file_content(folder.file("out")),
            file_content(folder.file("err"))};
}

const std::string sphere = std::string(STOKES_SOURCE_DIR) + "/scenes/sphere.json";
const std::string small = " --passes 2 --photons 4000 --size 24x16 ";

}  // namespace

TEST_CASE("render writes the picture, the PNG and the figures", "[command line]") {
    const TemporaryFolder folder;
    const Outcome outcome = run("render " + sphere + small + "--seed 7 -o " + folder.file("a.exr") + " --png " +
                                folder.file("a.png") + " --stats " + folder.file("a.json"));
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(folder.names() == std::vector<std::string>{"a.exr", "a.json", "a.png"});
    CHECK(outcome.err.find("pass 2/2") != std::string::npos);

    const ExrImage image = read_exr(folder.file("a.exr"));
    CHECK(image.width == 24);
    CHECK(image.height == 16);
    REQUIRE(image.layers.size() == 5);
    double brightest = 0.0;
    for (std::size_t i = 0; i < image.layers.at("").size(); ++i) {
        float sum = 0.0f;
        for (const char* layer : {"fluorescence", "single", "multiple", "surface"}) sum += image.layers.at(layer)[i];
        CHECK(sum == Approx(image.layers.at("")[i]).epsilon(1e-5).margin(1e-5));
        brightest = std::max(brightest, static_cast<double>(sum));
    }
    CHECK(brightest > 0.0);
    CHECK(std::get<int>(image.attributes.at("stokes.passes")) == 2);

    const auto stats = nlohmann::json::parse(file_content(folder.file("a.json")));
    CHECK(stats["passes"] == 2);
    CHECK(stats["seed"] == 7);
    CHECK(stats["photons_emitted"] == 8000);
    CHECK(stats["rays_traced"].get<int>() >= 8000 + 2 * 24 * 16);
    CHECK(stats["radius_last_mm"] < stats["radius_first_mm"]);
    for (const char* kernel : {"emit_photons", "trace_closest", "classify_photons", "gather_radiance"})
        CHECK(stats["stages"].contains(kernel));
    for (const char* cause : {"missed_exit", "map_full", "event_limit", "not_finite"})
        CHECK(stats["dropped"].contains(cause));
    const auto& ledger = stats["ledger"];
    const double balance = ledger["emitted"].get<double>() + ledger["created"].get<double>() -
                           ledger["absorbed"].get<double>() - ledger["stokes_loss"].get<double>() -
                           ledger["escaped"].get<double>() - ledger["dropped"].get<double>() -
                           ledger["roulette"].get<double>();
    CHECK(std::abs(balance) < 1e-4 * ledger["emitted"].get<double>());
    CHECK(ledger["stored"].get<double>() > 0.0);
}

TEST_CASE("bad input is one line and exit code 2, and leaves no file", "[command line]") {
    const TemporaryFolder folder;
    const std::string out = " --png " + folder.path() + "/x.png";
    put_file(folder.file("bad.json"), "{\n  \"format\": \"stokes-scene\",\n  \"version\": 1,\n  \"camra\": {}\n}\n");
    struct Case {
        std::string arguments, expected;
    };
    for (const Case& c : std::vector<Case>{
             {"", "subcommand"},
             {"paint", "subcommand"},
             {"render", "scene"},
             {"render " + sphere, "output"},
             {"render nowhere.json" + out, "nowhere.json"},
             {"render " + folder.file("bad.json") + out, "bad.json:4: unknown key \"camra\"; did you mean \"camera\"?"},
             {"render " + sphere + " --passes 0" + out, "passes"},
             {"render " + sphere + " --passes x" + out, "passes"},
             {"render " + sphere + " --photons -3" + out, "photons"},
             {"render " + sphere + " --size 10" + out, "--size"},
             {"render " + sphere + " --size 0x4" + out, "--size"},
             {"render " + sphere + " --alpha 2" + out, "alpha"},
             {"render " + sphere + " --radius 0" + out, "radius"},
             {"render " + sphere + " --colour red" + out, "--colour"},
             {"render " + sphere + " --device abacus" + out, "abacus"},
             {"render " + sphere + small + "--max-memory 0.001" + out, "memory"},
             {"render " + sphere + " --png " + folder.path() + "/none/x.png", "none/x.png"},
             {"tables " + sphere, "-o"},
         }) {
        const Outcome outcome = run(c.arguments);
        CAPTURE(c.arguments, outcome.err);
        CHECK(outcome.code == 2);
        CHECK(outcome.err.find("stokes: ") == 0);
        CHECK(outcome.err.find(c.expected) != std::string::npos);
        CHECK(outcome.out.empty());
    }
    CHECK(folder.names() == std::vector<std::string>{"bad.json"});
}

TEST_CASE("a device named in the environment that PoCL does not know is refused", "[command line]") {
    const Outcome outcome = run("devices", "POCL_DEVICES=pthrad");
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find("pthrad") != std::string::npos);
}

TEST_CASE("devices lists at least one CPU", "[command line]") {
    const Outcome outcome = run("devices");
    CHECK(outcome.code == 0);
    CHECK(outcome.out.find("0:0") == 0);
    CHECK(outcome.out.find("CPU") != std::string::npos);
}

TEST_CASE("help and version are no errors", "[command line]") {
    CHECK(run("--help").code == 0);
    CHECK(run("render --help").out.find("--photons") != std::string::npos);
    CHECK(run("--version").code == 0);
}

TEST_CASE("an interrupted render writes the passes it has", "[command line]") {
    const TemporaryFolder folder;
    // The signal arrives while passes run: timeout sends it after some seconds, the render would take minutes.
    const std::string command = "timeout --preserve-status -s INT 6 " + std::string(STOKES_BINARY) + " render " + sphere +
                                " --passes 1000000 --photons 4000 --size 24x16 --quiet --stats " + folder.file("a.json") +
                                " --png " + folder.file("a.png");
    const int status = std::system(command.c_str());
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 130);
    CHECK(folder.names() == std::vector<std::string>{"a.json", "a.png"});
    const auto stats = nlohmann::json::parse(file_content(folder.file("a.json")));
    CHECK(stats["passes"] >= 1);
    CHECK(stats["passes"] < 1000000);
}
