#include <cmath>
#include <cstring>
#include <vector>

#include "host/render/gather.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/textures.hpp"
#include "tests/support/traced_scene.hpp"

using namespace stokes;

namespace {

constexpr float offset_mm = 1e-3f;
constexpr float exit_scale = 1.125f;  // binary, and no other number of these tests

// Materials of the tests, by index.
enum : std::uint32_t { black, grey, glossy, clear };

// A square of 20 mm about a point; its front looks along normal, +y or -y.
struct Plate {
    float y = 0.0f, normal = 1.0f;
    std::uint32_t material = glossy;
    std::uint32_t light = STOKES_NONE;
};

struct Seen {
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    std::vector<GatherPoint> points;
    std::vector<FilmValue> emission;  // the film's surface layer
};

// Plates one above the other, and rays given one a pixel of a picture one pixel high: ray and pixel are the same.
class Bench {
  public:
    Bench(const std::vector<Plate>& plates, float eta) {
        std::vector<ShapeRecord> shapes;
        for (const Plate& p : plates) {
            const float x = 10.0f * p.normal;
            const glm::vec3 corners[4] = {{-x, p.y, -10}, {-x, p.y, 10}, {x, p.y, 10}, {x, p.y, -10}};
            for (int half = 0; half < 2; ++half) {
                const glm::vec3 e1 = corners[half + 1] - corners[0], e2 = corners[half + 2] - corners[0];
                triangles_.push_back({corners[0].x, corners[0].y, corners[0].z, static_cast<unsigned>(shapes.size()),
                                      e1.x, e1.y, e1.z, 0, e2.x, e2.y, e2.z, 0});
            }
            shapes.push_back({p.material, p.light});
        }
        std::vector<MaterialRecord> materials(4);
        for (MaterialRecord& m : materials) m.eta = eta;
        materials[grey].kind = STOKES_DIFFUSE;
        materials[glossy].kind = materials[clear].kind = STOKES_TRANSLUCENT;
        materials[glossy].flags = materials[clear].flags = STOKES_MATERIAL_SUBSURFACE | STOKES_MATERIAL_FRESNEL;
        materials[glossy].exit_scale = exit_scale;
        materials[clear].eta = 1.0f;
        materials[clear].exit_scale = 1.0f;
        Flux16 light{};
        light.v[0] = 3.0f;
        std::vector<LightRecord> lights(1);
        lights[0].kind = STOKES_LIGHT_SURFACE;
        const Device& device = test_device();
        rays_ = RayScene(device, triangles_);
        scene_ = rays_.arguments()
                     .add("triangles", Buffer<Triangle>(device, "triangles", triangles_))
                     .add("shapes", Buffer<ShapeRecord>(device, "shapes", shapes))
                     .add("materials", Buffer<MaterialRecord>(device, "materials", materials))
                     .add("light_count", 1u)
                     .add("lights", Buffer<LightRecord>(device, "lights", lights))
                     .add("light_areas", Buffer<float>(device, "areas", 1))
                     .add("light_radiance", Buffer<Flux16>(device, "emitted", std::vector<Flux16>{light}))
                     .add(no_textures(materials.size()).arguments());
    }

    Seen see(const std::vector<Ray>& rays, std::uint32_t pass_index = 0) {
        const Device& device = test_device();
        PassConstants pass{};
        pass.seed = 11;
        pass.pass = pass_index;
        pass.offset_mm = offset_mm;
        pass.to_x[0] = 1.0f;
        const Buffer<PassConstants> pass_buffer(device, "pass", std::vector<PassConstants>{pass});
        CameraRecord camera{};
        camera.width = static_cast<unsigned>(rays.size());
        camera.height = 1;
        camera.position_x = rays[0].ox;
        camera.position_y = rays[0].oy;
        camera.position_z = rays[0].oz;
        const Buffer<Ray> ray_buffer(device, "rays", rays);
        const Buffer<Hit> hits(device, "hits", rays.size());
        const Buffer<FilmValue> film(device, "film",
                                     std::vector<FilmValue>(STOKES_LAYER_COUNT * rays.size(), FilmValue{0, 0, 0, 0}));
        const Arguments common = Arguments("pass", pass_buffer).add(scene_);
        const Arguments own =
            Arguments("camera", camera).add("rays", ray_buffer).add("hits", hits).add("n", camera.width);
        rays_.kernels.program(device, "trace_rays.cl").kernel("trace_closest_all").launch(rays.size(), common, own);
        rays_.kernels.program(device, "trace_reflections.cl")
            .kernel("trace_reflections")
            .launch(rays.size(), common, own);
        Gather gather(device, rays_.kernels, camera);
        gather.collect_points(common, ray_buffer, hits, film);
        Seen seen{ray_buffer.download(), hits.download(), gather.points().download(), film.download()};
        seen.emission.erase(seen.emission.begin(), seen.emission.begin() + STOKES_LAYER_SURFACE * camera.width);
        return seen;
    }

