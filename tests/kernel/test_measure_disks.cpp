#include <cmath>

#include "host/scene/bvh/bvh_builder.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "kernels/shared/gather.h"
#include "tests/support/catch.hpp"
#include "tests/support/photon_fixture.hpp"
#include "tests/support/statistics.hpp"

using namespace stokes;

namespace {

GatherPoint point_at(double x, double y, double z) {
    GatherPoint point{};
    point.x = static_cast<float>(x);
    point.y = static_cast<float>(y);
    point.z = static_cast<float>(z);
    point.ny = 1.0f;
    point.maps = 1u << STOKES_MAP_SURFACE;
    point.weight = 1.0f;
    point.radius_factor = 1.0f;
    return point;
}

// Which pass it is, and whether it has low_discrepancy_pixels.
struct PassKind {
    std::uint32_t index = 2;
    bool even = false;
};

// Weights of count pixels that all see the same point of the mesh, its normal +y.
// The mesh's last triangles are those of another body.
std::vector<double> weights_by_pixel(const Mesh& mesh, GatherPoint point, std::uint32_t count, float radius_mm,
                                     std::size_t others = 0, PassKind kind = {}) {
    std::vector<Triangle> triangles = triangles_of(mesh);
    for (std::size_t i = triangles.size() - others; i < triangles.size(); ++i) triangles[i].body = 1;
    const Bvh bvh = build_bvh(triangles, {16, BvhBounds::counts});
    std::vector<GatherPoint> given;
    for (std::uint32_t pixel = 0; pixel < count; ++pixel) {
        point.pixel = pixel;
        given.push_back(point);
    }
    const Buffer<GatherPoint> points = on_device(given);
    const Buffer<PassConstants> pass = pass_on_device(5);
    PassConstants constants = pass.download().front();
    constants.pass = kind.index;
    constants.low_discrepancy_pixels = kind.even ? 1 : 0;
    pass.upload(&constants, 1);
    Program(test_device(), "measure_disks.cl")
        .kernel("measure_disks")
        .launch(count, Arguments()
                           .add("count", count)
                           .add("radius_mm", radius_mm)
                           .add("pass", pass)
                           .add("bvh_nodes", on_device(bvh.nodes), "BvhNode")
                           .add("bvh_blocks", on_device(bvh.blocks))
                           .add("bvh_grid", bvh.grid)
                           .add("triangles", on_device(triangles))
                           .add("gather_points", points));
    std::vector<double> result;
    for (const GatherPoint& found : points.download()) result.push_back(static_cast<double>(found.weight));
    return result;
}

Sample weights(const Mesh& mesh, const GatherPoint& point, std::uint32_t count, float radius_mm, std::size_t others = 0,
               PassKind kind = {}) {
    Sample sample;
    for (const double weight : weights_by_pixel(mesh, point, count, radius_mm, others, kind)) sample.add(weight);
    return sample;
}

// Share of a disk of radius 1 whose centre is d inside of a straight edge: one less the circular segment beyond it.
double share_inside(double d) { return 1.0 - (std::acos(d) - d * std::sqrt(1.0 - d * d)) / M_PI; }

}  // namespace

TEST_CASE("the whole disk on the surface weighs one", "[measure_disks][tiny]") {
    const Sample sample = weights(make_rectangle(20.0, 20.0), point_at(0.3, 0.0, -0.2), 50, 1.0f);
    CHECK(sample.mean() == 1.0);
    CHECK(sample.variance() == 0.0);
}

// The mean of the weight is the reciprocal of the share of the disk on the surface; 14 comparisons at 4 standard
// errors. The variance is that of a geometric distribution, (1 - p)/p^2; with even pixels (1 - p)/p for the first
// place, and a quarter of the geometric one's, 1 - p times, for the rest.
TEST_CASE("near an edge the weight is the reciprocal of the share of the disk, in the mean", "[measure_disks]") {
    const Mesh plate = make_rectangle(20.0, 20.0), post = make_prism(6, 10.0, 8.0);
    const double apothem = 10.0 * std::sqrt(0.75);
    struct Case {
        const Mesh& mesh;
        GatherPoint point;
        double share;
    };
    for (const Case& c :
         {Case{plate, point_at(9.5, 0.0, 0.0), share_inside(0.5)},
          Case{plate, point_at(0.0, 0.0, -9.9), share_inside(0.1)},
          Case{plate, point_at(-9.2, 0.0, 3.0), share_inside(0.8)}, Case{plate, point_at(9.9999, 0.0, 9.9999), 0.25},
          Case{post, point_at(0.0, 8.0, apothem - 0.3), share_inside(0.3)},
          Case{post, point_at(0.0, 8.0, -apothem + 0.6), share_inside(0.6)},
          Case{post, point_at(0.0, 8.0, 0.0), 1.0}}) {
        const Sample sample = weights(c.mesh, c.point, 40000, 1.0f),
                     even = weights(c.mesh, c.point, 40000, 1.0f, 0, {2, true});
        CAPTURE(c.point.x, c.point.y, c.point.z, sample.mean(), even.mean(), 1.0 / c.share);
        CHECK(std::abs(sample.z(1.0 / c.share)) < 4.0);
        CHECK(std::abs(even.z(1.0 / c.share)) < 4.0);
        const double p = c.share, geometric = (1.0 - p) / (p * p);
        CHECK(sample.variance() == Approx(geometric).epsilon(0.1));
        CHECK(even.variance() == Approx((1.0 - p) / p + (1.0 - p) * geometric / 4.0).epsilon(0.1));
    }
}

