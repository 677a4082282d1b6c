#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <random>

#include "host/render/camera_view.hpp"
#include "host/render/ray_casting.hpp"
#include "tests/bench/bench.hpp"
#include "tests/bench/bench_scenes.hpp"
#include "tests/bench/hit_check.hpp"
#ifdef STOKES_WITH_EMBREE
#include "tests/bench/embree_caster.hpp"
#endif

namespace stokes::bench {

namespace {

constexpr float endless = std::numeric_limits<float>::infinity();

enum class Kind { closest, coherent, any };

struct RaySet {
    std::string name;
    Kind kind;
    std::vector<Ray> rays;
};

struct Casting {
    std::string name;
    std::vector<Triangle> triangles;
    std::vector<RaySet> sets;
};

Ray make_ray(const glm::vec3& o, const glm::vec3& d, float t_max = endless) {
    return {o.x, o.y, o.z, 0.0f, d.x, d.y, d.z, t_max};
}

class Places {
  public:
    Places(const Box& box, std::uint32_t seed) : box_(box), random_(seed) {}
    glm::vec3 in_box() {
        const float x = unit_(random_), y = unit_(random_), z = unit_(random_);
        return box_.low + (box_.high - box_.low) * glm::vec3(x, y, z);
    }
    glm::vec3 direction() {
        for (;;) {
            const float x = normal_(random_), y = normal_(random_), z = normal_(random_);
            const glm::vec3 d(x, y, z);
            if (glm::dot(d, d) > 1e-6f) return glm::normalize(d);
        }
    }
    std::size_t below(std::size_t count) { return random_() % count; }

