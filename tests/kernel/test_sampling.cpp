#include <cmath>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/normals.hpp"
#include "tests/support/photon_fixture.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

struct alignas(16) Float4 {
    float x, y, z, w;
};
struct alignas(8) Float2 {
    float x, y;
};

glm::dvec3 vec(const Float4& v) { return {v.x, v.y, v.z}; }

Float4 unit(const glm::dvec3& v) {
    const glm::dvec3 n = glm::normalize(v);
    return {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z), 0.0f};
}

// The axes, both zeros of z, normals closer and closer to -z and to +z, and some at random.
std::vector<Float4> normals() {
    std::vector<Float4> result = {{1, 0, 0, 0}, {-1, 0, 0, 0}, {0, 1, 0, 0},     {0, -1, 0, 0},
                                  {0, 0, 1, 0}, {0, 0, -1, 0}, {1, 0, -0.0f, 0}, {0, -1, -0.0f, 0}};
    for (double tilt = 0.1; tilt > 1e-9; tilt *= 0.1)
        for (const double z : {-1.0, 1.0}) {
            result.push_back(unit({tilt, 0.3 * tilt, z}));
            result.push_back(unit({-0.2 * tilt, -tilt, z}));
        }
    std::mt19937 generator(1);
    while (result.size() < 200) result.push_back(unit(random_direction(generator)));
    return result;
}

}  // namespace

// Three roundings of 2^-24 in each product.
TEST_CASE("tangent frames are orthonormal and right-handed", "[sampling][tiny]") {
    const std::vector<Float4> n = normals();
    const Buffer<Float4> s(test_device(), "s", n.size()), t(test_device(), "t", n.size());
    test_program("sampling.cl")
        .kernel("frames")
        .launch(n.size(), Arguments()
                              .add("normals", on_device(n), "float4")
                              .add("s", s, "float4")
                              .add("t", t, "float4")
                              .add("n", std::uint32_t(n.size())));
    const std::vector<Float4> first = s.download(), second = t.download();
    for (std::size_t i = 0; i < n.size(); ++i) {
        CAPTURE(n[i].x, n[i].y, n[i].z);
        const glm::dvec3 a = vec(first[i]), b = vec(second[i]), c = vec(n[i]);
        CHECK(glm::dot(a, a) == Approx(1.0).margin(1e-6));
        CHECK(glm::dot(b, b) == Approx(1.0).margin(1e-6));
        CHECK(glm::dot(a, b) == Approx(0.0).margin(1e-6));
        CHECK(glm::dot(a, c) == Approx(0.0).margin(1e-6));
        CHECK(glm::dot(b, c) == Approx(0.0).margin(1e-6));
        CHECK(glm::length(glm::cross(a, b) - c) < 1e-6);
    }
}

// mu^2 and azimuth of a cosine-distributed direction are independent and uniform. Five chi-square tests in
// 1024 cells, together wrong once in 1000.
TEST_CASE("directions are cosine-distributed about their normal", "[sampling]") {
    constexpr std::uint32_t count = 1u << 17;
    const std::vector<Float4> about = {unit({0, 0, 1}), unit({0, 0, -1}), unit({1, 0, 0}), unit({1, -2, 0.5}),
                                       unit({1e-4, 1e-4, -1})};
    const Buffer<Float4> directions(test_device(), "directions", count);
    Kernel kernel = test_program("sampling.cl").kernel("cosine_directions");
    for (std::uint32_t k = 0; k < about.size(); ++k) {
        kernel.launch(count, Arguments()
                                 .add("normal", about[k], "float4")
                                 .add("seed", k)
                                 .add("directions", directions, "float4")
                                 .add("n", count));
        CosineHistogram histogram(32);
        for (const Float4& d : directions.download()) {
            REQUIRE(glm::length(vec(d)) == Approx(1.0).margin(1e-6));
            REQUIRE(glm::dot(vec(d), vec(about[k])) > 0.0);
            histogram.add(vec(about[k]), vec(d));
        }
        CHECK(chi_square_uniform(histogram.counts()) > sidak_level(1e-3, about.size()));
    }
}

