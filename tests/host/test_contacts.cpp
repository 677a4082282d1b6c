// Which bodies touch, cross or lie in one place.
#include <random>

#include "host/scene/mesh/contacts.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "host/scene/mesh/triangle_pairs.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;

namespace {

constexpr double near_mm = 1e-3;

Scene scene_of(const std::vector<std::pair<int, Mesh>>& shapes) {
    Scene scene = empty_scene("contacts");
    scene.media = {{"m", Spectrum::constant(1.0), Spectrum::constant(0.1), 1.0, 1.0}};
    scene.materials = {{"translucent", TranslucentMaterial{0, {}, false}}, diffuse_material(0.5)};
    for (const auto& [material, mesh] : shapes) add_shape(scene, "shape", material, mesh);
    return scene;
}

Mesh block(const glm::dvec3& size, const glm::dvec3& centre) { return moved(make_box(size), centre); }

BodyTriangle triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, int body = 0) {
    BodyTriangle t;
    t.corners = {a, b, c};
    for (const glm::dvec3& p : t.corners) t.box.add(p);
    t.normal = glm::normalize(glm::cross(b - a, c - a));
    t.body = body;
    return t;
}

}  // namespace

TEST_CASE("A block on a floor touches it, and one above does not") {
    for (const double gap : {0.0, 1e-4, -1e-4, 0.01}) {
        CAPTURE(gap);
        const Scene scene =
            scene_of({{1, make_rectangle(50.0, 50.0)}, {0, block({10.0, 4.0, 10.0}, {3.0, 2.0 + gap, 0.0})}});
        const Contacts contacts = find_contacts(scene, near_mm);
        const bool touch = gap < 2.0 * near_mm;
        CHECK(contacts.any_touch == touch);
        CHECK(contacts.any_contested == touch);
        CHECK(contacts.touches == std::vector<bool>{touch, touch});
        CHECK(contacts.cross.empty());
        CHECK(contacts.coincide.empty());
        if (touch) CHECK(contacts.solid == std::vector<bool>{false, true});
        CHECK(contacts.holds == std::vector<bool>{false, false});
    }
}

// Of a box's twelve triangles two lie in the floor, and both of the floor's.
TEST_CASE("Contested are the triangles that share a plane and overlap there") {
    const Scene scene = scene_of({{1, make_rectangle(50.0, 50.0)}, {0, block({10.0, 4.0, 10.0}, {3.0, 2.0, 0.0})}});
    const Contacts contacts = find_contacts(scene, near_mm);
    CHECK(std::count(contacts.contested.begin(), contacts.contested.end(), true) == 4);
    // Side by side in one plane they do not overlap.
    const Scene tiles =
        scene_of({{1, make_rectangle(10.0, 10.0)}, {1, moved(make_rectangle(10.0, 10.0), {10.0, 0.0, 0.0})}});
    CHECK_FALSE(find_contacts(tiles, near_mm).any_contested);
    CHECK(find_contacts(tiles, near_mm).any_touch);
}

TEST_CASE("Bodies that cross and surfaces that coincide are found") {
    const Scene sunk = scene_of({{0, block({10.0, 4.0, 10.0}, {0.0, 1.0, 0.0})}, {1, make_rectangle(50.0, 50.0)}});
    const Contacts of_sunk = find_contacts(sunk, near_mm);
    CHECK(of_sunk.cross == std::vector<Contacts::Pair>{{0, 1}});
    CHECK(of_sunk.holds == std::vector<bool>{true, false});
    CHECK(of_sunk.coincide.empty());
    // Sunk to where it has edges: a ball to its equator.
    const Scene equator = scene_of({{0, make_sphere(10.0)}, {1, make_rectangle(50.0, 50.0)}});
    CHECK(find_contacts(equator, near_mm).cross == std::vector<Contacts::Pair>{{0, 1}});
    // One in the corner of another: three faces in one place, facing one way.
    const Scene corner =
        scene_of({{0, block({10.0, 10.0, 10.0}, {5.0, 5.0, 5.0})}, {0, block({4.0, 4.0, 4.0}, {2.0, 2.0, 2.0})}});
    CHECK(find_contacts(corner, near_mm).coincide == std::vector<Contacts::Pair>{{0, 1}});
    // Glued together they face each other.
    const Scene glued =
        scene_of({{0, block({4.0, 4.0, 4.0}, {2.0, 2.0, 2.0})}, {0, block({4.0, 4.0, 4.0}, {6.0, 2.0, 2.0})}});
    CHECK(find_contacts(glued, near_mm).coincide.empty());
    CHECK(find_contacts(glued, near_mm).cross.empty());
    CHECK(find_contacts(glued, near_mm).any_contested);
}