  private:
    Box box_;
    std::mt19937 random_;
    std::uniform_real_distribution<float> unit_{0.0f, 1.0f};
    std::normal_distribution<float> normal_;
};

// Uniform places and directions within the bounds of the scene.
std::vector<Ray> incoherent_rays(const Box& box, std::size_t count) {
    Places places(box, 11);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 from = places.in_box();
        rays.push_back(make_ray(from, places.direction()));
    }
    return rays;
}

// Between two uniform places: finite segments.
std::vector<Ray> segments(const Box& box, std::size_t count) {
    Places places(box, 12);
    std::vector<Ray> rays;
    while (rays.size() < count) {
        const glm::vec3 from = places.in_box(), way = places.in_box() - from;
        const float length = glm::length(way);
        if (length > 0.0f) rays.push_back(make_ray(from, way / length, length));
    }
    return rays;
}

// As light goes on from a diffuse surface: from random triangles, cosine-distributed, in random order.
std::vector<Ray> bounces(const std::vector<Triangle>& triangles, const Box& box, std::size_t count) {
    Places places(box, 13);
    std::vector<Ray> rays;
    const float off = 1e-5f * glm::length(box.high - box.low);
    while (rays.size() < count) {
        const Triangle& t = triangles[places.below(triangles.size())];
        const glm::vec3 e1(t.e1x, t.e1y, t.e1z), e2(t.e2x, t.e2y, t.e2z), normal = glm::cross(e1, e2);
        const float length = glm::length(normal);
        if (!(length > 0.0f)) continue;
        const glm::vec3 n = normal / length, way = n + 0.999f * places.direction();
        rays.push_back(make_ray(glm::vec3(t.v0x, t.v0y, t.v0z) + (e1 + e2) / 3.0f + off * n, glm::normalize(way)));
    }
    return rays;
}

// The renderer's own camera rays, in its own order, edge x edge of them.
std::vector<Ray> camera_rays(const Device& device, const Camera& camera, int edge) {
    CameraView view(device, make_camera_record(camera, edge, edge));
    PassConstants pass{};
    pass.seed = 1;
    const Buffer<PassConstants> constants(device, "pass", std::vector<PassConstants>{pass});
    const Buffer<Ray> rays(device, "camera rays", view.ray_count());
    view.make_rays(Arguments("pass", constants), rays);
    return rays.download();
}

// From outside, the whole scene in sight; or, in closed scenes, from a corner.
Camera camera_for(const Box& box, bool inside) {
    const glm::dvec3 low(box.low), high(box.high), centre = 0.5 * (low + high);
    Camera camera;
    camera.target_mm = centre;
    camera.position_mm =
        inside ? low + 0.02 * (high - low) : centre + glm::dvec3(0.35, 0.3, 0.9) * glm::length(high - low);
    camera.vertical_fov_deg = inside ? 75.0 : 50.0;
    return camera;
}

// share: of the usual number of rays, for scenes whose rays take long.
Casting make_casting(const Setting& setting, const std::string& name, std::vector<Triangle> triangles, bool closed,
                     double share) {
    const auto count = static_cast<std::size_t>(share * setting.pick(2000.0, 200000.0, 1000000.0));
    const int edge = static_cast<int>(std::sqrt(share) * setting.pick(64, 512, 1024)) / 8 * 8;
    const Box box = bounds_of(triangles);
    Casting casting{name, {}, {}};
    casting.sets.push_back({"closest", Kind::closest, incoherent_rays(box, count)});
    casting.sets.push_back({"bounce", Kind::closest, bounces(triangles, box, count)});
    casting.sets.push_back({"any", Kind::any, segments(box, count)});
    casting.sets.push_back({"camera", Kind::coherent, camera_rays(setting.device, camera_for(box, closed), edge)});
    casting.triangles = std::move(triangles);
    return casting;
}

// The kernels of one program. camera: what the renderer casts camera rays by, which takes so many rays a work-item.
struct Caster {
    Kernel closest, any, camera;
    std::uint32_t packet;
    Caster(const Device& device, const RayKernels& kernels) : packet(kernels.packets ? ray_packet : 1) {
        const Program program = kernels.program(device, "trace_rays.cl");
        closest = program.kernel("trace_closest_all");
        any = program.kernel("trace_any");
        camera = program.kernel(kernels.packets ? "trace_packets" : "trace_closest_all");
    }
};

// The same nodes traversed without the processor's own instructions.
RayKernels portable_kernels(const BvhLayout& layout) {
    RayKernels kernels{bvh_kernel_options(layout), true};
    kernels.options.push_back("-DSTOKES_BVH_PORTABLE");
    return kernels;
}

// Of one set of rays. The contestants write to their own arrays, so that all hits can be compared.
struct Outcome {
    Contest contest;
    HitCount hits;
};

#ifdef STOKES_WITH_EMBREE
struct Others {
    EmbreeCaster fast, robust;
    Others(const std::vector<Triangle>& triangles, unsigned threads)
        : fast(triangles, threads, false), robust(triangles, threads, true) {}
};
#else
struct Others {
    Others(const std::vector<Triangle>&, unsigned) {}
};
#endif

std::vector<Hit> reference_hits([[maybe_unused]] const Others& others, [[maybe_unused]] Team& team,
                                [[maybe_unused]] const Casting& casting, const RaySet& set) {
#ifdef STOKES_WITH_EMBREE
    std::vector<Hit> hits(set.rays.size());
    others.robust.closest(team, set.rays, hits);
    return hits;
#else
    return search_all(casting.triangles, set.rays, std::max<std::size_t>(10, 20000000 / casting.triangles.size()));
#endif
}

bool same_hit(const Hit& a, const Hit& b) {
    return a.triangle == b.triangle && (a.triangle == STOKES_NONE || a.t == b.t);
}

class RayBench {
  public:
    explicit RayBench(Setting& setting) : setting_(setting), team_(setting.threads) {}

