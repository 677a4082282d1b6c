#include <fmt/format.h>

#include <cmath>
#include <random>

#include "host/render/gather.hpp"
#include "host/render/spatial_hash.hpp"
#include "tests/bench/bench.hpp"
#include "tests/bench/map_twin.hpp"

namespace stokes::bench {

namespace {

constexpr float sheet_mm = 100.0f;  // edge
constexpr double found_per_query = 26.0;

// Slots of photons over a wavy sheet; one in eight is empty.
struct Photons {
    std::vector<PhotonHead> heads;
    std::vector<Flux16> flux;
};

float height_at(float x, float y) { return 4.0f * std::sin(0.1f * x) * std::sin(0.13f * y); }

glm::vec3 normal_at(float x, float y) {
    return glm::normalize(glm::vec3(-0.4f * std::cos(0.1f * x) * std::sin(0.13f * y),
                                    -0.52f * std::sin(0.1f * x) * std::cos(0.13f * y), 1.0f));
}

// Of body 0 (kernels/lib/normal.clh).
std::uint32_t pack(const glm::vec3& n) {
    const auto quantised = [](float c) { return static_cast<std::uint32_t>(std::lround(c * 127.0f)) & 255u; };
    return quantised(n.x) | (quantised(n.y) << 8) | (quantised(n.z) << 16);
}

// clustered: 7 of 10 photons lie at the bright side of a nephroid, the caustic of parallel light in a cylinder,
// thinning out with the distance from it over two radii of the density estimate; the others, and all without it, are
// uniform.
Photons make_photons(std::uint32_t slots, bool clustered, float radius_mm) {
    std::mt19937 random(clustered ? 21 : 20);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    Photons photons;
    photons.heads.reserve(slots);
    photons.flux.reserve(slots);
    for (std::uint32_t i = 0; i < slots; ++i) {
        float x = sheet_mm * unit(random), y = sheet_mm * unit(random);
        if (clustered && unit(random) < 0.7f) {
            const float t = 6.2831853f * unit(random);
            const float inward = 1.0f + 2.0f * radius_mm * std::log(1.0f - unit(random)) / (0.4f * sheet_mm);
            const float edge = 0.1f * sheet_mm * inward;
            x = 0.5f * sheet_mm + edge * (3.0f * std::cos(t) - std::cos(3.0f * t));
            y = 0.5f * sheet_mm + edge * (3.0f * std::sin(t) - std::sin(3.0f * t));
        }
        const bool empty = i % 8 == 5;
        photons.heads.push_back({x, y, height_at(x, y), empty ? STOKES_EMPTY_SLOT : pack(normal_at(x, y))});
        Flux16 flux;
        for (float& v : flux.v) v = unit(random);
        photons.flux.push_back(flux);
    }
    return photons;
}

// One query a pixel of a view from above, in tiles of 8 x 8 as the camera's.
std::vector<GatherPoint> make_points(std::uint32_t edge) {
    std::vector<GatherPoint> points;
    for (std::uint32_t i = 0; i < edge * edge; ++i) {
        const std::uint32_t tile = i / 64, tiles = edge / 8;
        const std::uint32_t px = tile % tiles * 8 + i % 8, py = tile / tiles * 8 + i % 64 / 8;
        const float x = sheet_mm * (static_cast<float>(px) + 0.5f) / static_cast<float>(edge);
        const float y = sheet_mm * (static_cast<float>(py) + 0.5f) / static_cast<float>(edge);
        const glm::vec3 n = normal_at(x, y);
        points.push_back(
            {x, y, height_at(x, y), py * edge + px, n.x, n.y, n.z, 0, 1u << STOKES_MAP_SURFACE, 1.0f, 0, 0, 1.0f, 0});
    }
    return points;
}

PassConstants make_pass() {
    PassConstants pass{};
    for (int k = 0; k < 16; ++k) {
        pass.to_x[k] = 1.0f + 0.1f * static_cast<float>(k);
        pass.to_y[k] = 2.0f - 0.1f * static_cast<float>(k);
        pass.to_z[k] = 1.5f;
    }
    return pass;
}

// Largest relative differences between the kernels' results and the twin's.
struct Agreement {
    double starts = 0.0, positions = 0.0, flux = 0.0, film = 0.0;
};

double relative(double a, double b) { return std::fabs(a - b) / std::max({std::fabs(a), std::fabs(b), 1e-30}); }

// Weighted with the index, so that order counts.
template <class T>
double check_sum(const T* values, std::size_t count) {
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) sum += static_cast<double>(values[i]) * static_cast<double>(i % 1021 + 1);
    return sum;
}

class MapBench {
  public:
    MapBench(Setting& setting, bool clustered)
        : setting_(setting),
          slots_(setting.pick(1u << 15, 1u << 20, 1u << 20)),
          edge_(setting.pick(64u, 512u, 512u)),
          radius_mm_(
              static_cast<float>(std::sqrt(found_per_query * sheet_mm * sheet_mm / (M_PI * slots_ * 7.0 / 8.0)))),
          photons_(make_photons(slots_, clustered, radius_mm_)),
          points_(make_points(edge_)),
          team_(setting.threads),
          builder_(setting.device, slots_),
          hash_(setting.device, "bench", slots_),
          heads_(setting.device, "heads", photons_.heads),
          flux_(setting.device, "flux", photons_.flux),
          points_on_device_(setting.device, "points", points_),
          spectra_(setting.device, "spectra", std::vector<Flux16>{white()}),
          textures_(setting.device, "textures", std::vector<TextureRecord>{{0, 0, 0, STOKES_NONE}}),
          pass_(setting.device, "pass", std::vector<PassConstants>{make_pass()}),
          film_(setting.device, "film",
                std::vector<FilmValue>(STOKES_LAYER_COUNT * points_.size(), FilmValue{0, 0, 0, 0})),
          gather_(Program(setting.device, "gather_radiance.cl").kernel("gather_radiance")) {}

