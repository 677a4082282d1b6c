#include <algorithm>
#include <cmath>

#include "host/render/gather.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/photon_fixture.hpp"
#include "tests/support/statistics.hpp"
#include "tests/support/textures.hpp"

using namespace stokes;

namespace {

constexpr double reflectance = 0.5;

// Shapes without reflectance, lights on and between them, and points that the camera sees, one a pixel. Lights have
// power at the first wavelength alone, which is all that the film's X takes; emission is radiance, or irradiance across
// a beam.
class Bench {
  public:
    Bench() { materials_.push_back({0, 0, 0, STOKES_NONE}); }

    std::uint32_t add_mesh(const Mesh& mesh, std::uint32_t light = STOKES_NONE) {
        const auto first = static_cast<std::uint32_t>(triangles_.size());
        for (const glm::uvec3& t : mesh.triangles)
            triangles_.push_back(make_triangle(mesh.positions_mm[t.x], mesh.positions_mm[t.y], mesh.positions_mm[t.z],
                                               static_cast<std::uint32_t>(shapes_.size())));
        shapes_.push_back({0, light});
        return first;
    }

    void add_lamp(const Mesh& mesh, double radiance, double power = 1.0) {
        LightRecord light{};
        light.kind = STOKES_LIGHT_SURFACE;
        light.first_triangle = add_mesh(mesh, static_cast<std::uint32_t>(lights_.size()));
        light.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
        light.first_area = static_cast<std::uint32_t>(areas_.size());
        double area = 0.0;
        glm::dvec3 centre(0.0);
        for (std::uint32_t t = 0; t < light.triangle_count; ++t) {
            area += area_of(triangles_[light.first_triangle + t]);
            areas_.push_back(static_cast<float>(area));
        }
        for (const glm::vec3& p : mesh.positions_mm)
            centre += glm::dvec3(p) / static_cast<double>(mesh.positions_mm.size());
        light.px = static_cast<float>(centre.x), light.py = static_cast<float>(centre.y),
        light.pz = static_cast<float>(centre.z);
        for (const glm::vec3& p : mesh.positions_mm)
            light.ball_mm = std::max(light.ball_mm, static_cast<float>(glm::length(glm::dvec3(p) - centre)));
        add_light(light, radiance, power);
    }

    // A beam through half-axes about a centre.
    void add_beam(std::uint32_t kind, const glm::dvec3& centre, const glm::dvec3& u, const glm::dvec3& v,
                  double irradiance, double power = 1.0) {
        const glm::vec3 d(glm::normalize(glm::cross(u, v))), p(centre), a(u), b(v);
        LightRecord light{};
        light.kind = kind;
        light.px = p.x, light.py = p.y, light.pz = p.z;
        light.dx = d.x, light.dy = d.y, light.dz = d.z;
        light.ux = a.x, light.uy = a.y, light.uz = a.z;
        light.vx = b.x, light.vy = b.y, light.vz = b.z;
        add_light(light, irradiance, power);
    }