    const std::vector<Triangle>& triangles() const { return triangles_; }
    // Which plate a hit is on, -1: none.
    static int plate_of(const Hit& hit) {
        return hit.triangle == STOKES_NONE ? -1 : static_cast<int>(hit.triangle / 2);
    }

  private:
    std::vector<Triangle> triangles_;
    RayScene rays_;
    Arguments scene_;
};

// Rays from one point above the plane y = 0 that meet it near the origin at this cosine, from azimuths about a right
// angle, so that no two are the same.
std::vector<Ray> rays_down(std::size_t count, double cosine, float height_mm = 4.0f) {
    const double sine = std::sqrt(1.0 - cosine * cosine), away = height_mm * sine / cosine;
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const double turn = 0.5 * static_cast<double>(i) / static_cast<double>(count);
        rays.push_back(make_ray({0.1f, height_mm, static_cast<float>(-0.5 * away)},
                                glm::vec3(static_cast<float>(sine * std::sin(turn)), static_cast<float>(-cosine),
                                          static_cast<float>(sine * std::cos(turn)))));
    }
    return rays;
}

bool same_ray(const Ray& a, const Ray& b) { return std::memcmp(&a, &b, sizeof(Ray)) == 0; }

// Unpolarised, from outside.
double reflectance(double mu, double eta) {
    const double within = std::sqrt(1.0 - (1.0 - mu * mu) / (eta * eta));
    const double s = (mu - eta * within) / (mu + eta * within), p = (eta * mu - within) / (eta * mu + within);
    return 0.5 * (s * s + p * p);
}

// Rays on one plate below a black ceiling with a light: each either stays as it was or is mirrored.
void check_plate(double cosine, double eta, std::size_t count, double most_z) {
    CAPTURE(cosine, eta);
    Bench bench({{0.0f, 1.0f, glossy}, {5.0f, -1.0f, black, 0}}, static_cast<float>(eta));
    const std::vector<Ray> rays = rays_down(count, cosine);
    const Seen seen = bench.see(rays);
    double mirrored = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        CAPTURE(i);
        const GatherPoint& point = seen.points[i];
        REQUIRE(point.pixel == i);
        const glm::dvec3 d(rays[i].dx, rays[i].dy, rays[i].dz);
        const double t = rays[i].oy / -d.y;
        const glm::dvec3 met(rays[i].ox + t * d.x, 0.0, rays[i].oz + t * d.z);
        if (same_ray(seen.rays[i], rays[i])) {
            REQUIRE(Bench::plate_of(seen.hits[i]) == 0);
            REQUIRE(static_cast<double>(seen.hits[i].t) == Approx(t).epsilon(1e-5));
            REQUIRE(point.weight == exit_scale);
            REQUIRE(point.maps != 0u);
            REQUIRE(point.reflected == 0u);
            REQUIRE(glm::length(glm::dvec3(point.x, point.y, point.z) - met) < 1e-4);
            REQUIRE(seen.emission[i].x == 0.0f);
        } else {
            ++mirrored;
            const Ray& ray = seen.rays[i];
            REQUIRE(glm::length(glm::dvec3(ray.dx, ray.dy, ray.dz) - glm::dvec3(d.x, -d.y, d.z)) < 1e-6);
            REQUIRE(glm::length(glm::dvec3(ray.ox, ray.oy, ray.oz) - met - glm::dvec3(0.0, offset_mm, 0.0)) < 1e-4);
            REQUIRE(ray.t_min == 0.0f);
            REQUIRE(ray.t_max == infinity);
            // The ceiling is 10 mm to all sides: rays off the plate at a small angle miss it.
            const double x = met.x + 5.0 * d.x / cosine, z = met.z + 5.0 * d.z / cosine;
            if (std::max(std::abs(x), std::abs(z)) < 9.9) {
                REQUIRE(Bench::plate_of(seen.hits[i]) == 1);
                REQUIRE(seen.emission[i].x == 3.0f);
            }
            if (std::max(std::abs(x), std::abs(z)) > 10.1) REQUIRE(seen.hits[i].triangle == STOKES_NONE);
            REQUIRE(point.weight == 1.0f);
            REQUIRE(point.reflected == 1u);
            REQUIRE(point.maps == 0u);
        }
    }
    const double expected = reflectance(cosine, eta), n = static_cast<double>(count);
    CAPTURE(mirrored / n, expected);
    CHECK(std::abs(mirrored - n * expected) < most_z * std::sqrt(n * expected * (1.0 - expected)));
}

}  // namespace

