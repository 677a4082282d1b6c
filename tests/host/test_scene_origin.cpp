// Where the coordinates of a scene start.
#include <cmath>

#include "host/scene/mesh/scene_origin.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;

namespace {

Bounds cube(const glm::dvec3& middle, double size) { return {middle - 0.5 * size, middle + 0.5 * size}; }

struct View {
    Camera camera;
    std::vector<Bounds> shapes;
    glm::dvec3 origin() const { return scene_origin_mm(camera, shapes); }
};

// A ball of 36 mm on a floor of 300 mm, about the origin.
View table() {
    View view;
    view.camera.position_mm = {0, 60, 140};
    view.camera.target_mm = {0, 18, 0};
    view.shapes = {{{-150, 0, -150}, {150, 0, 150}}, cube({0, 18, 0}, 36)};
    return view;
}

View moved(View view, const glm::dvec3& by) {
    view.camera.position_mm += by;
    view.camera.target_mm += by;
    for (Bounds& b : view.shapes) b = {b.low_mm + by, b.high_mm + by};
    return view;
}

double farthest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace

TEST_CASE("A scene about the origin stays where it is") {
    CHECK(table().origin() == glm::dvec3(0.0));
    CHECK(moved(table(), {100, -200, 50}).origin() == glm::dvec3(0.0));
    CHECK(View().origin() == glm::dvec3(0.0));
}

TEST_CASE("A scene that is moved by a large power of two is moved back by it, at any scale") {
    for (const double scale : {1.0 / 1024, 1.0, 1024.0})
        for (const glm::dvec3& by : {glm::dvec3(1048576, 0, -2097152), glm::dvec3(1073741824, 1073741824, 0)}) {
            View view = table();
            view.camera.position_mm *= scale;
            view.camera.target_mm *= scale;
            for (Bounds& b : view.shapes) b = {b.low_mm * scale, b.high_mm * scale};
            CHECK(moved(view, by * scale).origin() == by * scale);
        }
}

TEST_CASE("A scene that is moved by anything gets an origin within some times its size") {
    for (const double by : {1e4, 1e6, 123456789.0, 1e9, 1e11}) {
        const View view = moved(table(), {by, -by, 0.3 * by});
        CHECK(farthest(view.camera.target_mm - view.origin()) < 16 * 300.0);
    }
}

// Each would pull a plain mean of all places, or the middle of the bounds, away from the ball.
TEST_CASE("A huge floor, a lamp far away and a stray dot do not move the origin away from what is seen") {
    const glm::dvec3 at(1e6, 0, 1e6);
    const View view = moved(table(), at);
    for (const Bounds& other :
         {Bounds{{-1e7, -1, -1e7}, {1e7, -1, 1e7}}, cube({-4e6, 4e6, 0}, 20.0), cube({0, 0, 0}, 0.01)}) {
        View with = view;
        for (int i = 0; i < 3; ++i) with.shapes.push_back(other);
        CHECK(farthest(with.origin() - at) < 16 * 300.0);
        View about_origin = table();
        for (int i = 0; i < 3; ++i) about_origin.shapes.push_back(other);
        if (other.high_mm.x < 1.0 || other.high_mm.x > 1e6) CHECK(about_origin.origin() == glm::dvec3(0.0));
    }
}

TEST_CASE("A room of six large walls does not move the origin away from a small thing before the camera") {
    View view = moved(table(), {1e6, 1e6, 0});
    for (int wall = 0; wall < 6; ++wall) view.shapes.push_back({{-5e6, -5e6, -5e6}, {5e6, 5e6, 5e6}});
    CHECK(farthest(view.camera.target_mm - view.origin()) < 16 * 300.0);
}

TEST_CASE("A camera that looks on a small thing from far away leaves the origin at the thing") {
    View view;
    view.camera.position_mm = {0, 0, 1e6};
    view.camera.target_mm = {0, 0, 1e6 - 1};
    view.camera.vertical_fov_deg = 0.01;  // 175 mm at that distance
    view.shapes = {cube({0, 0, 0}, 100)};
    CHECK(farthest(view.origin()) < 16 * 100.0);
}
