// Polygons cut into triangles: expected areas are those of the shoelace formula (Meister 1769), or known by
// construction.
#include <algorithm>
#include <cmath>
#include <random>

#include "host/scene/mesh/polygon.hpp"
#include "tests/support/catch.hpp"

using namespace stokes;

namespace {

using Corners = std::vector<glm::dvec3>;

Corners flat(const std::vector<glm::dvec2>& outline) {
    Corners corners;
    for (const glm::dvec2& p : outline) corners.emplace_back(p.x, p.y, 0.0);
    return corners;
}

double signed_area(const Corners& c, const glm::uvec3& t) {
    return 0.5 * glm::cross(c[t.y] - c[t.x], c[t.z] - c[t.x]).z;
}

double shoelace(const Corners& c) {
    double sum = 0.0;
    for (std::size_t i = 0; i < c.size(); ++i) {
        const glm::dvec3 &a = c[i], &b = c[(i + 1) % c.size()];
        sum += 0.5 * (a.x * b.y - b.x * a.y);
    }
    return sum;
}

// Of a polygon in z = 0, counter-clockwise: the triangles face +z, and cover it once. Returns how many have no area.
int check_cover(const Corners& corners, double rounding = 0.0) {
    std::vector<glm::uvec3> triangles;
    REQUIRE(cut_polygon(corners, triangles) == PolygonCut::exact);
    REQUIRE(triangles.size() == corners.size() - 2);
    double sum = 0.0;
    int empty = 0;
    for (const glm::uvec3& t : triangles) {
        const double area = signed_area(corners, t);
        CHECK(area >= 0.0);
        sum += area;
        if (area == 0.0) ++empty;
    }
    CHECK(std::abs(sum - shoelace(corners)) <= rounding * sum);
    return empty;
}

// A point at this angle and distance of the unit circle, for polygons that are seen from (0, 0) as a whole.
glm::dvec2 around(double turn, double distance) {
    return {distance * std::cos(2.0 * M_PI * turn), distance * std::sin(2.0 * M_PI * turn)};
}

}  // namespace

TEST_CASE("A convex polygon is the fan from its first corner") {
    std::vector<glm::uvec3> triangles;
    REQUIRE(cut_polygon(flat({{0, 0}, {2, 0}, {3, 1}, {2, 2}, {0, 2}}), triangles) == PolygonCut::exact);
    CHECK(triangles == std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
}

// Every U is looked at from each of its corners on, in each of the planes of two axes, from both sides. Its area is 32.
TEST_CASE("A concave polygon is covered exactly, wherever it starts and lies") {
    const std::vector<glm::dvec2> u = {{0, 0}, {8, 0}, {8, 6}, {6, 6}, {6, 2}, {2, 2}, {2, 6}, {0, 6}};
    std::vector<glm::uvec3> triangles;
    for (std::size_t first = 0; first < u.size(); ++first)
        for (int axis = 0; axis < 3; ++axis)
            for (const bool turned : {false, true}) {
                Corners corners;
                for (std::size_t i = 0; i < u.size(); ++i) {
                    glm::dvec3 p(0.0);
                    const glm::dvec2 at = u[(first + (turned ? u.size() - i : i)) % u.size()];
                    p[(axis + 1) % 3] = at.x, p[(axis + 2) % 3] = at.y, p[axis] = 5.0;
                    corners.push_back(p);
                }
                REQUIRE(cut_polygon(corners, triangles) == PolygonCut::exact);
                double area = 0.0;
                for (const glm::uvec3& t : triangles) {
                    const double part =
                        0.5 * glm::cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x])[axis];
                    CHECK((turned ? -part : part) > 0.0);
                    area += part;
                }
                CHECK(area == (turned ? -32.0 : 32.0));
            }
}

TEST_CASE("A concave quadrilateral is cut along its inner diagonal") {
    for (int first = 0; first < 4; ++first) {
        std::vector<glm::dvec2> dart = {{0, 0}, {4, 0}, {1, 1}, {0, 4}};
        std::rotate(dart.begin(), dart.begin() + first, dart.end());
        CHECK(check_cover(flat(dart)) == 0);
    }
}

TEST_CASE("Random polygons are covered, few corners and many") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform;
    for (const int corners : {5, 12, 60, 3000})
        for (int repeat = 0; repeat < (corners < 1000 ? 200 : 2); ++repeat) {
            std::vector<glm::dvec2> star;
            for (int k = 0; k < corners; ++k)
                star.push_back(around((k + 0.9 * uniform(random)) / corners, 0.05 + uniform(random)));
            check_cover(flat(star), 1e-12);
        }
}

// A comb is not seen as a whole from any of its places: a base of 1 x 1999, and 1000 teeth of 9 x 1.
TEST_CASE("A comb of a thousand teeth is covered") {
    std::vector<glm::dvec2> comb = {{0, 0}, {1999, 0}};
    for (int tooth = 999; tooth >= 0; --tooth)
        for (const auto& [x, y] : {std::pair(1, 1), std::pair(1, 10), std::pair(0, 10), std::pair(0, 1)})
            comb.emplace_back(2 * tooth + x, y);
    CHECK(shoelace(flat(comb)) == 1999 + 9000);
    check_cover(flat(comb));
}