// cos = sqrt(1 - u1): the normal itself at u1 = 0, and still above the surface at the largest u1.
TEST_CASE("the ends of the unit interval give directions above the surface", "[sampling][tiny]") {
    const float top = 1.0f - 0x1p-24f;
    const std::vector<Float2> u = {{0.0f, 0.0f}, {0.0f, top}, {top, 0.0f}, {top, top}, {0.5f, 0.25f}};
    const Buffer<Float4> directions(test_device(), "directions", u.size());
    const Float4 n = unit({0.3, 0.4, -0.8});
    test_program("sampling.cl")
        .kernel("directions_at")
        .launch(u.size(), Arguments()
                              .add("normal", n, "float4")
                              .add("u", on_device(u), "float2")
                              .add("directions", directions, "float4")
                              .add("n", std::uint32_t(u.size())));
    const std::vector<Float4> d = directions.download();
    for (std::size_t i = 0; i < u.size(); ++i) {
        const double expected = std::sqrt(1.0 - static_cast<double>(u[i].x));
        CHECK(glm::dot(vec(d[i]), vec(n)) == Approx(expected).margin(1e-6));
        CHECK(glm::dot(vec(d[i]), vec(n)) > 1e-4);
    }
}

// The triangle cut into 16 x 16 congruent ones. One chi-square test, wrong once in 1000.
TEST_CASE("points are uniform over a triangle", "[sampling]") {
    constexpr std::uint32_t count = 1u << 16;
    constexpr int steps = 16;
    const Buffer<Float2> points(test_device(), "points", count);
    test_program("sampling.cl")
        .kernel("triangle_points")
        .launch(count, Arguments().add("seed", 3u).add("uv", points, "float2").add("n", count));
    std::vector<double> counts(steps * steps, 0.0);
    for (const Float2& p : points.download()) {
        REQUIRE(p.x >= 0.0f);
        REQUIRE(p.y >= 0.0f);
        REQUIRE(p.x + p.y <= 1.0f + 1e-6f);
        const double x = p.x * steps, y = p.y * steps;
        const int i = std::min(int(x), steps - 1), j = std::min(int(y), steps - 1 - i);
        const bool upper = (x - i) + (y - j) > 1.0 && i + j < steps - 1;
        // Row i holds 2 (steps - i) - 1 triangles.
        counts[std::size_t(i * (2 * steps - i) + 2 * j + (upper ? 1 : 0))] += 1.0;
    }
    CHECK(chi_square_uniform(counts) > 1e-3);
}

TEST_CASE("sixteen values are added up", "[sampling][tiny]") {
    std::vector<Flux16> values(40);
    std::mt19937 generator(2);
    for (Flux16& v : values) v = random_flux(generator, 0.0, 100.0);
    for (int k = 0; k < 16; ++k) {  // each lane alone
        values[std::size_t(k)] = constant_flux(0.0f);
        values[std::size_t(k)].v[k] = static_cast<float>(k + 1);
    }
    const Buffer<float> out(test_device(), "sums", values.size());
    test_program("sampling.cl")
        .kernel("sums")
        .launch(values.size(),
                Arguments().add("values", on_device(values)).add("out", out).add("n", std::uint32_t(values.size())));
    const std::vector<float> sums = out.download();
    for (std::size_t i = 0; i < values.size(); ++i)
        CHECK(static_cast<double>(sums[i]) == Approx(sum_of(values[i])).epsilon(5e-7));
}

// Against the sine and cosine of the same turn in double precision; the series is good to 3e-8 and the rounding of the
// angle to 2^-24 of a quarter turn.
TEST_CASE("points of the unit circle are sine and cosine", "[sampling][tiny]") {
    std::vector<float> turns;
    for (int i = 0; i <= 256; ++i) turns.push_back(static_cast<float>(i) / 256.0f);
    turns.push_back(0.12500001f);
    turns.push_back(0.99999994f);
    const Buffer<Float2> points(test_device(), "points", turns.size());
    test_program("sampling.cl")
        .kernel("circle_points")
        .launch(turns.size(), Arguments()
                                  .add("turns", on_device(turns))
                                  .add("points", points, "float2")
                                  .add("n", std::uint32_t(turns.size())));
    const std::vector<Float2> found = points.download();
    for (std::size_t i = 0; i < turns.size(); ++i) {
        const double angle = 2.0 * M_PI * double(turns[i]);
        CAPTURE(turns[i]);
        CHECK(double(found[i].x) == Approx(std::cos(angle)).margin(2e-7));
        CHECK(double(found[i].y) == Approx(std::sin(angle)).margin(2e-7));
    }
}