    Json run(const Casting& casting) {
        const Device& device = setting_.device;
        Bvh bvh;
        const double build_s =
            time_of([&] { bvh = build_bvh(casting.triangles, ray_layout(device), setting_.threads); }).wall_s;
        const RayScene scene(device, bvh);
        usual_.emplace(device, scene.kernels);
        portable_.emplace(device, portable_kernels(bvh.layout));
        const Others others(casting.triangles, setting_.threads);
        Json json{{"triangles", casting.triangles.size()},
                  {"build_s", build_s},
                  {"bvh_width", bvh.layout.width},
                  {"bvh_bounds", bvh.layout.bounds == BvhBounds::floats ? "floats" : "counts"},
                  {"bvh_bytes", bvh.nodes.size() * 4 + bvh.blocks.size() * sizeof(BvhBlock)}};
#ifdef STOKES_WITH_EMBREE
        json["embree_build_s"] = others.fast.build_wall_s();
#endif
        bvh = {};
        fmt::print("\n{} ({} triangles, built in {:.2f} s)\n", casting.name, casting.triangles.size(), build_s);
        fmt::print("  {:<9}{:>9}{:>10}{:>10}{:>19}{:>11}{:>8}{:>9}{:>8}\n", "rays", "Mray/s", "portable", "vs Embree",
                   "quartiles", "portable", "differ", "inexact", "wrong");
        std::size_t wrong = 0, inexact = 0;
        for (const RaySet& set : casting.sets) {
            Outcome outcome;
            measure(casting, set, scene, others, outcome);
            report(set, outcome, json);
            wrong += outcome.hits.wrong;
            inexact += outcome.hits.inexact;
        }
        json["wrong_hits"] = wrong;
        json["inexact_hits"] = inexact;
        return json;
    }

  private:
    void measure(const Casting& casting, const RaySet& set, const RayScene& scene, const Others& others,
                 Outcome& outcome) {
        const auto n = static_cast<std::uint32_t>(set.rays.size());
        const Buffer<Ray> rays(setting_.device, "rays", set.rays);
        const Buffer<Hit> hits(setting_.device, "hits", n), portable_hits(setting_.device, "hits", n);
        const Buffer<std::uint32_t> occluded(setting_.device, "occluded", n),
            portable_occluded(setting_.device, "occluded", n);
        const auto cast = [&](Caster& caster, const Buffer<Hit>& out, const Buffer<std::uint32_t>& out_any) {
            if (set.kind == Kind::any)
                caster.any.launch(n, scene.arguments().add("n", n).add("rays", rays).add("occluded", out_any));
            else if (set.kind == Kind::coherent)
                caster.camera.launch((n + caster.packet - 1) / caster.packet,
                                     scene.arguments().add("n", n).add("rays", rays).add("hits", out));
            else
                caster.closest.launch(n, scene.arguments().add("n", n).add("rays", rays).add("hits", out));
            setting_.device.finish();
        };
        outcome.contest.add("ours", [&] { cast(*usual_, hits, occluded); });
        outcome.contest.add("portable", [&] { cast(*portable_, portable_hits, portable_occluded); });
#ifdef STOKES_WITH_EMBREE
        std::vector<Hit> embree_hits(n);
        std::vector<std::uint32_t> embree_occluded(n);
        const auto embree = [&](const EmbreeCaster& caster) {
            if (set.kind == Kind::any) caster.any(team_, set.rays, embree_occluded);
            if (set.kind == Kind::closest) caster.closest(team_, set.rays, embree_hits);
            if (set.kind == Kind::coherent) caster.coherent(team_, set.rays, embree_hits);
        };
        outcome.contest.add("embree", [&] { embree(others.fast); });
        outcome.contest.add("robust", [&] { embree(others.robust); });
#endif
        outcome.contest.run(setting_.pick(1, 3, 9));
        if (set.kind == Kind::any) {  // what lies on a segment must be what the nearest hit says
            usual_->closest.launch(n, scene.arguments().add("n", n).add("rays", rays).add("hits", hits));
            portable_->closest.launch(n, scene.arguments().add("n", n).add("rays", rays).add("hits", portable_hits));
        }
        const std::vector<Hit> ours = hits.download(), others_hits = portable_hits.download();
        outcome.hits = check_hits(casting.triangles, set.rays, ours, reference_hits(others, team_, casting, set));
        for (std::size_t i = 0; i < n; ++i) outcome.hits.wrong += !same_hit(ours[i], others_hits[i]);
        if (set.kind != Kind::any) return;
        const std::vector<std::uint32_t> any = occluded.download(), portable_any = portable_occluded.download();
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint32_t expected = ours[i].triangle != STOKES_NONE ? 1u : 0u;
            outcome.hits.wrong += any[i] != expected || portable_any[i] != expected;
        }
    }

