#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "host/render/renderer.hpp"
#include "host/scene/readers/scene_reader.hpp"
#include "tests/bench/photon_stage.hpp"
#include "tests/bench/stages.hpp"

namespace stokes::bench {

namespace {

constexpr std::uint32_t passes_of_render = 1024;

const char* const map_names[STOKES_MAP_COUNT] = {"fluorescence", "single", "multiple", "surface"};

Scene prisms(Transport transport, int edge, std::int64_t photons) {
    Scene scene = read_scene(std::string(STOKES_SOURCE_DIR) + "/scenes/prisms.json");
    scene.render.transport = transport;
    scene.render.photons_per_pass = photons;
    scene.film.width = scene.film.height = edge;
    return scene;
}

void print_stages(const std::map<std::string, StageTime>& stages, double runs, double wall_s) {
    std::vector<std::pair<double, std::string>> kernels;
    for (const auto& [kernel, time] : stages) kernels.emplace_back(time.seconds / runs, kernel);
    std::sort(kernels.rbegin(), kernels.rend());
    for (const auto& [seconds, kernel] : kernels)
        fmt::print("    {:<22}{:<12}{:>9.2f} ms{:>7.1f} %\n", kernel, group_of(kernel), 1e3 * seconds,
                   100.0 * seconds / wall_s);
}

double seconds_in(const std::map<std::string, StageTime>& stages,
                  const std::function<bool(const std::string&)>& which) {
    double sum = 0.0;
    for (const auto& [kernel, time] : stages) sum += which(kernel) ? time.seconds : 0.0;
    return sum;
}

Json photons_of(Setting& setting, Transport transport) {
    const auto photons = static_cast<std::uint32_t>(setting.pick(1 << 13, 1 << 18, 1 << 18));
    const std::string& model = word_of(transport);
    PhotonStage stage(setting.device, prisms(transport, 64, photons), photons);
    for (const std::uint32_t warm_up : {0u, 1u}) stage.make_pass(warm_up), stage.trace();
    setting.device.reset_stage_times();
    const int runs = setting.pick(1, 5, 15);
    std::vector<double> wall, cpu;
    PhotonAccount account;
    for (int run = 0; run < runs; ++run) {
        stage.make_pass(static_cast<std::uint32_t>(run + 2));
        const Timing timing = time_of([&] { account = stage.trace(); });
        wall.push_back(timing.wall_s);
        cpu.push_back(timing.cpu_s);
    }
    const std::map<std::string, StageTime> stages = setting.device.stage_times();
    const Spread seconds = spread_of(wall);
    const double kernels_s = seconds_in(stages, [](const std::string& k) { return group_of(k) != "tables"; });
    const double below_s = seconds_in(stages, is_subsurface);
    const double with_probes_s = below_s + seconds_in(stages, [](const std::string& k) { return k == "trace_probe"; });
    Json json{{"photons", photons},
              {"wall_s", to_json(seconds)},
              {"cpu_s", to_json(spread_of(cpu))},
              {"photons_per_s", photons / seconds.median},
              {"rays_per_s", static_cast<double>(account.rays) / seconds.median},
              {"rays_per_photon", static_cast<double>(account.rays) / photons},
              {"deposits_per_s", static_cast<double>(account.deposits) / seconds.median},
              {"subsurface_share", below_s / kernels_s},
              {"subsurface_share_with_probes", with_probes_s / kernels_s},
              {"outside_kernels_share", 1.0 - kernels_s / runs / spread_of(wall).median}};
    for (std::size_t m = 0; m < STOKES_MAP_COUNT; ++m) {
        const double slots = stage.maps()[m].used();
        json["components"][map_names[m]] = {{"slots", slots}, {"slots_per_s", slots / seconds.median}};
    }
    json["stages"] = stages_json(stages, runs);
    fmt::print("  {:<12}{:>8.2f} Mphotons/s ({:.1f} ms for {}; {:.2f} rays and {:.2f} deposits a photon)\n", model,
               1e-6 * photons / seconds.median, 1e3 * seconds.median, photons,
               static_cast<double>(account.rays) / photons, static_cast<double>(account.deposits) / photons);
    fmt::print("    below surfaces: {:.1f} % of the kernels' time, with the search for exit points {:.1f} %\n",
               100.0 * below_s / kernels_s, 100.0 * with_probes_s / kernels_s);
    print_stages(stages, runs, seconds.median);
    std::fflush(stdout);
    return json;
}

}  // namespace

Json bench_photons(Setting& setting) {
    fmt::print("\nPhotons of prisms.json, emission to last deposit\n");
    Json json = Json::object();
    for (const Transport transport : {Transport::paper, Transport::conserving, Transport::walk})
        if (transport == Transport::paper || setting.amount == Amount::full)
            json[word_of(transport)] = photons_of(setting, transport);
    return json;
}

// The median is of the first passes, whose radius is the largest; those spread over a whole render give its time.
Json bench_pass(Setting& setting) {
    const int edge = setting.pick(64, 512, 512), photons = setting.pick(1 << 12, 1 << 18, 1 << 18);
    Renderer renderer(setting.device, prisms(Transport::paper, edge, photons));
    const auto run = [&](std::uint32_t pass) {
        return time_of([&] {
            renderer.render_pass(pass);
            setting.device.finish();
        });
    };
    for (std::uint32_t pass = 0; pass < 3; ++pass) run(pass);  // the maps grow and kernels are compiled
    const int passes = setting.pick(1, 7, 31);
    std::vector<double> wall, cpu, spread_over;
    setting.device.reset_stage_times();
    for (int pass = 0; pass < passes; ++pass) {
        const Timing timing = run(static_cast<std::uint32_t>(pass));
        wall.push_back(timing.wall_s);
        cpu.push_back(timing.cpu_s);
    }
    const std::map<std::string, StageTime> stages = setting.device.stage_times();
    const int samples = setting.pick(1, 8, 32);
    double sum = 0.0;
    for (int i = 0; i < samples; ++i)
        sum += run(passes_of_render * static_cast<std::uint32_t>(i) / static_cast<std::uint32_t>(samples)).wall_s;

    const Spread seconds = spread_of(wall);
    double all = 0.0;
    for (const double s : wall) all += s;
    const double work = seconds_in(stages, [](const std::string& k) { return !is_overhead(group_of(k)); });
    const double kernels = seconds_in(stages, [](const std::string&) { return true; });
    const Json stage_times = stages_json(stages, passes);
    Json json{{"scene", "scenes/prisms.json"},
              {"width", edge},
              {"height", edge},
              {"photons", photons},
              {"passes", passes},
              {"seconds", seconds.median},
              {"seconds_spread", to_json(seconds)},
              {"seconds_min", *std::min_element(wall.begin(), wall.end())},
              {"cpu_seconds", spread_of(cpu).median},
              {"seconds_for_1024_passes", sum / samples * passes_of_render},
              {"overhead_share", 1.0 - work / all},
              {"outside_kernels_share", 1.0 - kernels / all},
              {"stages", stage_times["kernels"]},
              {"groups", stage_times["groups"]}};
    for (const auto& [kernel, time] : stages) json["group_of_kernel"][kernel] = group_of(kernel);
    fmt::print(
        "\nPass of prisms.json, {} x {}, {} photons: {:.1f} ms ({:.1f} - {:.1f}, at best {:.1f}),\n  {:.1f} ms of "
        "processor time\n",
        edge, edge, photons, 1e3 * seconds.median, 1e3 * seconds.low, 1e3 * seconds.high,
        1e3 * *std::min_element(wall.begin(), wall.end()), 1e3 * spread_of(cpu).median);
    fmt::print(
        "  1024 passes: {:.1f} min; outside tracing, depositing and gathering {:.1f} %, outside kernels {:.1f} %\n",
        sum / samples * passes_of_render / 60.0, 100.0 * (1.0 - work / all), 100.0 * (1.0 - kernels / all));
    print_stages(stages, passes, all / passes);
    std::fflush(stdout);
    return json;
}

}  // namespace stokes::bench