    Json run(const std::string& name) {
        build();
        twin_ = std::make_unique<MapTwin>(team_, slots_, hash_.grid());
        const HugeArray<PhotonHead> heads(slots_);
        const HugeArray<Flux16> flux(slots_);
        const HugeArray<float> film(16 * points_.size());
        std::copy(photons_.heads.begin(), photons_.heads.end(), heads.get());
        std::copy(photons_.flux.begin(), photons_.flux.end(), flux.get());
        const PassConstants pass = make_pass();
        const Flux16 spectrum = white();
        const auto twin_gather = [&] {
            twin_->gather(points_.data(), static_cast<std::uint32_t>(points_.size()), STOKES_MAP_SURFACE, &spectrum,
                          pass, film.get());
        };
        Contest build_contest, gather_contest;
        build_contest.add("ours", [&] { build(); });
        build_contest.add("twin", [&] { twin_->sort(heads.get(), slots_), twin_->permute(heads.get(), flux.get()); });
        build_contest.add("twin permute", [&] { twin_->permute(heads.get(), flux.get()); });
        const int rounds = setting_.pick(1, 7, 31);
        setting_.device.reset_stage_times();
        build_contest.run(rounds);
        const std::map<std::string, StageTime> stages = setting_.device.stage_times();
        gather_contest.add("ours", [&] { gather(); });
        gather_contest.add("twin", twin_gather);
        gather_contest.run(rounds);
        return report(name, build_contest, gather_contest, stages, compare(film.get()));
    }

  private:
    static Flux16 white() {
        Flux16 row;
        for (float& v : row.v) v = 0.9f;
        return row;
    }
    void build() {
        builder_.build(hash_, heads_, flux_, slots_, {0.0f, 0.0f, -4.0f}, {sheet_mm, sheet_mm, 4.0f}, radius_mm_);
        setting_.device.finish();
    }
    void gather() {
        const auto count = static_cast<std::uint32_t>(points_.size());
        gather_.launch(count, Arguments()
                                  .add("gather_points", points_on_device_)
                                  .add("count", count)
                                  .add("map", std::uint32_t{STOKES_MAP_SURFACE})
                                  .add("largest_factor", 1.0f)
                                  .add("spectra", spectra_)
                                  .add("texture_records", textures_)
                                  .add("pass", pass_)
                                  .add("film", film_, "float4")
                                  .add(hash_.arguments()));
        setting_.device.finish();
    }

    // Both films hold the same number of gathers.
    Agreement compare(const float* twin_film) const {
        const std::uint32_t n = hash_.count_photons();
        const HashGrid& grid = hash_.grid();
        Agreement result;
        const auto starts = hash_.cell_starts().download(grid.keys + 1);
        const auto positions = hash_.positions().download();
        const auto flux = hash_.flux().download(n);
        if (n != twin_->photons()) return {1.0, 1.0, 1.0, 1.0};
        result.starts =
            relative(check_sum(starts.data(), starts.size()), check_sum(twin_->cell_starts(), starts.size()));
        for (std::size_t axis = 0; axis < 3; ++axis)
            result.positions =
                std::max(result.positions, relative(check_sum(positions.data() + axis * grid.stride, n),
                                                    check_sum(twin_->positions() + axis * grid.stride, n)));
        result.flux =
            relative(check_sum(flux.data()->v, 16 * std::size_t{n}), check_sum(twin_->flux()->v, 16 * std::size_t{n}));
        const std::vector<FilmValue> film = film_.download();
        const FilmValue* layer = film.data() + STOKES_LAYER_SURFACE * points_.size();
        result.film = relative(check_sum(&layer->x, 4 * points_.size()),
                               check_sum(twin_film + 4 * STOKES_MAP_SURFACE * points_.size(), 4 * points_.size()));
        return result;
    }