    void report(const RaySet& set, const Outcome& outcome, Json& json) const {
        const Contest& contest = outcome.contest;
        const double rays = static_cast<double>(set.rays.size());
        const auto rate_of = [&](const char* name) {
            return 1e-6 * rays * setting_.threads / contest.cpu_s(name).median;
        };
        const double rate = rate_of("ours"), portable_rate = rate_of("portable");
        Json more{{"rays", set.rays.size()},
                  {"hits", outcome.hits.hits},
                  {"compared", outcome.hits.rays},
                  {"differ", outcome.hits.differ},
                  {"wrong", outcome.hits.wrong},
                  {"inexact", outcome.hits.inexact},
                  {"reference_wrong", outcome.hits.reference_wrong},
                  {"reference_inexact", outcome.hits.reference_inexact},
                  {"wall_s", to_json(contest.wall_s("ours"))},
                  {"cpu_s", to_json(contest.cpu_s("ours"))},
                  {"mrays_per_s", rate},
                  {"mrays_per_s_portable", portable_rate},
                  {"portable_wall_s", to_json(contest.wall_s("portable"))}};
        std::string columns = fmt::format("{:>10}{:>19}{:>11}", "-", "-", "-");
        if (contest.has("embree")) {
            const std::string suffix = set.kind == Kind::coherent ? "_vs_embree16" : "_vs_embree";
            const Spread ratio = contest.cpu_ratio("embree", "ours");
            const Spread portable = contest.cpu_ratio("embree", "portable");
            json[set.name + suffix] = ratio.median;
            json[set.name + "_portable" + suffix] = portable.median;
            more["ratio"] = to_json(ratio);
            more["ratio_wall"] = to_json(contest.wall_ratio("embree", "ours"));
            more["ratio_portable"] = to_json(portable);
            more["ratio_portable_wall"] = to_json(contest.wall_ratio("embree", "portable"));
            more["ratio_to_robust"] = to_json(contest.cpu_ratio("robust", "ours"));
            more["mrays_per_s_embree"] = rate_of("embree");
            columns = fmt::format("{:>10.2f}{:>19}{:>11.2f}", ratio.median,
                                  fmt::format("{:.2f} - {:.2f}", ratio.low, ratio.high), portable.median);
        }
        json["detail"][set.name] = more;
        fmt::print("  {:<9}{:>9.2f}{:>10.2f}{}{:>8}{:>9}{:>8}\n", set.name, rate, portable_rate, columns,
                   outcome.hits.differ, outcome.hits.inexact, outcome.hits.wrong);
        std::fflush(stdout);
    }

    Setting& setting_;
    Team team_;
    std::optional<Caster> usual_, portable_;
};

}  // namespace

Json bench_rays(Setting& setting) {
    fmt::print(
        "\nRays: times as fast as Embree, by processor time, median of the rounds. closest, bounce: rtcIntersect1;\n"
        "any: rtcOccluded1; camera: coherent rtcIntersect16. Rays per second are those of {} undisturbed threads\n",
        setting.threads);
    const std::string meshes = std::string(STOKES_SOURCE_DIR) + "/scenes/meshes/";
    RayBench bench(setting);
    Json json = Json::object();
    // One scene at a time: the large one takes a gigabyte.
    const auto run = [&](const std::string& name, std::vector<Triangle> triangles, bool closed, double share = 1.0) {
        json[name] = bench.run(make_casting(setting, name, std::move(triangles), closed, share));
    };
    run("dragon", mesh_triangles(meshes + "dragon_48k.ply"), false);
    run("bunny", mesh_triangles(meshes + "bunny_closed.ply"), false);
    run("needles", needle_room(setting.pick(50, 1000, 1000)), true, setting.pick(1.0, 0.125, 0.125));
    run("large", sphere_hall(setting.pick<std::size_t>(20000, 300000, 3000000)), true, setting.pick(1.0, 1.0, 0.4));
    if (!setting.own_mesh.empty()) run("own", mesh_triangles(setting.own_mesh), false);
    return json;
}

}  // namespace stokes::bench