TEST_CASE("a few rays are mirrored or end at a smooth surface", "[trace_reflections][tiny]") {
    check_plate(0.35, 1.5, 40, 4.0);
}

// Twelve comparisons at 4 standard errors: wrong by chance once in 1300 choices of seed.
TEST_CASE("the share of rays that a smooth surface mirrors is its reflectance", "[trace_reflections]") {
    for (const double eta : {1.33, 1.5, 2.42})
        for (const double cosine : {1.0, 0.7, 0.45, 0.35}) check_plate(cosine, eta, 40000, 4.0);
}

TEST_CASE("passes and pixels draw reflections of their own", "[trace_reflections][tiny]") {
    Bench bench({{0.0f, 1.0f, glossy}}, 5.0f);  // R = 0.44 head on
    const std::vector<Ray> rays(64, make_ray({0.1f, 4.0f, 0.2f}, {0.0f, -1.0f, 0.0f}));
    std::vector<std::vector<bool>> ended;
    for (const std::uint32_t pass : {0u, 1u, 0u}) {
        ended.emplace_back();
        for (const Hit& hit : bench.see(rays, pass).hits) ended.back().push_back(hit.triangle != STOKES_NONE);
    }
    CHECK(ended[0] == ended[2]);
    CHECK(ended[0] != ended[1]);
    CHECK(std::count(ended[0].begin(), ended[0].end(), true) > 10);
    CHECK(std::count(ended[0].begin(), ended[0].end(), true) < 54);
}

// Backs, other materials, an index of one, nothing at all: rays stay as they were, and hits are those of
// trace_closest_all.
TEST_CASE("what does not reflect is seen as without reflection", "[trace_reflections][tiny]") {
    for (const Plate& plate : {Plate{0.0f, -1.0f, glossy}, Plate{0.0f, 1.0f, grey}, Plate{0.0f, 1.0f, black},
                               Plate{0.0f, 1.0f, clear}, Plate{9.0f, 1.0f, glossy}}) {
        CAPTURE(plate.y, plate.material);
        Bench bench({plate}, 20.0f);
        const std::vector<Ray> rays = rays_down(50, 0.35);
        const Seen seen = bench.see(rays);
        const std::vector<Hit> expected = Traced(bench.triangles()).closest(rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            REQUIRE(same_ray(seen.rays[i], rays[i]));
            REQUIRE(seen.hits[i].triangle == expected[i].triangle);
            if (expected[i].triangle != STOKES_NONE)
                REQUIRE(std::memcmp(&seen.hits[i], &expected[i], sizeof(Hit)) == 0);
            REQUIRE(seen.points[i].weight == 1.0f);
            REQUIRE(seen.points[i].reflected == 0u);
        }
    }
}