    Json report(const std::string& name, const Contest& build, const Contest& gather,
                const std::map<std::string, StageTime>& stages, const Agreement& agreement) const {
        const double photons = hash_.count_photons(), queries = static_cast<double>(points_.size());
        const Spread build_ratio = build.cpu_ratio("twin", "ours"), gather_ratio = gather.cpu_ratio("twin", "ours");
        const auto ns = [&](const Contest& contest, const std::string& who, double count) {
            return 1e9 * contest.cpu_s(who).median / setting_.threads / count;
        };
        const StageTime& permute = stages.at("permute_photons");
        const double bytes = photons * (2.0 * 64.0 + 2.0 * 16.0 + 4.0);
        const double gb_per_s = 1e-9 * bytes * static_cast<double>(permute.launches) / permute.seconds;
        const double twin_permute_s = build.wall_s("twin permute").median;
        Json json{{"photons", photons},
                  {"queries", queries},
                  {"radius_mm", radius_mm_},
                  {"twin", twin_instructions()},
                  {"build_vs_cpp", build_ratio.median},
                  {"build_vs_cpp_wall", build.wall_ratio("twin", "ours").median},
                  {"gather_vs_cpp", gather_ratio.median},
                  {"gather_vs_cpp_wall", gather.wall_ratio("twin", "ours").median},
                  {"build_ratio", to_json(build_ratio)},
                  {"gather_ratio", to_json(gather_ratio)},
                  {"build_ns_per_photon", ns(build, "ours", photons)},
                  {"build_ns_per_photon_cpp", ns(build, "twin", photons)},
                  {"gather_ns_per_query", ns(gather, "ours", queries)},
                  {"gather_ns_per_query_cpp", ns(gather, "twin", queries)},
                  {"permute_GB_per_s", gb_per_s},
                  {"permute_GB_per_s_cpp", 1e-9 * bytes / twin_permute_s}};
        for (const auto& [kernel, time] : stages)
            json["build_stages_ns_per_photon"][kernel] =
                1e9 * time.seconds / static_cast<double>(time.launches) / photons;
        json["difference"] = {{"cell_starts", agreement.starts},
                              {"positions", agreement.positions},
                              {"flux", agreement.flux},
                              {"film", agreement.film}};
        const double worst = std::max({agreement.starts, agreement.positions, agreement.flux, agreement.film});
        json["agrees"] = worst < 1e-5;
        fmt::print("  {:<10}{:<8}{:>9.2f} ns/photon{:>9.2f} in C++{:>8.2f}   ({:.2f} - {:.2f})\n", name, "build",
                   ns(build, "ours", photons), ns(build, "twin", photons), build_ratio.median, build_ratio.low,
                   build_ratio.high);
        fmt::print("  {:<10}{:<8}{:>9.1f} ns/query {:>9.1f} in C++{:>8.2f}   ({:.2f} - {:.2f})\n", "", "gather",
                   ns(gather, "ours", queries), ns(gather, "twin", queries), gather_ratio.median, gather_ratio.low,
                   gather_ratio.high);
        fmt::print("  {:<10}{:<8}{:>9.1f} GB/s     {:>9.1f} in C++; largest difference {:.1e}\n", "", "permute",
                   gb_per_s, 1e-9 * bytes / twin_permute_s, worst);
        std::fflush(stdout);
        return json;
    }

    Setting& setting_;
    std::uint32_t slots_, edge_;
    float radius_mm_;
    Photons photons_;
    std::vector<GatherPoint> points_;
    Team team_;
    HashBuilder builder_;
    SpatialHash hash_;
    Buffer<PhotonHead> heads_;
    Buffer<Flux16> flux_;
    Buffer<GatherPoint> points_on_device_;
    Buffer<Flux16> spectra_;
    Buffer<TextureRecord> textures_;  // none
    Buffer<PassConstants> pass_;
    Buffer<FilmValue> film_;
    Kernel gather_;
    std::unique_ptr<MapTwin> twin_;
};

}  // namespace

Json bench_photon_map(Setting& setting) {
    fmt::print(
        "\nPhoton map: the ratio is C++ time / kernel time by processor time; the twin is compiled to {}. Nanoseconds "
        "are\n"
        "those of {} undisturbed threads\n",
        twin_instructions(), setting.threads);
    Json json = Json::object();
    for (const bool clustered : {false, true}) {
        const std::string name = clustered ? "clustered" : "uniform";
        MapBench bench(setting, clustered);
        json[name] = bench.run(name);
    }
    return json;
}

}  // namespace stokes::bench
