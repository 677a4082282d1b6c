#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>

#include "host/render/renderer.hpp"
#include "host/scene/readers/scene_reader.hpp"
#include "tests/bench/bench_scenes.hpp"
#include "tests/bench/photon_stage.hpp"
#include "tests/bench/stages.hpp"

namespace stokes::bench {

namespace {

constexpr float sorting_radius_mm = 1.0f;

Scene prisms(int edge, std::int64_t photons) {
    Scene scene = read_scene(std::string(STOKES_SOURCE_DIR) + "/scenes/prisms.json");
    scene.render.transport = Transport::paper;
    scene.render.photons_per_pass = photons;
    scene.film.width = scene.film.height = edge;
    return scene;
}

// Largest over smallest of a member of the entries.
double range_of(const Json& entries, const char* key) {
    double low = 1e300, high = 0.0;
    for (const Json& entry : entries) {
        low = std::min(low, entry[key].get<double>());
        high = std::max(high, entry[key].get<double>());
    }
    return high / low;
}

// From emission to maps in cell order.
Json grow_photons(Setting& setting) {
    Json entries = Json::array();
    const int last = setting.pick(12, 18, 22), step = setting.pick(2, 2, 1), first = setting.pick(10, 16, 16);
    fmt::print("  {:>10}{:>12}{:>14}{:>18}\n", "photons", "ms", "ns/photon", "ns/photon of cpu");
    for (int power = first; power <= last; power += step) {
        const std::uint32_t photons = 1u << power;
        PhotonStage stage(setting.device, prisms(64, photons), photons);
        std::vector<double> wall, cpu;
        const int runs = setting.pick(1, 5, std::clamp((1 << 24) / static_cast<int>(photons), 5, 25));
        for (int run = -2; run < runs; ++run) {
            stage.make_pass(static_cast<std::uint32_t>(run + 2));
            const Timing timing = time_of([&] { stage.trace(), stage.sort(sorting_radius_mm); });
            if (run < 0) continue;
            wall.push_back(timing.wall_s);
            cpu.push_back(timing.cpu_s);
        }
        const double seconds = spread_of(wall).median, cpu_s = spread_of(cpu).median;
        entries.push_back({{"photons", photons},
                           {"seconds", seconds},
                           {"cpu_seconds", cpu_s},
                           {"ns_per_photon", 1e9 * seconds / photons},
                           {"cpu_ns_per_photon", 1e9 * cpu_s / photons},
                           {"memory_bytes", setting.device.memory_in_use()}});
        fmt::print("  {:>10}{:>12.2f}{:>14.1f}{:>18.1f}\n", photons, 1e3 * seconds, 1e9 * seconds / photons,
                   1e9 * cpu_s / photons);
        std::fflush(stdout);
    }
    return entries;
}

// The camera's half of a pass, by the device's clock; few photons.
Json grow_pixels(Setting& setting) {
    Json entries = Json::array();
    const int last = setting.pick(64, 512, 2048), photons = setting.pick(1 << 10, 1 << 16, 1 << 16);
    fmt::print("  {:>10}{:>12}{:>14}\n", "pixels", "ms", "ns/pixel");
    for (int edge = setting.pick(32, 128, 128); edge <= last; edge *= 2) {
        Scene scene = prisms(edge, photons);
        scene.render.radius_mm = 4.0;  // the same at every size
        Renderer renderer(setting.device, scene);
        std::vector<double> camera;
        const int runs = setting.pick(1, 4, 7);
        for (int run = -2; run < runs; ++run) {
            setting.device.reset_stage_times();
            renderer.render_pass(static_cast<std::uint32_t>(run + 2));
            double seconds = 0.0;
            for (const auto& [kernel, time] : setting.device.stage_times())
                if (group_of(kernel) == "gathering" || kernel == "camera_rays" || kernel == "trace_closest_all")
                    seconds += time.seconds;
            if (run >= 0) camera.push_back(seconds);
        }
        const double pixels = static_cast<double>(edge) * edge, seconds = spread_of(camera).median;
        entries.push_back({{"pixels", pixels}, {"seconds", seconds}, {"ns_per_pixel", 1e9 * seconds / pixels}});
        fmt::print("  {:>10}{:>12.2f}{:>14.1f}\n", pixels, 1e3 * seconds, 1e9 * seconds / pixels);
        std::fflush(stdout);
    }
    return entries;
}

// The build on the host, and incoherent rays.
Json grow_triangles(Setting& setting) {
    Json entries = Json::array();
    const double last = setting.pick(1e4, 1e6, 1e7);
    fmt::print("  {:>10}{:>12}{:>14}{:>12}{:>12}\n", "triangles", "build s", "ns/triangle", "Mray/s", "bytes each");
    for (double wanted = 1e4; wanted <= last * 1.001; wanted *= 10.0) {
        const std::vector<Triangle> triangles = sphere_hall(static_cast<std::size_t>(wanted));
        Bvh bvh;
        const Timing build = time_of([&] { bvh = build_bvh(triangles, ray_layout(setting.device), setting.threads); });
        const double bytes = static_cast<double>(bvh.nodes.size() * 4 + bvh.blocks.size() * sizeof(BvhBlock));
        const RayScene scene(setting.device, bvh);
        bvh = {};
        Kernel closest = scene.kernels.program(setting.device, "trace_rays.cl").kernel("trace_closest_all");
        const auto n = setting.pick(1000u, 200000u, 500000u);
        std::vector<Ray> rays(n);
        std::uint32_t state = 1;
        const auto unit = [&] {
            state = state * 1664525u + 1013904223u;
            return static_cast<float>(state >> 8) * 0x1p-24f;
        };
        for (Ray& ray : rays) {
            const float z = 2.0f * unit() - 1.0f, turn = 6.2831853f * unit(), r = std::sqrt(1.0f - z * z);
            const float x = 1000.0f * unit(), y = 1000.0f * unit(), from_z = 1000.0f * unit();
            ray = {x, y, from_z, 0.0f, r * std::cos(turn), r * std::sin(turn), z, 1e30f};
        }
        const Buffer<Ray> in(setting.device, "rays", rays);
        const Buffer<Hit> out(setting.device, "hits", n);
        Contest contest;
        contest.add("trace", [&] {
            closest.launch(n, scene.arguments().add("n", n).add("rays", in).add("hits", out));
            setting.device.finish();
        });
        contest.run(setting.pick(1, 3, 5));
        const double count = static_cast<double>(triangles.size()),
                     rate = 1e-6 * n * setting.threads / contest.cpu_s("trace").median;
        entries.push_back({{"triangles", triangles.size()},
                           {"build_s", build.wall_s},
                           {"build_cpu_s", build.cpu_s},
                           {"build_ns_per_triangle", 1e9 * build.wall_s / count},
                           {"mrays_per_s", rate},
                           {"bvh_bytes", bytes}});
        fmt::print("  {:>10}{:>12.2f}{:>14.0f}{:>12.2f}{:>12.0f}\n", triangles.size(), build.wall_s,
                   1e9 * build.wall_s / count, rate, bytes / count);
        std::fflush(stdout);
    }
    return entries;
}

// Runs this program for a few passes with so many threads: PoCL takes their number when it starts. Wall time of the
// quickest of them, which other processes have disturbed least, and the median processor time.
Timing pass_in_own_process(const Setting& setting, int threads) {
    std::string name = (std::filesystem::temp_directory_path() / "stokes-bench-XXXXXX").string();
    const int file = ::mkstemp(name.data());
    if (file < 0) throw RunError(name + ": no temporary file");
    ::close(file);
    std::vector<std::string> words{setting.own_program,     "--only", "pass", "--threads",
                                   std::to_string(threads), "--json", name};
    words.push_back(setting.amount == Amount::tiny ? "--tiny" : "--quick");
    if (!setting.device_selector.empty()) words.insert(words.end(), {"--device", setting.device_selector});
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", 1, 0);  // O_WRONLY
    pid_t child = 0;
    int status = ::posix_spawn(&child, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (status == 0) ::waitpid(child, &status, 0);
    Timing timing;
    if (status == 0) {
        const Json pass = Json::parse(std::ifstream(name))["pass"];
        timing = {pass["seconds_min"].get<double>(), pass["cpu_seconds"].get<double>()};
    }
    ::unlink(name.c_str());
    if (!(timing.wall_s > 0.0)) throw RunError("a pass in a process of its own failed");
    return timing;
}

Json grow_threads(const Setting& setting) {
    Json entries = Json::array();
    std::vector<double> wall[2], cpu[2], speed_up;
    for (int round = 0; round < setting.pick(1, 1, 4); ++round) {
        for (int threads = 1; threads <= 2; ++threads) {
            const Timing timing = pass_in_own_process(setting, threads);
            wall[threads - 1].push_back(timing.wall_s);
            cpu[threads - 1].push_back(timing.cpu_s);
        }
        speed_up.push_back(wall[0].back() / wall[1].back());
    }
    for (int threads = 1; threads <= 2; ++threads) {
        const double seconds = spread_of(wall[threads - 1]).median, cpu_s = spread_of(cpu[threads - 1]).median;
        entries.push_back({{"threads", threads},
                           {"pass_seconds_min", seconds},
                           {"pass_cpu_seconds", cpu_s},
                           {"speed_up", threads == 1 ? 1.0 : spread_of(speed_up).median}});
        fmt::print("  {} thread{}: {:.1f} ms a pass at best, {:.1f} ms of processor time\n", threads,
                   threads == 1 ? "" : "s", 1e3 * seconds, 1e3 * cpu_s);
    }
    fmt::print("  {:.2f} times as fast\n", spread_of(speed_up).median);
    return entries;
}

}  // namespace

Json bench_growth(Setting& setting) {
    fmt::print("\nGrowth: photon half of a pass of prisms.json, emission to sorted maps\n");
    Json json = Json::object();
    json["photons"] = grow_photons(setting);
    json["photons_range"] = range_of(json["photons"], "ns_per_photon");
    json["photons_range_cpu"] = range_of(json["photons"], "cpu_ns_per_photon");
    fmt::print("  largest / smallest cost of a photon: {:.2f}, by processor time {:.2f}\n",
               json["photons_range"].get<double>(), json["photons_range_cpu"].get<double>());
    fmt::print("\nGrowth: camera half of a pass of prisms.json, 4 mm radius\n");
    json["pixels"] = grow_pixels(setting);
    json["pixels_range"] = range_of(json["pixels"], "ns_per_pixel");
    fmt::print("\nGrowth: spheres in a box\n");
    json["triangles"] = grow_triangles(setting);
    fmt::print("\nGrowth: threads\n");
    json["threads"] = grow_threads(setting);
    return json;
}

}  // namespace stokes::bench