    // The film's X of each point; its other layers are left as they are.
    std::vector<double> light_at(std::vector<GatherPoint> points, std::uint32_t pass_index = 0) const {
        PassConstants pass{};
        pass.seed = 3;
        pass.pass = pass_index;
        for (const Triangle& t : triangles_)  // as DeviceScene has it
            pass.offset_mm =
                std::max(pass.offset_mm, 4e-6f * std::max({std::abs(t.v0x), std::abs(t.v0y), std::abs(t.v0z)}));
        pass.to_x[0] = 1.0f;
        for (std::uint32_t i = 0; i < points.size(); ++i) points[i].pixel = i;
        const auto count = static_cast<std::uint32_t>(points.size());
        std::vector<LightRecord> lights = lights_;
        double sum = 0.0, total = 0.0;
        for (const double p : powers_) total += p;
        for (std::size_t l = 0; l < lights.size(); ++l) {
            sum += powers_[l];
            lights[l].cumulative_probability = static_cast<float>(sum / total);
        }
        std::vector<float> areas = areas_;
        if (areas.empty()) areas.push_back(0.0f);
        const RayScene rays(test_device(), triangles_);
        Flux16 dim = constant_flux(0.0f), white = constant_flux(0.0f);
        dim.v[0] = static_cast<float>(reflectance);
        white.v[0] = 1.0f;
        const Buffer<FilmValue> film =
            on_device(std::vector<FilmValue>(STOKES_LAYER_COUNT * points.size(), FilmValue{0, 0, 0, 0}));
        rays.kernels.program(test_device(), "direct_light.cl")
            .kernel("add_direct_light")
            .launch(count, Arguments()
                               .add("gather_points", on_device(points))
                               .add("count", count)
                               .add("pass", on_device(std::vector<PassConstants>{pass}))
                               .add(rays.arguments())
                               .add("triangles", on_device(triangles_))
                               .add("shapes", on_device(shapes_))
                               .add("light_count", static_cast<std::uint32_t>(lights.size()))
                               .add("lights", on_device(lights))
                               .add("light_areas", on_device(areas))
                               .add("light_radiance", on_device(emission_))
                               .add("spectra", on_device(std::vector<Flux16>{dim, white}))
                               .add("texture_records", on_device(materials_))
                               .add("film", film, "float4"));
        const std::vector<FilmValue> values = film.download();
        std::vector<double> result;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const FilmValue& v = values[i];
            REQUIRE((v.y == 0.0f && v.z == 0.0f && v.unused == 0.0f));
            if (i / points.size() == STOKES_MAP_SURFACE)
                result.push_back(static_cast<double>(v.x));
            else
                REQUIRE(v.x == 0.0f);
        }
        return result;
    }

    Sample sample_at(const GatherPoint& point, std::size_t count, std::uint32_t pass = 0) const {
        Sample sample;
        for (const double x : light_at(std::vector<GatherPoint>(count, point), pass)) sample.add(x);
        return sample;
    }

    std::vector<TextureRecord> materials_;

  private:
    void add_light(const LightRecord& light, double value, double power) {
        lights_.push_back(light);
        powers_.push_back(power);
        emission_.push_back(constant_flux(0.0f));
        emission_.back().v[0] = static_cast<float>(value);
    }

    std::vector<Triangle> triangles_;
    std::vector<ShapeRecord> shapes_;
    std::vector<LightRecord> lights_;
    std::vector<double> powers_;
    std::vector<float> areas_;
    std::vector<Flux16> emission_;
};

GatherPoint point_at(const glm::dvec3& position, const glm::dvec3& normal = {0.0, 1.0, 0.0}) {
    const glm::vec3 p(position), n(glm::normalize(normal));
    GatherPoint point{};
    point.x = p.x, point.y = p.y, point.z = p.z;
    point.nx = n.x, point.ny = n.y, point.nz = n.z;
    point.maps = 1u << STOKES_MAP_SURFACE;
    point.weight = 7.0f;  // of the density estimate, which is not asked
    return point;
}

Mesh facing_down(Mesh mesh, const glm::dvec3& at) { return moved(turned_over(std::move(mesh)), at); }

}  // namespace

// Parallel light of irradiance E across its way brings E cos: radiance rho E cos / pi, to rounding.
TEST_CASE("a beam brings its irradiance times the cosine, within its section", "[direct_light][tiny]") {
    for (const bool disk : {true, false}) {
        CAPTURE(disk);
        Bench bench;
        bench.add_mesh(make_rectangle(100.0, 100.0));
        const glm::dvec3 d = glm::normalize(glm::dvec3(0.5, -1.0, 0.2)),
                         u = 3.0 * glm::normalize(glm::cross(d, {0.1, 0.3, 1.0})),
                         v = 2.0 * glm::normalize(glm::cross(d, u));
        bench.add_beam(disk ? STOKES_LIGHT_BEAM_DISK : STOKES_LIGHT_BEAM_RECTANGLE, -10.0 * d, u, v, 4.0);
        std::vector<GatherPoint> points;
        std::vector<double> expected;
        for (const double x : {-1.3, -1.02, -0.98, -0.75, 0.0, 0.66, 0.75, 0.98, 1.02})
            for (const double y : {-1.1, -0.97, -0.6, 0.0, 0.64, 0.97, 1.1})
                for (const glm::dvec3& normal : {glm::dvec3(0, 1, 0), glm::dvec3(-3, 1, 0), glm::dvec3(0, 1, 9)}) {
                    const double lift = 1.0;  // off the plate, so that it blocks none of them
                    const glm::dvec3 off = x * u + y * v, p = off + d * ((lift - off.y) / d.y);
                    points.push_back(point_at(p, normal));
                    const bool inside = disk ? x * x + y * y < 1.0 : std::abs(x) < 1.0 && std::abs(y) < 1.0;
                    const double cosine = std::max(0.0, -glm::dot(d, glm::normalize(normal)));
                    expected.push_back(inside ? reflectance / M_PI * 4.0 * cosine : 0.0);
                }
        const std::vector<double> found = bench.light_at(points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            CAPTURE(i);
            CHECK(found[i] == Approx(expected[i]).epsilon(1e-5));
        }
    }
}