TEST_CASE("A body within another is found, and the smallest that holds it") {
    const Scene scene = scene_of({{0, make_sphere(20.0)},
                                  {0, make_sphere(10.0)},
                                  {1, make_sphere(3.0)},
                                  {1, moved(make_sphere(3.0), {20.0, 0.0, 0.0})},
                                  {1, moved(make_sphere(3.0), {40.0, 0.0, 0.0})}});
    CHECK(container_of_body(scene, 0).whole == std::nullopt);
    CHECK(container_of_body(scene, 1).whole == 0);
    CHECK(container_of_body(scene, 2).whole == 1);
    CHECK(container_of_body(scene, 3).whole == std::nullopt);
    CHECK(container_of_body(scene, 3).part == 0);
    CHECK(container_of_body(scene, 4).part == std::nullopt);
    CHECK(within_body(scene, 0, {{0.0, 0.0, 19.0}}) == Within::wholly);
    CHECK(within_body(scene, 0, {{0.0, 0.0, 21.0}}) == Within::no);
}

// Against all pairs, one by one.
TEST_CASE("Near pairs are found once each") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-10.0, 10.0);
    std::vector<BodyTriangle> triangles;
    for (std::uint32_t i = 0; i < 400; ++i) {
        const glm::dvec3 at(uniform(random), uniform(random), uniform(random));
        const auto corner = [&] { return at + 0.1 * glm::dvec3(uniform(random), uniform(random), uniform(random)); };
        triangles.push_back(triangle(corner(), corner(), corner(), static_cast<int>(i % 3)));
        triangles.back().index = i;
    }
    std::size_t expected = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (triangles[i].body != triangles[j].body && triangles[i].box.meets(triangles[j].box, 0.2)) ++expected;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> seen;
    visit_near_pairs(triangles, 0.2, [&](const BodyTriangle& a, const BodyTriangle& b) {
        CHECK(a.body != b.body);
        seen.emplace_back(std::min(a.index, b.index), std::max(a.index, b.index));
    });
    CHECK(seen.size() == expected);
    CHECK(expected > 100);
    std::sort(seen.begin(), seen.end());
    CHECK(std::adjacent_find(seen.begin(), seen.end()) == seen.end());
}

TEST_CASE("Triangles that cross pass through one another deeper than the distance") {
    const BodyTriangle flat = triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
    CHECK(cross_each_other(flat, triangle({1, 1, -1}, {1, 1, 1}, {2, 1, 1}), near_mm));
    CHECK_FALSE(cross_each_other(flat, triangle({3, 3, -1}, {3, 3, 1}, {4, 3, 1}), near_mm));  // beside it
    CHECK_FALSE(cross_each_other(flat, triangle({1, 1, 0}, {1, 1, 1}, {2, 1, 1}), near_mm));   // stands on it
    CHECK_FALSE(cross_each_other(flat, triangle({1, 1, -5e-4}, {1, 1, 1}, {2, 1, 1}), near_mm));
    CHECK(share_a_plane(flat, triangle({1, 1, 5e-4}, {1, 2, 5e-4}, {2, 1, 5e-4}), near_mm));
    CHECK_FALSE(share_a_plane(flat, triangle({1, 1, 5e-3}, {1, 2, 5e-3}, {2, 1, 5e-3}), near_mm));
    CHECK_FALSE(share_a_plane(flat, triangle({4, 4, 0}, {4, 5, 0}, {5, 4, 0}), near_mm));
}