// Between two plates head on, a ray ends at its k-th meeting with probability R^k (1 - R), on one plate or the other by
// turns, and sees black with probability R^65.
TEST_CASE("rays between two parallel mirrors end on either by turns, or are given up", "[trace_reflections]") {
    for (const float eta : {20.0f, 200.0f}) {
        CAPTURE(eta);
        Bench bench({{0.0f, 1.0f, glossy}, {5.0f, -1.0f, glossy}}, eta);
        const std::size_t count = 20000;
        const Seen seen = bench.see(std::vector<Ray>(count, make_ray({0.1f, 4.0f, 0.2f}, {0.0f, -1.0f, 0.0f})));
        std::vector<double> observed(3, 0.0), expected(3, 0.0);
        for (std::size_t i = 0; i < count; ++i) {
            const int plate = Bench::plate_of(seen.hits[i]);
            observed[static_cast<std::size_t>(plate + 1)] += 1.0;
            REQUIRE((seen.points[i].maps != 0u) == (plate >= 0));
            REQUIRE(seen.points[i].weight == (plate >= 0 ? exit_scale : 1.0f));
        }
        const double r = reflectance(1.0, static_cast<double>(eta));
        double reached = static_cast<double>(count);
        for (std::size_t k = 0; k < 65; ++k) {
            expected[1 + k % 2] += reached * (1.0 - r);
            reached *= r;
        }
        expected[0] = reached;
        CAPTURE(observed, expected);
        CHECK(chi_square_p_value(observed, expected) > 1e-3);
    }
}

TEST_CASE("a ray between perfect mirrors is given up", "[trace_reflections][tiny]") {
    Bench bench({{0.0f, 1.0f, glossy, 0}, {5.0f, -1.0f, glossy, 0}}, 1e9f);
    const Seen seen = bench.see(std::vector<Ray>(20, make_ray({0.1f, 4.0f, 0.2f}, {0.0f, -1.0f, 0.0f})));
    for (std::size_t i = 0; i < seen.hits.size(); ++i) {
        CHECK(seen.hits[i].triangle == STOKES_NONE);
        CHECK(seen.points[i].maps == 0u);
        CHECK(seen.emission[i].x == 0.0f);
    }
}

TEST_CASE("a reflection in a reflection is seen", "[trace_reflections]") {
    Bench bench({{0.0f, 1.0f, glossy}, {5.0f, -1.0f, glossy}}, 1e9f);
    const glm::vec3 from(3.0f, 4.0f, 0.2f), d = glm::normalize(glm::vec3(0.625f, -1.0f, 0.0f));
    const Seen seen = bench.see(std::vector<Ray>(4, make_ray(from, d)));
    for (std::size_t i = 0; i < seen.rays.size(); ++i) {
        // x = 5.5 on the lower plate, 8.625 on the upper, 11.75 down beside the lower, where nothing lies.
        CHECK(seen.hits[i].triangle == STOKES_NONE);
        CHECK(seen.rays[i].ox == Approx(8.625).margin(0.01));
        CHECK(seen.rays[i].oy == Approx(5.0f - offset_mm).margin(1e-5));
        CHECK(seen.rays[i].dx == Approx(d.x).margin(1e-6));
        CHECK(seen.rays[i].dy == Approx(d.y).margin(1e-6));
        CHECK(seen.points[i].reflected == 1u);
    }
}

// What such a surface emits itself is the same in all directions, whatever part of the rays it mirrors.
TEST_CASE("a smooth surface that emits is seen with its radiance in the mean", "[trace_reflections]") {
    for (const double cosine : {1.0, 0.35}) {
        CAPTURE(cosine);
        Bench bench({{0.0f, 1.0f, glossy, 0}}, 2.42f);
        Sample light;
        for (const FilmValue& value : bench.see(rays_down(40000, cosine)).emission)
            light.add(static_cast<double>(value.x));
        CAPTURE(light.mean(), light.standard_error());
        CHECK(std::abs(light.z(3.0)) < 4.0);
        CHECK(light.standard_error() < 0.01);
    }
}