TEST_CASE("a light of a kind that nobody knows brings nothing", "[direct_light][tiny]") {
    Bench bench;
    bench.add_mesh(make_rectangle(100.0, 100.0));
    bench.add_beam(77, {0.0, 10.0, 0.0}, {5.0, 0.0, 0.0}, {0.0, 0.0, 5.0}, 1.0);
    CHECK(bench.light_at({point_at({0.0, 0.0, 0.0})}) == std::vector<double>{0.0});
}

// One plate, seen from above and from below as a sheet with two sides is, under a beam from above.
TEST_CASE("beams light the side they fall on, until something is in their way", "[direct_light][tiny]") {
    const glm::dvec3 u(5.0, 0.0, 0.0), v(0.0, 0.0, 5.0);  // u x v looks down
    Bench bench;
    bench.add_mesh(make_rectangle(100.0, 100.0));
    bench.add_beam(STOKES_LIGHT_BEAM_DISK, {0.0, 10.0, 0.0}, u, v, 1.0);
    bench.add_mesh(moved(make_rectangle(1.0, 1.0), {2.0, 5.0, 0.0}));    // in the way
    bench.add_mesh(moved(make_rectangle(1.0, 1.0), {-2.0, 11.0, 0.0}));  // behind the section
    bench.add_mesh(moved(make_rectangle(1.0, 1.0), {0.0, -3.0, 0.0}));   // beyond the plate
    GatherPoint translucent = point_at({0.0, 0.0, 0.0});
    translucent.maps = 1u << STOKES_MAP_FLUORESCENCE;
    const std::vector<double> found =
        bench.light_at({point_at({0.0, 0.0, 0.0}), point_at({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}),
                        point_at({2.0, 0.0, 0.0}), point_at({2.0, 5.0, 0.0}), point_at({-2.0, 0.0, 0.0}),
                        point_at({0.0, -3.0, 0.0}), point_at({0.0, 12.0, 0.0}), translucent});
    const double lit = reflectance / M_PI;
    const double expected[] = {lit, 0.0, 0.0, lit, lit, 0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < found.size(); ++i) {
        CAPTURE(i);
        CHECK(found[i] == Approx(expected[i]).epsilon(1e-6));
    }
}

// An element on the axis of a disk of radius r at height h that emits L: E = pi L r^2 / (r^2 + h^2), times the cosine
// of its tilt while the whole disk is above its horizon. A regular polygon of 256 corners has 1e-4 less. Below the
// square root of its area, h is near and the cosine is drawn, too. Eight comparisons at 4 standard errors.
TEST_CASE("a disk lights a point on its axis by its form factor", "[direct_light]") {
    const double r = 10.0;
    for (const double h : {0.2, 4.0, 15.0, 19.0, 60.0, 1000.0})
        for (const double tilt : {0.0, 0.5}) {
            if (tilt > 0.0 && h < 40.0) continue;
            CAPTURE(h, tilt);
            Bench bench;
            bench.add_mesh(make_rectangle(100.0, 100.0));
            bench.add_lamp(facing_down(make_disk(r, 256), {0.0, h, 0.0}), 2.0);
            const Sample sample =
                bench.sample_at(point_at({0.0, 0.0, 0.0}, {std::sin(tilt), std::cos(tilt), 0.0}), 40000);
            const double expected = reflectance * 2.0 * r * r / (r * r + h * h) * std::cos(tilt);
            CAPTURE(sample.mean(), expected, sample.standard_error());
            CHECK(std::abs(sample.mean() - expected) < 4.0 * sample.standard_error() + 2.5e-4 * expected);
            CHECK(sample.standard_error() < 0.01 * expected);
        }
}