// Where a series often ends before it finds the surface, as on a strip of a twentieth of the disk, both ways still
// agree.
TEST_CASE("on a thin strip even trials have the mean of random ones", "[measure_disks]") {
    const Mesh strip = make_rectangle(20.0, 0.08);
    const Sample random = weights(strip, point_at(0.0, 0.0, 0.0), 20000, 1.0f),
                 even = weights(strip, point_at(0.0, 0.0, 0.0), 20000, 1.0f, 0, {2, true});
    CAPTURE(random.mean(), even.mean());
    CHECK(random.mean() > 10.0);
    CHECK(std::abs(even.mean() - random.mean()) < 4.0 * std::hypot(even.standard_error(), random.standard_error()));
}

// Of 16 passes the first places are even, so that about as many fail at every pixel: of independent ones the sums'
// variance would be 16 times that of one.
TEST_CASE("over passes disks are measured evenly", "[measure_disks]") {
    const Mesh plate = make_rectangle(20.0, 20.0);
    std::vector<double> sums(4000, 0.0);
    Sample one, all;
    for (std::uint32_t pass = 0; pass < 16; ++pass) {
        const std::vector<double> weights =
            weights_by_pixel(plate, point_at(9.5, 0.0, 0.0), 4000, 1.0f, 0, {pass, true});
        for (std::size_t i = 0; i < sums.size(); ++i) {
            one.add(weights[i]);
            sums[i] += weights[i];
        }
    }
    for (const double sum : sums) all.add(sum);
    const double p = share_inside(0.5), series = (1.0 - p) * (1.0 - p) / (p * p) / 4.0;
    CHECK(all.variance() < 16.0 * (series + 0.4 * (one.variance() - series)));
    CHECK(all.mean() == Approx(16.0 / p).epsilon(0.01));
}

TEST_CASE("a point's own radius is that of its disk", "[measure_disks]") {
    GatherPoint point = point_at(9.0, 0.0, 0.0);
    CHECK(weights(make_rectangle(20.0, 20.0), point, 200, 1.0f).mean() == 1.0);
    point.radius_factor = 2.0f;
    const Sample sample = weights(make_rectangle(20.0, 20.0), point, 40000, 1.0f);
    CHECK(std::abs(sample.z(1.0 / share_inside(0.5))) < 4.0);
}

// A sheet of another body close above is not the point's surface, and hides nothing of it.
TEST_CASE("another body close above does not count", "[measure_disks][tiny]") {
    Mesh two = make_rectangle(20.0, 20.0);
    const Mesh above = make_rectangle(20.0, 20.0);
    for (const glm::vec3& p : above.positions_mm) two.positions_mm.push_back(p + glm::vec3(15.0f, 0.1f, 0.0f));
    for (const glm::uvec3& t : above.triangles) two.triangles.push_back(t + glm::uvec3(4u));
    const GatherPoint point = point_at(6.0, 0.0, 0.0);
    CHECK(weights(two, point, 50, 3.0f, above.triangles.size()).mean() == 1.0);
    const Sample edge = weights(two, point_at(9.5, 0.0, 0.0), 20000, 1.0f, above.triangles.size());
    CHECK(std::abs(edge.z(1.0 / share_inside(0.5))) < 4.0);
}

// A low plate of another body, closed, whose foot lies on the surface: no photon gets below it.
TEST_CASE("what another body stands on is not on the surface", "[measure_disks]") {
    Mesh both = make_rectangle(20.0, 20.0);
    const Mesh plate = make_prism(4, 5.0, 0.1);
    const auto first = static_cast<unsigned>(both.positions_mm.size());
    float edge = 0.0f;  // the plate's reach along x
    for (const glm::vec3& p : plate.positions_mm) {
        both.positions_mm.push_back(p);
        edge = std::max(edge, p.x);
    }
    for (const glm::uvec3& t : plate.triangles) both.triangles.push_back(t + glm::uvec3(first));
    const GatherPoint point = point_at(double(edge) + 0.5, 0.0, 0.0);
    const Sample sample = weights(both, point, 40000, 1.0f, plate.triangles.size());
    CAPTURE(edge, sample.mean());
    CHECK(sample.mean() > 1.02);
    CHECK(sample.mean() < 1.0 / share_inside(0.5) + 4.0 * sample.standard_error());
}

TEST_CASE("the weight that a point has is kept as a factor", "[measure_disks][tiny]") {
    GatherPoint point = point_at(9.0, 0.0, 9.0);
    const Sample plain = weights(make_rectangle(20.0, 20.0), point, 50, 2.0f);
    point.weight = 1.125f;
    const Sample scaled = weights(make_rectangle(20.0, 20.0), point, 50, 2.0f);
    CHECK(plain.mean() > 1.2);
    CHECK(scaled.mean() == Approx(1.125 * plain.mean()).epsilon(1e-12));
    point.x = point.z = 0.0f;
    CHECK(weights(make_rectangle(20.0, 20.0), point, 50, 2.0f).mean() == 1.125);
}

TEST_CASE("points without photons are left alone, and trials end where there is no surface", "[measure_disks][tiny]") {
    GatherPoint nothing = point_at(0.0, 0.0, 0.0);
    nothing.maps = 0;
    nothing.weight = 7.0f;
    CHECK(weights(make_rectangle(20.0, 20.0), nothing, 20, 1.0f).mean() == 7.0);
    const double most = STOKES_GATHER_MOST_TRIALS;
    for (const bool even : {false, true})
        CHECK(weights(make_rectangle(20.0, 20.0), point_at(0.0, 5.0, 0.0), 20, 1.0f, 0, {2, even}).mean() == most);
}
