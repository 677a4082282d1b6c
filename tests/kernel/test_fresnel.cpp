#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"

using namespace stokes;

namespace {

struct alignas(8) Pair {
    float x, y;
};
struct alignas(16) Four {
    float x, y, z, w;
};

struct Reflectances {
    double outside, within;
};

// At each cosine of incidence, with the index of the same number.
std::vector<Reflectances> found_at(const std::vector<float>& cosines, const std::vector<float>& eta) {
    std::vector<Pair> given;
    for (std::size_t i = 0; i < cosines.size(); ++i) given.push_back({cosines[i], eta[i]});
    const Buffer<Pair> in(test_device(), "cosines", given), out(test_device(), "reflectances", given.size());
    const auto n = static_cast<cl_uint>(given.size());
    test_program("fresnel.cl")
        .kernel("reflectances")
        .launch(n, Arguments().add("cosines", in, "float2").add("found", out, "float2").add("n", n));
    std::vector<Reflectances> result;
    for (const Pair& p : out.download()) result.push_back({static_cast<double>(p.x), static_cast<double>(p.y)});
    return result;
}

// Amplitudes of light that comes from a medium of index a at cosine ca and goes on in one of index b at cosine cb.
struct Amplitudes {
    double reflected_s, reflected_p, passed_s, passed_p;
};
Amplitudes amplitudes(double a, double ca, double b, double cb) {
    return {(a * ca - b * cb) / (a * ca + b * cb), (b * ca - a * cb) / (b * ca + a * cb),
            2.0 * a * ca / (a * ca + b * cb), 2.0 * a * ca / (b * ca + a * cb)};
}

double cosine_beyond(double a, double ca, double b) {
    const double square = 1.0 - (a / b) * (a / b) * (1.0 - ca * ca);
    return square > 0.0 ? std::sqrt(square) : 0.0;
}

double reflectance(double a, double ca, double b) {
    const double cb = cosine_beyond(a, ca, b);
    if (cb == 0.0 && a > b) return 1.0;
    const Amplitudes f = amplitudes(a, ca, b, cb);
    return 0.5 * (f.reflected_s * f.reflected_s + f.reflected_p * f.reflected_p);
}

double transmittance(double a, double ca, double b) {
    const double cb = cosine_beyond(a, ca, b);
    if (cb == 0.0 && a > b) return 0.0;
    const Amplitudes f = amplitudes(a, ca, b, cb);
    return 0.5 * (f.passed_s * f.passed_s + f.passed_p * f.passed_p) * b * cb / (a * ca);
}

// What single precision makes of a cosine whose square is 1 less a number near 1.
double rounding_of_cosine(double cosine, double eta) {
    const double square = 2e-7 * eta * eta;
    return std::min(square / std::max(cosine, 1e-30), std::sqrt(square));
}

void check_grid(const std::vector<float>& indices, int steps) {
    std::vector<float> cosines, eta;
    for (const float index : indices)
        for (int i = 0; i <= steps; ++i) {
            cosines.push_back(static_cast<float>(i) / static_cast<float>(steps));
            eta.push_back(index);
        }
    const std::vector<Reflectances> found = found_at(cosines, eta);
    for (std::size_t i = 0; i < cosines.size(); ++i) {
        const double mu = static_cast<double>(cosines[i]), index = static_cast<double>(eta[i]);
        CAPTURE(mu, index);
        REQUIRE(std::abs(found[i].outside - reflectance(1.0, mu, index)) < 2e-6);
        REQUIRE(std::abs(1.0 - found[i].outside - (mu > 0.0 ? transmittance(1.0, mu, index) : 0.0)) < 2e-6);
        // At grazing exit the slope of R in the cosine outside is -2 (eta^2 + 1) / sqrt(eta^2 - 1), elsewhere smaller.
        const double slope = 2.0 * (index * index + 1.0) / std::sqrt(index * index - 1.0);
        const double within = rounding_of_cosine(cosine_beyond(index, mu, 1.0), index);
        REQUIRE(std::abs(found[i].within - reflectance(index, mu, 1.0)) < 2e-6 + slope * within);
    }
}

glm::dvec3 random_unit(std::mt19937& generator) {
    std::normal_distribution<double> normal;
    const double x = normal(generator), y = normal(generator), z = normal(generator);
    return glm::normalize(glm::dvec3(x, y, z));
}

void check_directions(int count) {
    std::mt19937 generator(5);
    const float indices[] = {1.0f, 1.33f, 1.5f, 2.42f, 5.0f};
    std::vector<Four> directions, normals;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 n(random_unit(generator));
        glm::vec3 d(random_unit(generator));
        if (glm::dot(d, n) > 0.0f) d = -d;
        if (i % 7 == 0) d = -n;                                                // head on
        if (i % 7 == 1) d = glm::normalize(d - (glm::dot(d, n) + 1e-4f) * n);  // grazing
        directions.push_back({d.x, d.y, d.z, indices[i % 5]});
        normals.push_back({n.x, n.y, n.z, 0.0f});
    }
    const Buffer<Four> in(test_device(), "directions", directions), up(test_device(), "normals", normals);
    const Buffer<Four> refracted(test_device(), "refracted", directions.size());
    const Buffer<Four> mirrored(test_device(), "mirrored", directions.size());
    const auto n = static_cast<cl_uint>(count);
    test_program("fresnel.cl")
        .kernel("turned")
        .launch(n, Arguments()
                       .add("directions", in, "float4")
                       .add("normals", up, "float4")
                       .add("refracted", refracted, "float4")
                       .add("mirrored", mirrored, "float4")
                       .add("n", n));
    const auto vector = [](const Four& f) { return glm::dvec3(f.x, f.y, f.z); };
    const std::vector<Four> into = refracted.download(), back = mirrored.download();
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const glm::dvec3 d = vector(directions[i]), normal = vector(normals[i]);
        const glm::dvec3 t = vector(into[i]), r = vector(back[i]);
        const double eta = static_cast<double>(directions[i].w);
        CAPTURE(i, eta, glm::dot(d, normal));
        REQUIRE(glm::length(t) == Approx(1.0).margin(1e-6));
        REQUIRE(glm::dot(t, normal) < 0.0);
        // Snell's law for the sine and the plane of incidence at once.
        const glm::dvec3 along = d - glm::dot(d, normal) * normal, deep = t - glm::dot(t, normal) * normal;
        REQUIRE(glm::length(deep - along / eta) < 1e-6);
        REQUIRE(-glm::dot(t, normal) == Approx(cosine_beyond(1.0, -glm::dot(d, normal), eta)).margin(1e-6));