TEST_CASE("a lamp shines from its front alone, and not through things", "[direct_light][tiny]") {
    Bench bench;
    bench.add_mesh(make_rectangle(100.0, 100.0));
    bench.add_lamp(facing_down(make_disk(5.0, 12), {0.0, 20.0, 0.0}), 2.0);
    bench.add_mesh(moved(make_rectangle(40.0, 40.0), {30.0, 10.0, 0.0}));
    for (const GatherPoint& dark :
         {point_at({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}), point_at({0.0, 22.0, 0.0}, {0.0, -1.0, 0.0}),
          point_at({40.0, 0.0, 0.0}), point_at({0.0, 20.0, 0.0}, {0.0, -1.0, 0.0})})
        for (const double x : bench.light_at(std::vector<GatherPoint>(40, dark))) CHECK(x == 0.0);
    for (const double x : bench.light_at(std::vector<GatherPoint>(40, point_at({0.0, 0.0, 0.0})))) CHECK(x > 0.0);
}

// A wall of height H that emits L, so wide that it has no ends, seen from the floor at distance h: the form factor of a
// strip, E = pi L (1 - h / sqrt(h^2 + H^2)) / 2. By area alone one point of it in many would bring nearly all; each of
// the two draws brings at most rho L.
TEST_CASE("light close by has no rare bright draws", "[direct_light]") {
    const double height = 20.0, width = 2000.0;
    Mesh wall;
    const float half = static_cast<float>(width / 2.0), top = static_cast<float>(height);
    wall.positions_mm = {{0, 0, -half}, {0, 0, half}, {0, top, half}, {0, top, -half}};
    wall.triangles = {{0, 2, 1}, {0, 3, 2}};  // looks at +x
    Bench bench;
    bench.add_mesh(make_rectangle(width, width));
    bench.add_lamp(wall, 3.0);
    const double radiance = 3.0;
    for (const double h : {0.5, 3.0, 30.0}) {
        CAPTURE(h);
        const std::vector<double> found = bench.light_at(std::vector<GatherPoint>(40000, point_at({h, 0.0, 0.0})));
        Sample sample;
        for (const double x : found) {
            sample.add(x);
            REQUIRE(x <= 2.0001 * reflectance * radiance);
        }
        const double expected = reflectance * radiance * 0.5 * (1.0 - h / std::hypot(h, height));
        CAPTURE(sample.mean(), expected, sample.standard_error());
        CHECK(std::abs(sample.z(expected)) < 4.0);
        CHECK(sample.standard_error() < 0.02 * expected);
    }
}

// 40 lamps and beams: what each brings is known, and 16 are drawn. Under a lamp, 3 mm below it, and far from all; there
// the beams start below. 4 standard errors.
TEST_CASE("of many lights some are drawn, and the mean is the sum of all", "[direct_light]") {
    const double h = 60.0, r = 5.0;
    for (const glm::dvec3& at : {glm::dvec3(0.0, 0.0, 0.0), glm::dvec3(0.0, 57.0, 12.0)}) {
        Bench bench;
        bench.add_mesh(make_rectangle(400.0, 400.0));
        double expected = 0.0;
        for (int i = 0; i < 40; ++i) {
            const double value = 1.0 + i % 7, power = i % 5 == 0 ? 3.0 : 0.5 + 0.1 * i;
            if (i % 4 == 0) {
                const double angle = 0.02 * i;
                const glm::dvec3 u(5.0 * std::cos(angle), 5.0 * std::sin(angle), 0.0), v(0.0, 0.0, 5.0);
                bench.add_beam(STOKES_LIGHT_BEAM_RECTANGLE, -30.0 * glm::normalize(glm::cross(u, v)), u, v, value,
                               power);
                if (at.y == 0.0) expected += value * std::cos(angle);
            } else {
                const double x = 12.0 * (i % 9 - 4), z = 12.0 * (i % 8 - 4), radiance = 100.0 * value;
                bench.add_lamp(facing_down(make_disk(r, 256), {x, h, z}), radiance, power);
                const int points = 20000;
                double form = 0.0;  // mean of cos^2 / d^2 over the disk
                for (int k = 0; k < points; ++k) {
                    const double a = r * std::sqrt((k + 0.5) / points), t = 2.399963 * k;
                    const glm::dvec3 way = glm::dvec3(x + a * std::cos(t), h, z + a * std::sin(t)) - at;
                    form += way.y * way.y / std::pow(glm::dot(way, way), 2.0) / points;
                }
                expected += radiance * form * M_PI * r * r;
            }
        }
        expected *= reflectance / M_PI;
        for (std::uint32_t pass = 0; pass < 4; ++pass) {
            const Sample sample = bench.sample_at(point_at(at), 20000, pass);
            CAPTURE(at.y, pass, sample.mean(), expected, sample.standard_error());
            CHECK(std::abs(sample.mean() - expected) < 4.0 * sample.standard_error() + 1e-3 * expected);
            CHECK(sample.standard_error() < 1e-2 * expected);
        }
    }
}

