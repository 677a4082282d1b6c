// Every shape of the ray kernels, over every kind of nodes, finds the same hits, and packets find what single rays do.
#include <cmath>
#include <random>

#include "host/render/ray_casting.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/traced_scene.hpp"
#include "tests/support/triangle_meshes.hpp"

using namespace stokes;

namespace {

std::size_t count_hits(const std::vector<Hit>& hits) {
    std::size_t count = 0;
    for (const Hit& hit : hits) count += hit.triangle != STOKES_NONE;
    return count;
}

// As a pinhole camera at `from` casts them, edge x edge, in rows; spread: half the width of the picture at distance 1.
std::vector<Ray> camera_rays(const glm::vec3& from, const glm::vec3& to, float spread, int edge) {
    const glm::vec3 w = glm::normalize(to - from);
    const glm::vec3 u = glm::normalize(glm::cross(w, std::fabs(w.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
    const glm::vec3 v = glm::cross(u, w);
    std::vector<Ray> rays;
    for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) {
            const float a = spread * (2.0f * (static_cast<float>(x) + 0.5f) / static_cast<float>(edge) - 1.0f);
            const float b = spread * (2.0f * (static_cast<float>(y) + 0.5f) / static_cast<float>(edge) - 1.0f);
            rays.push_back(make_ray(from, glm::normalize(w + a * u + b * v)));
        }
    return rays;
}

const std::vector<std::vector<std::string>> shapes{{}, {"-DSTOKES_BVH_PORTABLE"}, {"-DSTOKES_BVH_SCALAR"}};
const std::vector<BvhLayout> layouts{
    {16, BvhBounds::counts}, {16, BvhBounds::floats}, {8, BvhBounds::counts}, {8, BvhBounds::floats}};

}  // namespace

TEST_CASE("all shapes over all nodes: nearest hits to the bit, any hits, probes") {
    std::vector<Triangle> triangles = sphere_mesh(24, 48, 30.0f, glm::vec3(50.0f));
    append(triangles, triangle_soup(1500, 3.0f, {10.0f, 0.01f, 0.01f}, 31));
    append(triangles, triangle_soup(1500, 4.0f, glm::vec3(1.0f), 32));
    std::vector<Ray> rays = random_rays(6000, -10.0f, 110.0f, 33), segments = random_rays(6000, 0.0f, 100.0f, 34);
    for (std::size_t i = 0; i < segments.size(); ++i) {
        segments[i].t_max = 0.5f * static_cast<float>(i % 97);
        segments[i].t_min = i % 3 == 0 ? 0.1f * segments[i].t_max : 0.0f;
    }
    std::vector<Probe> probes;
    for (const Ray& r : random_rays(3000, 10.0f, 90.0f, 35))
        probes.push_back({r.ox, r.oy, r.oz, 20.0f, r.dx, r.dy, r.dz, 0});

    Traced first(triangles, shapes.front(), layouts.front());
    const auto hits = first.closest(rays), near = first.closest(segments), found = first.probe(probes);
    const auto any = first.any(segments);
    REQUIRE(count_hits(hits) > 1500);
    REQUIRE(count_hits(near) > 500);
    REQUIRE(count_hits(near) < 5900);
    REQUIRE(count_hits(found) > 100);
    for (const BvhLayout& layout : layouts)
        for (const auto& shape : shapes) {
            CAPTURE(layout.width, layout.bounds == BvhBounds::floats, shape);
            Traced scene(triangles, shape, layout);
            CHECK(same_bits(hits, scene.closest(rays)));
            CHECK(same_bits(near, scene.closest(segments)));
            CHECK(same_bits(found, scene.probe(probes)));
            CHECK(any == scene.any(segments));
        }
}

TEST_CASE("packets find what single rays find: cameras outside, within, grazing and far away") {
    std::vector<Triangle> triangles = sphere_mesh(40, 80, 30.0f, glm::vec3(50.0f));
    append(triangles, triangle_soup(800, 3.0f, {12.0f, 0.02f, 0.02f}, 41));
    triangles.push_back(make_triangle({-100, 0, -100}, {-100, 0, 100}, {100, 0, 100}));
    triangles.push_back(make_triangle({-100, 0, -100}, {100, 0, 100}, {100, 0, -100}));
    std::vector<std::vector<Ray>> views{
        camera_rays({50, 60, 180}, {50, 50, 50}, 0.5f, 64),  // straight along an axis: signs change within packets
        camera_rays({160, 130, -70}, {50, 50, 50}, 0.6f, 64),
        camera_rays({50, 50, 50}, {20, 90, 60}, 1.3f, 64),        // all round, axes change within packets
        camera_rays({-90, 0.01f, 3}, {90, 0.01f, 2}, 0.02f, 64),  // along the floor
        camera_rays({5e5f, 4e5f, 6e5f}, {50, 50, 50}, 1e-4f, 64),
        camera_rays({50, 60, 180}, {50, 400, 50}, 0.2f, 64)};               // past everything
    views.push_back(random_rays(1000, -10.0f, 110.0f, 42));                 // nothing in common
    views.push_back(camera_rays({160, 130, -70}, {50, 50, 50}, 0.3f, 21));  // 441 rays: the last packet is not full
    std::vector<Ray> segments = camera_rays({160, 130, -70}, {50, 50, 50}, 0.5f, 32);
    for (std::size_t i = 0; i < segments.size(); ++i) {
        segments[i].t_min = i % 5 == 0 ? 150.0f : 0.0f;
        segments[i].t_max = i % 7 == 0 ? -1.0f : i % 3 == 0 ? 160.0f : infinity;  // some are not traced
    }
    views.push_back(segments);
    std::vector<Ray> shifted = camera_rays({160, 130, -70}, {50, 50, 50}, 0.5f, 32);
    std::mt19937 random(43);
    for (Ray& ray : shifted) ray.ox += 5.0f * static_cast<float>(random()) * 0x1p-32f;  // origins of their own
    views.push_back(shifted);

    std::size_t hits = 0, misses = 0;
    for (const BvhLayout& layout : layouts)
        for (const std::size_t shape : {std::size_t{0}, std::size_t{1}}) {
            Traced scene(triangles, shapes[shape], layout);
            for (std::size_t view = 0; view < views.size(); ++view) {
                CAPTURE(layout.width, layout.bounds == BvhBounds::floats, shape, view);
                const auto alone = scene.closest(views[view]);
                CHECK(same_bits(alone, scene.packets(views[view])));
                hits += count_hits(alone);
                misses += alone.size() - count_hits(alone);
            }
        }
    CHECK(hits > 8 * 8000);
    CHECK(misses > 8 * 4000);
}

TEST_CASE("packets in empty scenes, of one triangle, and with numbers that are not finite", "[tiny]") {
    const std::vector<Ray> rays = camera_rays({0.3f, 1.0f, 0.3f}, {0.3f, 0.0f, 0.3f}, 0.2f, 5);
    CHECK(count_hits(Traced({}).packets(rays)) == 0);
    Traced one({make_triangle({0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f})});
    CHECK(count_hits(one.packets(rays)) == rays.size());
    CHECK(same_bits(one.packets(rays), one.closest(rays)));
    std::vector<Ray> odd = rays;
    odd[3].dx = std::numeric_limits<float>::quiet_NaN();
    odd[19].oy = infinity;
    CHECK(same_bits(one.packets(odd), one.closest(odd)));
    CHECK(count_hits(one.packets(odd)) == rays.size() - 2);
}

TEST_CASE("a device's shape follows from its kind and its vectors") {
    DeviceDescription device;
    const auto shape = [&](bool cpu, unsigned floats, bool x86) {
        device.cpu = cpu;
        device.gpu = !cpu;
        device.vector_floats = floats;
        return choose_ray_shape(device, x86);
    };
    CHECK(shape(true, 16, true) == RayShape::avx512);
    CHECK(shape(true, 8, true) == RayShape::avx2);
    CHECK(shape(true, 4, true) == RayShape::portable);
    CHECK(shape(true, 16, false) == RayShape::portable);
    CHECK(shape(true, 4, false) == RayShape::portable);
    CHECK(shape(true, 1, true) == RayShape::scalar);
    CHECK(shape(false, 1, true) == RayShape::scalar);
    CHECK(shape(false, 4, true) == RayShape::scalar);
}

TEST_CASE("a shape that is asked for decides how nodes and kernels are made") {
    const auto triangles = sphere_mesh(12, 24, 10.0f, glm::vec3(0.0f));
    const std::vector<Ray> rays = random_rays(500, -12.0f, 12.0f, 51);
    const auto expected = Traced(triangles).closest(rays);
    Device& device = test_device();
    const RayShape usual = device.ray_shape();
    for (const RayShape shape : {RayShape::avx512, RayShape::avx2, RayShape::portable, RayShape::scalar}) {
        device.set_ray_shape(shape);
        CHECK(device.ray_shape() == shape);
        const RayScene scene(device, triangles);
        const int width = ray_layout(device).width;
        CHECK((shape == RayShape::avx512 ? width == 16 : shape == RayShape::portable || width == 8));
        CHECK(scene.kernels.packets == (shape != RayShape::scalar));
        const Buffer<Ray> in(device, "rays", rays);
        const Buffer<Hit> out(device, "hits", rays.size());
        const auto n = static_cast<cl_uint>(rays.size());
        scene.kernels.program(device, "trace_rays.cl")
            .kernel("trace_closest_all")
            .launch(n, Arguments().add("n", n).add(scene.arguments()).add("rays", in).add("hits", out));
        CHECK(same_bits(expected, out.download()));
    }
    device.set_ray_shape(usual);
}