        REQUIRE(glm::dot(r, normal) == Approx(-glm::dot(d, normal)).margin(1e-6));
        REQUIRE(glm::length(r - glm::dot(r, normal) * normal - along) < 1e-6);
        REQUIRE(glm::length(r) == Approx(1.0).margin(1e-6));
    }
}

}  // namespace

TEST_CASE("reflectance and transmittance agree with double precision and add up to one", "[fresnel]") {
    check_grid({1.01f, 1.1f, 1.33f, 1.5f, 2.42f, 5.0f}, 2000);
}

TEST_CASE("reflectance at a few angles agrees with double precision", "[fresnel][tiny]") {
    check_grid({1.33f, 1.5f}, 20);
}

TEST_CASE("reflectance head on, at Brewster's angle, at grazing incidence and beyond the critical angle",
          "[fresnel][tiny]") {
    for (const float eta : {1.1f, 1.33f, 1.5f, 2.42f, 5.0f}) {
        CAPTURE(eta);
        const double n = static_cast<double>(eta);
        const float brewster = 1.0f / std::sqrt(1.0f + eta * eta), brewster_within = eta * brewster;
        const float critical = std::sqrt(1.0f - 1.0f / (eta * eta));
        const std::vector<Reflectances> found =
            found_at({1.0f, brewster, brewster_within, 0.0f, 0.999f * critical}, std::vector<float>(5, eta));
        CHECK(found[0].outside == Approx(std::pow((n - 1.0) / (n + 1.0), 2)).epsilon(1e-5));
        CHECK(found[0].within == Approx(std::pow((n - 1.0) / (n + 1.0), 2)).epsilon(1e-5));
        // No p light comes back; of s light the square of (n^2 - 1) / (n^2 + 1).
        const double half_s = 0.5 * std::pow((n * n - 1.0) / (n * n + 1.0), 2);
        CHECK(found[1].outside == Approx(half_s).epsilon(1e-4));
        CHECK(found[2].within == Approx(half_s).epsilon(1e-4));
        CHECK(found[3].outside == Approx(1.0).margin(1e-6));
        CHECK(found[3].within == 1.0);
        CHECK(found[4].within == 1.0);
    }
}

TEST_CASE("a surface of index one does not reflect", "[fresnel][tiny]") {
    const std::vector<float> cosines = {0.0f, 1e-6f, 0.01f, 0.3f, 0.7f, 1.0f};
    const std::vector<Reflectances> found = found_at(cosines, std::vector<float>(cosines.size(), 1.0f));
    for (std::size_t i = 0; i < found.size(); ++i) {
        CHECK(found[i].outside == 0.0);
        if (cosines[i] >= 0.01f) CHECK(found[i].within < 1e-6);
    }
}

// Light takes a path in both directions alike: R outside at one end is R within at the other.
TEST_CASE("reflectance is reciprocal", "[fresnel]") {
    std::mt19937 generator(8);
    std::uniform_real_distribution<double> cosine(0.05, 1.0), index(1.05, 4.0);
    std::vector<float> outside, within, eta;
    for (int i = 0; i < 2000; ++i) {
        outside.push_back(static_cast<float>(cosine(generator)));
        eta.push_back(static_cast<float>(index(generator)));
        within.push_back(static_cast<float>(
            cosine_beyond(1.0, static_cast<double>(outside.back()), static_cast<double>(eta.back()))));
    }
    const std::vector<Reflectances> above = found_at(outside, eta), below = found_at(within, eta);
    // Below, the cosine outside comes of a difference: of 2e-7 eta^2 in its square, here at most 6e-5 in itself.
    for (std::size_t i = 0; i < eta.size(); ++i) REQUIRE(above[i].outside == Approx(below[i].within).margin(4e-4));
}

TEST_CASE("refracted and mirrored directions obey Snell's law and stay in the plane of incidence", "[fresnel]") {
    check_directions(5000);
}

TEST_CASE("a few refracted and mirrored directions", "[fresnel][tiny]") { check_directions(35); }