// The reflectance is 0.5 where the picture is black and 1 where it is white, in proportion between.
TEST_CASE("the reflectance is that of the texture where the point lies", "[direct_light][tiny]") {
    Bench bench;
    bench.materials_[0] = {4, 4, 0, 1};
    bench.add_mesh(make_rectangle(100.0, 100.0));
    bench.add_beam(STOKES_LIGHT_BEAM_DISK, {0.0, 10.0, 0.0}, {5.0, 0.0, 0.0}, {0.0, 0.0, 5.0}, 1.0);
    GatherPoint point = point_at({0.0, 0.0, 0.0});
    for (const float luminance : {0.0f, 0.25f, 1.0f}) {
        point.luminance = luminance;
        CHECK(bench.light_at({point})[0] ==
              Approx((reflectance + static_cast<double>(luminance) * (1.0 - reflectance)) / M_PI).epsilon(1e-6));
    }
}

namespace {

// The mean over n passes of independent draws has the standard deviation sigma / sqrt(n) about the expectation; that of
// draws spread evenly over the passes is far less: below half of it here.
void check_spread(const Bench& bench, const GatherPoint& point, std::size_t pixels, std::uint32_t passes,
                  double least_variance) {
    const std::vector<GatherPoint> points(pixels, point);
    std::vector<double> means(points.size(), 0.0);
    Sample single, mean;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const std::vector<double> found = bench.light_at(points, pass);
        for (std::size_t i = 0; i < found.size(); ++i) {
            means[i] += found[i] / passes;
            single.add(found[i]);
        }
    }
    for (const double m : means) mean.add(m);
    CAPTURE(single.mean(), single.variance(), mean.variance() * passes);
    CHECK(single.variance() > least_variance * single.mean() * single.mean());
    CHECK(mean.variance() * passes < 0.25 * single.variance());
}

}  // namespace

TEST_CASE("a pixel's draws are spread over the passes", "[direct_light]") {
    Bench bench;
    bench.add_mesh(make_rectangle(400.0, 400.0));
    bench.add_lamp(facing_down(make_rectangle(30.0, 30.0), {40.0, 60.0, 0.0}), 1.0);
    bench.add_mesh(moved(make_rectangle(30.0, 30.0), {35.0, 30.0, 0.0}));  // half of the lamp is hidden
    check_spread(bench, point_at({0.0, 0.0, 0.0}), 500, 64, 0.05);
}

// Which lights are drawn and where on them must not go in step over the passes, or a pixel would see but a part of each
// for ever.
TEST_CASE("the draws of many lights are spread over the passes together", "[direct_light]") {
    Bench bench;
    bench.add_mesh(make_rectangle(400.0, 400.0));
    for (int i = 0; i < 40; ++i) {
        const double x = 14.0 * (i % 8 - 4), z = 14.0 * (i / 8 - 2);
        bench.add_lamp(facing_down(make_rectangle(12.0, 12.0), {x, 15.0, z}), 1.0 + i % 3, 0.5 + i % 7);
    }
    check_spread(bench, point_at({3.0, 0.0, 2.0}), 200, 512, 0.001);
}
