// stokes_bench: how fast the kernels are, beside Embree and beside C++.
#include <fmt/format.h>
#include <stdlib.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <thread>

#include "host/core/atomic_file.hpp"
#include "tests/bench/bench.hpp"
#ifdef STOKES_WITH_EMBREE
#include "tests/bench/embree_caster.hpp"
#endif

namespace stokes::bench {

Json to_json(const Spread& spread) { return {{"median", spread.median}, {"q1", spread.low}, {"q3", spread.high}}; }

namespace {

std::string processor() {
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line);)
        if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
    return "unknown";
}

double load() {
    double average = 0.0;
    return ::getloadavg(&average, 1) == 1 ? average : 0.0;
}

Json machine(const Setting& setting) {
    const DeviceDescription& device = setting.device.description();
    Json json{{"processor", processor()},
              {"cores", std::thread::hardware_concurrency()},
              {"threads", setting.threads},
              {"device", device.name},
              {"platform", device.platform},
              {"driver", device.driver},
              {"ray_kernel", word_of(setting.device.ray_shape())},
              {"opencl", device.version},
              {"load_at_start", load()}};
#ifdef STOKES_WITH_EMBREE
    json["embree"] = embree_version();
#else
    json["embree"] = nullptr;
#endif
    fmt::print("{}, {} threads; {}, {} {}; Embree {}; load {:.1f}\n", processor(), setting.threads, device.name,
               device.platform, device.driver, json["embree"].is_null() ? "none" : json["embree"].get<std::string>(),
               load());
    return json;
}

struct Options {
    std::string json_file, only, mesh, device, ray_kernel;
    bool quick = false, tiny = false;
    int threads = 0;
};

Json run(const Options& options, const std::string& own_program) {
    Setting setting;
    setting.device = Device::open(options.device, options.threads);
    if (const auto shape = value_of_word<RayShape>(options.ray_kernel)) setting.device.set_ray_shape(*shape);
    setting.threads = options.threads > 0 ? static_cast<unsigned>(options.threads)
                                          : std::max(1u, std::thread::hardware_concurrency());
    setting.amount = options.tiny ? Amount::tiny : options.quick ? Amount::quick : Amount::full;
    setting.own_mesh = options.mesh;
    setting.own_program = own_program;
    setting.device_selector = options.device;
    Json json{{"machine", machine(setting)}};
    json["amount"] = options.tiny ? "tiny" : options.quick ? "quick" : "full";
    const auto wanted = [&](const char* section) { return options.only.empty() || options.only == section; };
    if (wanted("rays")) json["rays"] = bench_rays(setting);
    if (wanted("map")) json["photon_map"] = bench_photon_map(setting);
    if (wanted("photons")) json["photons"] = bench_photons(setting);
    if (wanted("pass")) json["pass"] = bench_pass(setting);
    if (wanted("growth")) json["growth"] = bench_growth(setting);
    json["machine"]["load_at_end"] = load();
    return json;
}

}  // namespace

}  // namespace stokes::bench

int main(int argc, char** argv) {
    CLI::App app("Measures rays, photon maps and passes; see scripts/README.md.", "stokes_bench");
    stokes::bench::Options options;
    app.add_option("--json", options.json_file, "Write all figures here")->type_name("FILE");
    app.add_option("--only", options.only, "One part: rays, map, photons, pass or growth")
        ->check(CLI::IsMember({"rays", "map", "photons", "pass", "growth"}));
    app.add_option("--mesh", options.mesh, "Cast rays at this mesh too")
        ->type_name("FILE.ply")
        ->check(CLI::ExistingFile);
    app.add_option("--device", options.device, "platform:device, part of a name, cpu or gpu");
    app.add_option("--ray-kernel", options.ray_kernel, "How rays are traced; default: by the device")
        ->check(CLI::IsMember(stokes::words_of<stokes::RayShape>));
    app.add_option("--threads", options.threads, "Threads of the device, of Embree and of the C++ twin; default: all")
        ->check(CLI::Range(1, 4096));
    app.add_flag("--quick", options.quick, "Smaller and fewer: within a minute");
    app.add_flag("--tiny", options.tiny, "As little as can be: a test of this program, its times mean nothing");
    CLI11_PARSE(app, argc, argv);
    try {
        const stokes::bench::Json json = stokes::bench::run(options, "/proc/self/exe");
        if (!options.json_file.empty()) stokes::write_file_atomically(options.json_file, json.dump(2) + "\n");
        return 0;
    } catch (const stokes::InputError& error) {
        fmt::print(stderr, "stokes_bench: {}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "stokes_bench: {}\n", error.what());
        return 1;
    }
}
