// A scene to trace in tests, and the double-precision crossing of a line with a triangle.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "host/scene/bvh/bvh_builder.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/triangle_meshes.hpp"

namespace stokes {

inline constexpr float infinity = std::numeric_limits<float>::infinity();

inline std::vector<std::string> with_layout(std::vector<std::string> options, const BvhLayout& layout) {
    for (const std::string& option : bvh_kernel_options(layout)) options.push_back(option);
    return options;
}

// The scene on the device, with its kernels.
struct Traced {
    explicit Traced(const std::vector<Triangle>& scene, const std::vector<std::string>& options = {},
                    const BvhLayout& layout = {16, BvhBounds::counts})
        : triangles(scene),
          bvh(build_bvh(scene, layout)),
          program(test_device(), "trace_rays.cl", with_layout(options, bvh.layout)),
          nodes(test_device(), "nodes", bvh.nodes),
          blocks(test_device(), "blocks", bvh.blocks),
          triangle_buffer(test_device(), "triangles", scene) {}

    Arguments arguments() const {
        return Arguments().add("bvh_nodes", nodes, "BvhNode").add("bvh_blocks", blocks).add("bvh_grid", bvh.grid);
    }
    std::vector<Hit> closest(const std::vector<Ray>& rays) {
        const Buffer<Ray> in(test_device(), "rays", rays);
        const Buffer<Hit> out(test_device(), "hits", rays.size());
        const auto n = static_cast<cl_uint>(rays.size());
        program.kernel("trace_closest_all").launch(n, arguments().add("n", n).add("rays", in).add("hits", out));
        return out.download();
    }
    std::vector<Hit> packets(const std::vector<Ray>& rays) {
        const Buffer<Ray> in(test_device(), "rays", rays);
        const Buffer<Hit> out(test_device(), "hits", rays.size());
        const auto n = static_cast<cl_uint>(rays.size());
        program.kernel("trace_packets").launch((n + 15) / 16, arguments().add("n", n).add("rays", in).add("hits", out));
        return out.download();
    }
    std::vector<cl_uint> any(const std::vector<Ray>& rays) {
        const Buffer<Ray> in(test_device(), "rays", rays);
        const Buffer<cl_uint> out(test_device(), "occluded", rays.size());
        const auto n = static_cast<cl_uint>(rays.size());
        program.kernel("trace_any").launch(n, arguments().add("n", n).add("rays", in).add("occluded", out));
        return out.download();
    }
    std::vector<Hit> probe(const std::vector<Probe>& probes) {
        const Buffer<Probe> in(test_device(), "probes", probes);
        const Buffer<Hit> out(test_device(), "hits", probes.size());
        const auto n = static_cast<cl_uint>(probes.size());
        program.kernel("trace_probe")
            .launch(n,
                    arguments().add("n", n).add("triangles", triangle_buffer).add("probes", in).add("probe_hits", out));
        return out.download();
    }

    std::vector<Triangle> triangles;
    Bvh bvh;
    Program program;
    Buffer<std::uint32_t> nodes;
    Buffer<BvhBlock> blocks;
    Buffer<Triangle> triangle_buffer;
};

inline Ray make_ray(const glm::vec3& o, const glm::vec3& d, float t_min = 0.0f, float t_max = infinity) {
    return {o.x, o.y, o.z, t_min, d.x, d.y, d.z, t_max};
}

inline std::vector<Ray> random_rays(int count, float lo, float hi, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> where(lo, hi);
    std::normal_distribution<float> normal;
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        const float x = where(random), y = where(random), z = where(random);
        const float dx = normal(random), dy = normal(random), dz = normal(random);
        rays.push_back(make_ray({x, y, z}, glm::normalize(glm::vec3(dx, dy, dz))));
    }
    return rays;
}

// Moeller and Trumbore 1997 in double precision: t where the line meets the triangle, shrunk by margin in
// each barycentric coordinate; NaN where it does not.
inline double crossing(const Triangle& t, const glm::dvec3& o, const glm::dvec3& d, double margin) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const glm::dvec3 p = glm::cross(d, e2_of(t));
    const double det = glm::dot(e1_of(t), p);
    if (std::fabs(det) < 1e-4 * glm::length(e1_of(t)) * glm::length(e2_of(t)) || det == 0.0) return nan;
    const glm::dvec3 s = (o - v0_of(t)) / det, q = glm::cross(s, e1_of(t));
    const double u = glm::dot(s, p), v = glm::dot(d, q);
    if (u < margin || v < margin || u + v > 1.0 - margin) return nan;
    return glm::dot(e2_of(t), q);
}

}  // namespace stokes
