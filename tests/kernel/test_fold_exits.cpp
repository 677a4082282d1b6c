#include <cmath>
#include <random>
#include <vector>

#include "host/scene/mesh/shapes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/photon_fixture.hpp"
#include "tests/support/traced_scene.hpp"

using namespace stokes;

namespace {

constexpr float offset_mm = 1e-4f;

// Points of the tangent plane at the entries, all of them missed by their probes.
struct Missed {
    std::vector<ExitPoint> exits;
    std::vector<Probe> probes;

    void add(const glm::vec3& entry, const glm::vec3& normal, const glm::vec3& at, std::uint32_t body) {
        ExitPoint exit_point{};
        exit_point.x = entry.x, exit_point.y = entry.y, exit_point.z = entry.z;
        exit_point.r_mm = glm::length(at - entry);
        exits.push_back(exit_point);
        probes.push_back({at.x, at.y, at.z, 1.0f, normal.x, normal.y, normal.z, body});
    }
};

std::vector<ExitPoint> fold(const Traced& scene, const Missed& missed) {
    const auto n = static_cast<cl_uint>(missed.exits.size());
    const Buffer<ExitPoint> exits = on_device(missed.exits);
    Program(test_device(), "fold_exits.cl")
        .kernel("fold_exits")
        .launch(n, Arguments()
                       .add("count", n)
                       .add("pass", pass_on_device(1, 0, offset_mm))
                       .add(scene.arguments())
                       .add("triangles", scene.triangle_buffer)
                       .add("probes", on_device(missed.probes))
                       .add("exits", exits));
    return exits.download();
}

glm::dvec3 position_of(const ExitPoint& e) { return {e.x, e.y, e.z}; }

// 20 x 4 x 20 mm, its top at y = 4.
constexpr float half_mm = 10.0f, height_mm = 4.0f;

}  // namespace

// The way from the entry over the edges to the exit is as long as it was in the plane. The ray that looks for the edge
// runs a hundredth of its way and 16 offsets below the plane, and finds the next face where it is not lower than that.
TEST_CASE("an exit beyond an edge is folded down onto the face behind it", "[fold_exits][tiny]") {
    Mesh box = make_box({2.0 * half_mm, height_mm, 2.0 * half_mm});
    for (glm::vec3& p : box.positions_mm) p.y += 0.5f * height_mm;
    const Traced scene(triangles_of(box, 3));
    Missed missed;
    const glm::vec3 up(0, 1, 0), entry(8.0f, height_mm, 1.0f);
    const std::vector<float> beyond = {0.01f, 0.5f, 1.5f, 3.5f, 5.0f, 9.0f};
    for (const float x : beyond) missed.add(entry, up, {half_mm + x, height_mm, 1.0f}, 3);
    for (const float x : beyond) missed.add(entry, up, {half_mm + x, height_mm, 1.0f}, 4);  // of another body
    const std::vector<ExitPoint> folded = fold(scene, missed);
    for (std::size_t i = 0; i < beyond.size(); ++i) {
        const double x = double(beyond[i]);
        const glm::dvec3 at = position_of(folded[i]), normal(folded[i].nx, folded[i].ny, folded[i].nz);
        CAPTURE(x, at.x, at.y, at.z);
        CHECK((folded[i].found == 1 && folded[i].r_mm == missed.exits[i].r_mm));
        CHECK(at.z == Approx(1.0).margin(1e-5));
        if (x < double(height_mm)) {
            CHECK(at.x == Approx(double(half_mm)).margin(1e-5));
            CHECK(at.y == Approx(double(height_mm) - x).margin(0.03));
            CHECK(normal.x == Approx(1.0));
        } else {  // round the lower edge onto the bottom
            CHECK(at.y == Approx(0.0).margin(1e-5));
            CHECK(at.x == Approx(double(half_mm) - (x - double(height_mm))).margin(0.12));
            CHECK(normal.y == Approx(-1.0));
        }
        const ExitPoint& other = folded[beyond.size() + i];
        CHECK(other.found == 0);
        CHECK(glm::length(position_of(other) - glm::dvec3(entry)) == 0.0);
    }
}

TEST_CASE("exits beyond the corners of a prism find its surface", "[fold_exits]") {
    const Mesh prism = make_prism(6, 20.0, 15.0);
    const Traced scene(triangles_of(prism, 0));
    float top = 0.0f;
    for (const glm::vec3& p : prism.positions_mm) top = std::max(top, p.y);
    std::mt19937 generator(4);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    Missed missed;
    while (missed.exits.size() < 20000) {
        const float turn = 6.2831853f * uniform(generator), radius = 17.0f * std::sqrt(uniform(generator));
        const glm::vec3 entry(radius * std::cos(turn), top, radius * std::sin(turn));
        const float to = 6.2831853f * uniform(generator), r = 12.0f * uniform(generator);
        const glm::vec3 at = entry + r * glm::vec3(std::cos(to), 0.0f, std::sin(to));
        if (glm::length(glm::vec2(at.x, at.z)) > 20.01f) missed.add(entry, {0, 1, 0}, at, 0);
    }
    std::size_t lost = 0;
    for (const ExitPoint& e : fold(scene, missed)) {
        if (e.found == 0) {
            ++lost;
            continue;
        }
        const glm::dvec3 at = position_of(e);
        CHECK(at.y > -1e-5);
        CHECK(at.y < double(top) + 1e-5);
        CHECK(glm::length(glm::dvec2(at.x, at.z)) < 20.0 + 1e-4);
    }
    CHECK(lost <= 20);  // a thousandth
}

TEST_CASE("exits beyond the rim of a sheet stay missed, and found ones stay where they are", "[fold_exits][tiny]") {
    const Traced scene(triangles_of(make_rectangle(20.0, 20.0), 0));
    Missed missed;
    missed.add({8, 0, 0}, {0, 1, 0}, {12, 0, 0}, 0);
    missed.add({8, 0, 0}, {0, 1, 0}, {9, 0, 0}, 0);
    missed.exits[1].found = 1;
    const std::vector<ExitPoint> folded = fold(scene, missed);
    CHECK(folded[0].found == 0);
    CHECK(folded[1].found == 1);
    CHECK(folded[1].x == 8.0f);
}