// Outline, bridge, hole, and back: 100 - 4 of area.
TEST_CASE("A hole that is joined to the outline by a bridge stays empty") {
    const Corners corners = flat({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}, {4, 4}, {4, 6}, {6, 6}, {6, 4}, {4, 4}});
    CHECK(shoelace(corners) == 96.0);
    check_cover(corners);
    std::vector<glm::uvec3> triangles;
    cut_polygon(corners, triangles);
    for (const glm::uvec3& t : triangles) {
        const glm::dvec3 middle = (corners[t.x] + corners[t.y] + corners[t.z]) / 3.0;
        if (signed_area(corners, t) == 0.0) continue;
        CHECK_FALSE((middle.x > 4.0 && middle.x < 6.0 && middle.y > 4.0 && middle.y < 6.0));
    }
}

TEST_CASE("Two holes on one bridge, and a hole that touches the outline in a corner") {
    check_cover(flat({{0, 0},
                      {20, 0},
                      {20, 10},
                      {0, 10},
                      {0, 0},
                      {4, 4},
                      {4, 6},
                      {6, 6},
                      {12, 6},
                      {14, 6},
                      {14, 4},
                      {12, 4},
                      {12, 6},
                      {6, 6},
                      {6, 4},
                      {4, 4}}));
    check_cover(flat({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}, {2, 6}, {6, 6}, {6, 2}}));
}

TEST_CASE("Corners on a straight side are kept, without triangles that have no area") {
    CHECK(check_cover(flat({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}})) == 0);
    CHECK(check_cover(flat({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}})) == 0);
}

TEST_CASE("Repeated corners and spikes give triangles without area and nothing else") {
    CHECK(check_cover(flat({{0, 0}, {2, 0}, {2, 0}, {2, 2}, {0, 2}})) == 1);
    CHECK(check_cover(flat({{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0}})) == 1);
    CHECK(check_cover(flat({{0, 0}, {2, 0}, {5, 0}, {2, 0}, {2, 2}, {0, 2}})) == 2);
    std::vector<glm::uvec3> triangles;
    CHECK(cut_polygon(flat({{0, 0}, {1, 0}, {2, 0}, {3, 0}}), triangles) == PolygonCut::exact);
    CHECK(triangles.size() == 2);
    CHECK(cut_polygon(flat({{1, 1}, {1, 1}, {1, 1}, {1, 1}}), triangles) == PolygonCut::exact);
}

TEST_CASE("A polygon that crosses itself is told") {
    std::vector<glm::uvec3> triangles;
    for (const auto& outline : std::vector<std::vector<glm::dvec2>>{
             {{0, 0}, {2, 2}, {2, 0}, {0, 2}},                                                     // a bow tie
             {{0, 0}, {3, 3}, {3, 0}, {0, 2}},                                                     // of unlike halves
             {around(0.0, 1), around(0.4, 1), around(0.8, 1), around(0.2, 1), around(0.6, 1)}}) {  // a pentagram
        CHECK(cut_polygon(flat(outline), triangles) == PolygonCut::crossing);
        CHECK(triangles.size() == outline.size() - 2);
    }
    Corners upright;
    for (const glm::dvec2& p : {glm::dvec2(0, 0), glm::dvec2(2, 2), glm::dvec2(2, 0), glm::dvec2(0, 2)})
        upright.emplace_back(p.x, 0.0, p.y);
    CHECK(cut_polygon(upright, triangles) == PolygonCut::crossing);
}

// The corners lie up to 0.2 off the plane. Seen along z the area is that of the flat U.
TEST_CASE("A concave face that is not quite flat is covered as seen along its normal") {
    Corners corners = flat({{0, 0}, {8, 0}, {8, 6}, {6, 6}, {6, 2}, {2, 2}, {2, 6}, {0, 6}});
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i].z = 0.2 * std::sin(5.0 * static_cast<double>(i));
    CHECK(check_cover(corners, 1e-12) == 0);
}

// The same U in metres, 4000 km from the origin: coordinates in steps of 5e-10.
TEST_CASE("A polygon far from the origin is cut as near it") {
    const std::vector<glm::dvec2> u = {{0, 0}, {8, 0}, {8, 6}, {6, 6}, {6, 2}, {2, 2}, {2, 6}, {0, 6}};
    Corners near = flat(u), far = near;
    for (glm::dvec3& p : far) p += glm::dvec3(4194304.0, -2097152.0, 1048576.0);
    std::vector<glm::uvec3> here, there;
    CHECK(cut_polygon(near, here) == PolygonCut::exact);
    CHECK(cut_polygon(far, there) == PolygonCut::exact);
    CHECK(here == there);
}

// A plate of 3 x 401 with 200 holes of 1 x 1 in a row, each joined to the next by a bridge: 1203 - 200 of area.
TEST_CASE("Many holes on a chain of bridges stay empty") {
    constexpr int holes = 200;
    std::vector<glm::dvec2> plate = {{0, 0}, {2 * holes + 1, 0}, {2 * holes + 1, 3}, {0, 3}, {0, 0}};
    for (int i = 0; i < holes; ++i)  // half around each hole, on to the next one
        for (const auto& [x, y] : {std::pair(1, 1), std::pair(1, 2), std::pair(2, 2)}) plate.emplace_back(2 * i + x, y);
    for (int i = holes - 1; i >= 0; --i) {  // and back, by the bridge between (2, 2) and (3, 1)
        plate.emplace_back(2 * i + 2, 1);
        plate.emplace_back(2 * i + 1, 1);
        if (i > 0) plate.emplace_back(2 * i, 2);
    }
    CHECK(shoelace(flat(plate)) == 1003.0);
    check_cover(flat(plate));
}
