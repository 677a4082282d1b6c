#include <cmath>
#include <random>

#include "host/render/gather.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/normals.hpp"
#include "tests/support/textures.hpp"

using namespace stokes;

namespace {

// Materials of the tests, by index; reflectances are in the row of the same number.
enum : std::uint32_t { black, grey, white, plain_translucent, surface_fluorescent, smooth_translucent, unknown };

constexpr float exit_scale = 1.3f, smooth_eta = 2.0f;  // of smooth_translucent

struct Photon {
    glm::dvec3 position, normal;
    float flux = 1.0f;  // at the first wavelength; 1 + k/8 times that at wavelength k
    std::uint32_t body = 0;
};

// A point for the camera to see: a triangle whose first vertex it is, seen head on.
struct Seen {
    glm::dvec3 position, normal;
    std::uint32_t material = white;
    std::uint32_t light = STOKES_NONE;
    bool from_behind = false, missed = false;
    std::uint32_t body = 0;
};

float spectrum(int k) { return 1.0f + 0.125f * static_cast<float>(k); }
float reflectance(std::uint32_t material, int k) { return material == grey ? 0.02f * static_cast<float>(k + 1) : 1.0f; }
float emitted(int k) { return 3.0f + static_cast<float>(k); }

PassConstants pass_constants() {
    PassConstants pass{};
    for (int k = 0; k < 16; ++k) {
        pass.to_x[k] = 1.0f;
        pass.to_y[k] = 0.1f * static_cast<float>(k);
        pass.to_z[k] = 1.0f / static_cast<float>(1 + k);
    }
    return pass;
}

// Points in a row, one pixel each, over a camera whose rays the tests write themselves.
class Bench {
  public:
    // direct: rays start at the camera, and so go their own way to the points.
    Bench(const std::vector<Seen>& seen, const std::vector<Photon>& photons, float radius_mm, bool direct = false)
        : direct_(direct),
          count_(static_cast<std::uint32_t>(seen.size())),
          gather_(test_device(), {}, camera()),
          hash_(test_device(), "test", static_cast<std::uint32_t>(photons.size())),
          film_(test_device(), "film", std::vector<FilmValue>(STOKES_LAYER_COUNT * seen.size(), FilmValue{0, 0, 0, 0})),
          pass_(test_device(), "pass", std::vector<PassConstants>{pass_constants()}) {
        set_scene(seen);
        set_photons(photons, radius_mm);
    }

    void collect() { gather_.collect_points(common_, rays_, hits_, film_); }
    // Points get that many times the radius each; the surface map is gathered class by class.
    void run_with(const std::vector<float>& factors, const std::vector<Seen>& seen, const std::vector<Photon>& photons,
                  float radius_mm) {
        std::vector<PixelRadius> pixels;
        for (std::size_t i = 0; i < seen.size(); ++i) pixels.push_back({factors[i], seen[i].material});
        gather_.set_radii(pixels);
        collect();
        gather_.choose_radii();
        for (const float radius_class : gather_.radius_classes()) {
            set_photons(photons, radius_class * radius_mm);
            gather_.add_map(common_, STOKES_MAP_SURFACE, radius_class, hash_, film_);
        }
    }
    void add(std::uint32_t map) { gather_.add_map(common_, map, 1.0f, hash_, film_); }
    void run() {
        collect();
        for (std::uint32_t map = 0; map < STOKES_MAP_COUNT; ++map) add(map);
    }
    // By component, then point.
    std::vector<FilmValue> film() const { return film_.download(); }
    std::vector<GatherPoint> points() const { return gather_.points().download(); }
    double x(std::uint32_t component, std::uint32_t point) const { return film()[component * count_ + point].x; }

  private:
    CameraRecord camera() const {
        CameraRecord record{};
        record.width = count_;
        record.height = 1;
        return record;
    }

    void set_scene(const std::vector<Seen>& seen) {
        std::vector<Triangle> triangles;
        std::vector<ShapeRecord> shapes;
        std::vector<Ray> rays;
        std::vector<Hit> hits;
        for (const Seen& s : seen) {
            const std::uint32_t i = static_cast<std::uint32_t>(triangles.size());
            const glm::dvec3 other = std::abs(s.normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
            const glm::vec3 p(s.position), e1(glm::normalize(glm::cross(other, s.normal)) * 2.0);
            const glm::vec3 e2(glm::cross(s.normal, glm::dvec3(e1)));
            const glm::vec3 d(s.normal * (s.from_behind ? 1.0 : -1.0));
            triangles.push_back({p.x, p.y, p.z, i, e1.x, e1.y, e1.z, s.body, e2.x, e2.y, e2.z, 0});
            shapes.push_back({s.material, s.light});
            const glm::vec3 from = direct_ ? glm::vec3(0.0f) : p - d;
            rays.push_back({from.x, from.y, from.z, 0.0f, d.x, d.y, d.z, INFINITY});
            hits.push_back({1.0f, 0.0f, 0.0f, s.missed ? STOKES_NONE : i});
        }
        std::vector<MaterialRecord> materials(7);
        materials[black].kind = STOKES_BLACK;
        materials[grey].kind = materials[white].kind = STOKES_DIFFUSE;
        materials[plain_translucent].kind = materials[surface_fluorescent].kind = STOKES_TRANSLUCENT;
        materials[plain_translucent].flags = STOKES_MATERIAL_SUBSURFACE;
        materials[smooth_translucent] = materials[plain_translucent];
        materials[smooth_translucent].flags |= STOKES_MATERIAL_FRESNEL;
        materials[smooth_translucent].eta = smooth_eta;
        materials[smooth_translucent].exit_scale = exit_scale;
        materials[unknown].kind = 77;
        std::vector<Flux16> spectra(materials.size()), lights(2);
        for (int k = 0; k < 16; ++k) {
            for (std::uint32_t m = 0; m < spectra.size(); ++m) spectra[m].v[k] = reflectance(m, k);
            lights[0].v[k] = lights[1].v[k] = emitted(k);
        }
        const Device& device = test_device();
        std::vector<LightRecord> records(2);
        records[0].kind = STOKES_LIGHT_SURFACE;
        records[1].kind = 77;
        common_ = Arguments("triangles", Buffer<Triangle>(device, "triangles", triangles))
                      .add("shapes", Buffer<ShapeRecord>(device, "shapes", shapes))
                      .add("materials", Buffer<MaterialRecord>(device, "materials", materials))
                      .add("spectra", Buffer<Flux16>(device, "spectra", spectra))
                      .add("light_count", 2u)
                      .add("lights", Buffer<LightRecord>(device, "lights", records))
                      .add("light_areas", Buffer<float>(device, "areas", 1))
                      .add("light_radiance", Buffer<Flux16>(device, "emitted", lights))
                      .add("pass", pass_)
                      .add(no_textures(materials.size()).arguments());
        rays_ = {device, "rays", rays};
        hits_ = {device, "hits", hits};
    }

    void set_photons(const std::vector<Photon>& photons, float radius_mm) {
        std::vector<PhotonHead> heads;
        std::vector<Flux16> flux;
        glm::vec3 low(0.0f), high(0.0f);
        for (const Photon& photon : photons) {
            const glm::vec3 p(photon.position);
            heads.push_back({p.x, p.y, p.z, pack_normal_twin(photon.normal, photon.body)});
            Flux16 value;
            for (int k = 0; k < 16; ++k) value.v[k] = photon.flux * spectrum(k);
            flux.push_back(value);
            low = heads.size() == 1 ? p : glm::min(low, p);
            high = heads.size() == 1 ? p : glm::max(high, p);
        }
        const std::uint32_t count = static_cast<std::uint32_t>(photons.size());
        HashBuilder builder(test_device(), count);
        const Buffer<PhotonHead> head_buffer(test_device(), "heads", heads);
        const Buffer<Flux16> flux_buffer(test_device(), "flux", flux);
        builder.build(hash_, head_buffer, flux_buffer, count, low, high, radius_mm);
        test_device().finish();
    }

    bool direct_;
    std::uint32_t count_;
    Gather gather_;
    SpatialHash hash_;
    Buffer<FilmValue> film_;
    Buffer<PassConstants> pass_;
    Arguments common_;
    Buffer<Ray> rays_;
    Buffer<Hit> hits_;
};

// X, Y, Z of 1/(pi r^2) * sum of flux / pi, in double precision over all photons; none when a photon lies so
// close to a limit of the test that single precision may decide otherwise.
struct Expected {
    double x = 0.0, y = 0.0, z = 0.0;
    bool decided = true;
    int found = 0;
};

Expected expected_light(const Seen& seen, const std::vector<Photon>& photons, double radius) {
    Expected result;
    double sum = 0.0;
    for (const Photon& photon : photons) {
        const glm::dvec3 offset = photon.position - seen.position;
        const double far = glm::length(offset) / radius - 1.0;
        const double high = std::abs(glm::dot(offset, seen.normal)) / radius - STOKES_GATHER_MAX_HEIGHT;
        const double turned = STOKES_GATHER_MIN_COSINE - glm::dot(photon.normal, seen.normal);
        if (far < 2e-5 && high < 2e-5 && turned < 0.008 && (far > -2e-5 || high > -2e-5 || turned > -0.008))
            result.decided = false;
        if (far < 0.0 && high < 0.0 && turned < 0.0 && photon.body % 256 == seen.body % 256) {
            sum += photon.flux;
            ++result.found;
        }
    }
    const PassConstants pass = pass_constants();
    for (int k = 0; k < 16; ++k) {
        const double radiance = sum * spectrum(k) * reflectance(seen.material, k) / (M_PI * M_PI * radius * radius);
        result.x += radiance * pass.to_x[k];
        result.y += radiance * pass.to_y[k];
        result.z += radiance * pass.to_z[k];
    }
    return result;
}

// Rounded to single precision, as photons and points are stored.
glm::dvec3 stored(const glm::dvec3& p) { return glm::dvec3(glm::vec3(p)); }

// Photons and points on a sphere and on a plane through it, with normals off the surface's.
void random_surface(std::uint32_t photon_count, std::uint32_t point_count, std::vector<Photon>& photons,
                    std::vector<Seen>& seen) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const auto place = [&](bool sphere, glm::dvec3& position, glm::dvec3& normal) {
        normal = sphere ? random_direction(generator) : glm::dvec3(0.0, 0.0, 1.0);
        position =
            stored(sphere ? 4.0 * normal : glm::dvec3(10.0 * uniform(generator), 10.0 * uniform(generator), 0.0));
    };
    for (std::uint32_t i = 0; i < photon_count; ++i) {
        Photon photon;
        place(i % 2 == 0, photon.position, photon.normal);
        photon.normal = glm::normalize(photon.normal + 0.7 * random_direction(generator));
        photon.position = stored(photon.position + 0.3 * (uniform(generator) - 0.5) * photon.normal);
        photon.flux = static_cast<float>(0.5 + uniform(generator));
        photon.body = i % 5 == 0 ? 3 : 256;
        photons.push_back(photon);
    }
    for (std::uint32_t i = 0; i < point_count; ++i) {
        Seen s;
        place(i % 2 == 0, s.position, s.normal);
        s.material = i % 3 == 0 ? grey : white;
        s.body = i % 4 == 1 ? 259 : 0;
        seen.push_back(s);
    }
}

void check_against_all(std::uint32_t photon_count, std::uint32_t point_count, float radius) {
    std::vector<Photon> photons;
    std::vector<Seen> seen;
    random_surface(photon_count, point_count, photons, seen);
    Bench bench(seen, photons, radius);
    bench.collect();
    bench.add(STOKES_MAP_SURFACE);
    const std::vector<FilmValue> film = bench.film();
    std::uint32_t decided = 0;
    int found = 0;
    for (std::uint32_t i = 0; i < point_count; ++i) {
        const Expected expected = expected_light(seen[i], photons, radius);
        if (!expected.decided) continue;
        ++decided;
        found += expected.found;
        const FilmValue& value = film[STOKES_LAYER_SURFACE * point_count + i];
        REQUIRE(value.x == Approx(expected.x).epsilon(1e-5));
        REQUIRE(value.y == Approx(expected.y).epsilon(1e-5));
        REQUIRE(value.z == Approx(expected.z).epsilon(1e-5));
        REQUIRE(value.unused == 0.0f);
    }
    CHECK(decided > point_count / 4);
    CHECK(found > static_cast<int>(decided));
}

}  // namespace

TEST_CASE("the gather sums the photons that a double-precision search finds", "[gather][tiny]") {
    check_against_all(300, 40, 1.2f);
}

TEST_CASE("the gather agrees with the search for few and for many photons a point", "[gather]") {
    check_against_all(20000, 400, 0.3f);
    check_against_all(20000, 100, 2.5f);  // more than the list of photons found takes at once
}

TEST_CASE("points with radii of all classes each agree with the search", "[gather]") {
    std::vector<Photon> photons;
    std::vector<Seen> seen;
    random_surface(20000, 400, photons, seen);
    const float classes[] = {0.5f, 0.50001f, 0.7f, 1.0f, 1.00001f, 1.4f, 2.0f, 2.5f, 3.99f, 4.0f};
    std::vector<float> factors;
    for (std::size_t i = 0; i < seen.size(); ++i) factors.push_back(classes[i % 10]);
    const float radius = 0.4f;
    Bench bench(seen, photons, radius, true);
    bench.run_with(factors, seen, photons, radius);
    const std::vector<FilmValue> film = bench.film();
    const std::vector<GatherPoint> points = bench.points();
    std::size_t decided = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        CHECK(points[i].radius_factor == factors[i]);
        const Expected expected = expected_light(seen[i], photons, static_cast<double>(radius * factors[i]));
        if (!expected.decided) continue;
        ++decided;
        const FilmValue& value = film[STOKES_LAYER_SURFACE * seen.size() + i];
        REQUIRE(value.x == Approx(expected.x).epsilon(1e-5));
        REQUIRE(value.y == Approx(expected.y).epsilon(1e-5));
        REQUIRE(value.z == Approx(expected.z).epsilon(1e-5));
    }
    CHECK(decided > seen.size() / 4);
}

TEST_CASE("reflections and other materials keep the radius of the pass", "[gather][tiny]") {
    const glm::dvec3 up(0.0, 0.0, 1.0);
    const std::vector<Seen> seen = {
        {{0.0, 0.0, -1.0}, up, white}, {{0.5, 0.0, -1.0}, up, white}, {{0.0, 0.0, -1.0}, up, grey}};
    Bench bench(seen, {}, 1.0f);
    std::vector<Seen> at_set_up = seen;
    at_set_up[2].material = white;
    bench.run_with({2.0f, 2.0f, 2.0f}, at_set_up, {}, 1.0f);
    const std::vector<GatherPoint> points = bench.points();
    CHECK(points[0].radius_factor == 2.0f);
    CHECK(points[1].radius_factor == 1.0f);
    CHECK(points[2].radius_factor == 1.0f);
}

TEST_CASE("photons of another body do not count", "[gather][tiny]") {
    const glm::dvec3 up(0.0, 0.0, 1.0);
    std::vector<Seen> seen(2, {{0.0, 0.0, 0.0}, up, white});
    seen[1].body = 7;
    Bench bench(seen, {{{0.1, 0.0, 0.01}, up, 1.0f, 7}}, 1.0f);
    bench.run();
    CHECK(bench.x(STOKES_MAP_SURFACE, 0) == 0.0);
    CHECK(bench.x(STOKES_MAP_SURFACE, 1) > 0.0);
}

// Flux per area E on a white diffuse plane: radiance E / pi. 4000 photons a point, 200 points: the mean has a
// standard error below 1 / sqrt(4000 * 20), as the plane holds some 20 disks.
TEST_CASE("uniform photons on a plane give radiance flux / (pi area)", "[gather]") {
    std::mt19937 generator(9);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<Photon> photons(80000);
    for (Photon& photon : photons) {
        photon.position = {10.0 * uniform(generator), 5.0, 10.0 * uniform(generator)};
        photon.normal = {0.0, 1.0, 0.0};
    }
    std::vector<Seen> seen(200);
    for (Seen& s : seen) {
        s.position = {1.5 + 7.0 * uniform(generator), 5.0, 1.5 + 7.0 * uniform(generator)};
        s.normal = {0.0, 1.0, 0.0};
    }
    Bench bench(seen, photons, 1.26f);
    bench.run();
    double spectrum_sum = 0.0, mean = 0.0;
    for (int k = 0; k < 16; ++k) spectrum_sum += spectrum(k);
    for (const FilmValue& value : bench.film()) mean += value.x / static_cast<double>(seen.size());
    CHECK(mean == Approx(80000.0 / 100.0 / M_PI * spectrum_sum).epsilon(4.0 / std::sqrt(4000.0 * 20.0)));
}

TEST_CASE("materials see their own maps", "[gather][tiny]") {
    const glm::dvec3 up(0.0, 0.0, 1.0);
    std::vector<Seen> seen;
    for (std::uint32_t material : {black, grey, white, plain_translucent, surface_fluorescent, smooth_translucent})
        seen.push_back({{0.0, 0.0, 0.0}, up, material});
    Bench bench(seen, {{{0.1, 0.0, 0.0}, up, 2.0f}}, 0.5f);
    bench.run();
    double white_x = 0.0, grey_x = 0.0;
    for (int k = 0; k < 16; ++k) {
        white_x += 2.0 * spectrum(k) / (M_PI * M_PI * 0.25);
        grey_x += 2.0 * spectrum(k) * reflectance(grey, k) / (M_PI * M_PI * 0.25);
    }
    const double smooth_x = white_x * static_cast<double>(exit_scale);
    const double expected[4][6] = {{0, 0, 0, white_x, white_x, smooth_x},
                                   {0, 0, 0, white_x, 0, smooth_x},
                                   {0, 0, 0, white_x, 0, smooth_x},
                                   {0, grey_x, white_x, 0, 0, 0}};
    for (std::uint32_t component = 0; component < 4; ++component)
        for (std::uint32_t i = 0; i < seen.size(); ++i) {
            INFO("component " << component << ", point " << i);
            CHECK(bench.x(component, i) == Approx(expected[component][i]).epsilon(1e-5));
        }
}

TEST_CASE("light does not come through a wall, round an edge or from a step", "[gather][tiny]") {
    const glm::dvec3 up(0.0, 0.0, 1.0);
    const std::vector<Photon> photons = {
        {{0.1, 0.0, -0.05}, -up},             // the far side of a thin wall
        {{0.1, 0.0, -0.1}, {1.0, 0.0, 0.0}},  // round an edge
        {{0.1, 0.0, 0.26}, up},               // a step up
        {{0.1, 0.0, -0.26}, up},              // a step down
        {{0.8, 0.8, 0.0}, up},                // in the square about the point, outside of the circle
    };
    const std::vector<Seen> seen = {{{0.0, 0.0, 0.0}, up, white}};
    Bench dark(seen, photons, 1.0f);
    dark.run();
    for (const FilmValue& value : dark.film()) CHECK(value.x == 0.0f);

    Bench lit(seen, {{{0.1, 0.0, 0.24}, up}, {{0.5, 0.5, 0.0}, glm::normalize(glm::dvec3(1.5, 0.0, 1.0))}}, 1.0f);
    lit.run();
    double expected = 0.0;
    for (int k = 0; k < 16; ++k) expected += 2.0 * spectrum(k) / (M_PI * M_PI);
    CHECK(lit.x(STOKES_MAP_SURFACE, 0) == Approx(expected).epsilon(1e-5));
}

// Prisms over regular polygons, turned at random: each edge is seen from both of its faces, close by, with a
// photon close by on the other.
TEST_CASE("the faces of a regular prism treat each other's photons alike at every edge", "[gather]") {
    std::mt19937 generator(17);
    for (int sides = 3; sides <= 16; ++sides)
        for (int turn = 0; turn < 40; ++turn) {
            const glm::dvec3 axis = random_direction(generator), other = random_direction(generator);
            const glm::dvec3 u = glm::normalize(glm::cross(axis, other)), v = glm::cross(axis, u);
            std::vector<glm::dvec3> normals;
            for (int i = 0; i < sides; ++i) {
                const double angle = 2.0 * M_PI * i / sides;
                normals.push_back(std::cos(angle) * u + std::sin(angle) * v);
            }
            // The edge of faces a and b lies at a + b scaled to its distance; in order of edges, 10 mm apart.
            std::vector<Photon> photons;
            std::vector<Seen> seen;
            for (int i = 0; i < sides; ++i) {
                const glm::dvec3 a = normals[i], b = normals[(i + 1) % sides];
                const glm::dvec3 edge = (a + b) * (10.0 / (1.0 + glm::dot(a, b)));
                const glm::dvec3 away = 10.0 * i * axis;
                const glm::dvec3 along_b = glm::cross(axis, b), along_a = -glm::cross(axis, a);
                photons.push_back({stored(edge + 2.0 * away + 0.05 * along_b), b});
                photons.push_back({stored(edge + 2.0 * away + 10.0 * axis + 0.05 * along_a), a});
                seen.push_back({stored(edge + 2.0 * away + 0.05 * along_a), a, white});
                seen.push_back({stored(edge + 2.0 * away + 10.0 * axis + 0.05 * along_b), b, white});
            }
            Bench bench(seen, photons, 1.0f);
            bench.run();
            const std::vector<FilmValue> film = bench.film();
            const bool counts = std::cos(2.0 * M_PI / sides) > STOKES_GATHER_MIN_COSINE;
            CAPTURE(sides);
            for (std::size_t i = 0; i < seen.size(); ++i)
                REQUIRE((film[STOKES_LAYER_SURFACE * seen.size() + i].x > 0.0f) == counts);
        }
}

TEST_CASE("emitters shine from their front, beside what they reflect; passes add up", "[gather][tiny]") {
    const glm::dvec3 up(0.0, 0.0, 1.0);
    std::vector<Seen> seen(4);
    for (Seen& s : seen) s = {{0.0, 0.0, 0.0}, up, black, 0};
    seen[1].from_behind = true;
    seen[2].missed = true;
    seen[3].material = white;
    Bench bench(seen, {{{0.0, 0.1, 0.0}, up}}, 1.0f);
    double direct = 0.0, reflected = 0.0;
    for (int k = 0; k < 16; ++k) {
        direct += emitted(k);
        reflected += spectrum(k) / (M_PI * M_PI);
    }
    for (int pass = 1; pass <= 2; ++pass) {
        bench.run();
        CHECK(bench.x(STOKES_MAP_SURFACE, 0) == Approx(pass * direct).epsilon(1e-5));
        CHECK(bench.x(STOKES_MAP_SURFACE, 1) == 0.0);
        CHECK(bench.x(STOKES_MAP_SURFACE, 2) == 0.0);
        CHECK(bench.x(STOKES_MAP_SURFACE, 3) == Approx(pass * (direct + reflected)).epsilon(1e-5));
    }
}

// Seen head on with probability 1 - R, R = ((eta - 1) / (eta + 1))^2.
TEST_CASE("smooth surfaces have the weight of their exit, and emit as much as others in the mean", "[gather][tiny]") {
    const glm::dvec3 up(0.0, 0.0, 1.0);
    std::vector<Seen> seen = {{{0.0, 0.0, 0.0}, up, smooth_translucent, 0},
                              {{0.0, 0.0, 0.0}, up, smooth_translucent},
                              {{0.0, 0.0, 0.0}, up, plain_translucent, 0}};
    seen.push_back(seen[0]);
    seen[3].from_behind = true;
    Bench bench(seen, {}, 1.0f);
    bench.collect();
    double emission = 0.0;
    for (int k = 0; k < 16; ++k) emission += emitted(k);
    const std::vector<GatherPoint> points = bench.points();
    CHECK(points[0].weight == exit_scale);
    CHECK(points[1].weight == exit_scale);
    CHECK(points[2].weight == 1.0f);
    CHECK(points[3].maps == 0u);
    CHECK(bench.x(STOKES_MAP_SURFACE, 0) == Approx(emission / (1.0 - 1.0 / 9.0)).epsilon(1e-5));
    CHECK(bench.x(STOKES_MAP_SURFACE, 1) == 0.0);
    CHECK(bench.x(STOKES_MAP_SURFACE, 2) == Approx(emission).epsilon(1e-5));
    CHECK(bench.x(STOKES_MAP_SURFACE, 3) == 0.0);
}

TEST_CASE("lights and materials of a kind that nobody knows are black", "[gather][tiny]") {
    const glm::dvec3 up(0.0, 0.0, 1.0);
    Bench bench({{{0.0, 0.0, 0.0}, up, unknown, 1}, {{0.0, 0.0, 0.0}, up, white, 0}}, {{{0.0, 0.0, 0.0}, up}}, 1.0f);
    bench.run();
    CHECK(bench.points()[0].maps == 0u);
    CHECK(bench.x(STOKES_MAP_SURFACE, 0) == 0.0);
    CHECK(bench.x(STOKES_MAP_SURFACE, 1) > 0.0);
}

// The bench's camera stands at the origin.
TEST_CASE("a point is seen directly where its ray starts at the camera", "[gather][tiny]") {
    const glm::dvec3 up(0.0, 0.0, 1.0);
    Bench bench({{{0.0, 0.0, -1.0}, up, white}, {{0.0, 1e-3, -1.0}, up, white}, {{0.0, 0.0, 0.0}, up, white}}, {},
                1.0f);
    bench.collect();
    const std::vector<GatherPoint> points = bench.points();
    CHECK(points[0].reflected == 0u);
    CHECK(points[1].reflected == 1u);
    CHECK(points[2].reflected == 1u);
}

TEST_CASE("a map without photons adds nothing", "[gather][tiny]") {
    Bench bench({{{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, white}}, {}, 1.0f);
    bench.run();
    for (const FilmValue& value : bench.film()) CHECK(value.x == 0.0f);
}

TEST_CASE("the film has the same bits for two work-group sizes", "[gather]") {
    std::vector<Photon> photons;
    std::vector<Seen> seen;
    random_surface(5000, 500, photons, seen);
    const std::size_t local_size = test_device().local_size();
    std::vector<std::vector<FilmValue>> films;
    for (std::size_t size : {std::size_t{16}, std::size_t{128}}) {
        test_device().set_local_size(size);
        Bench bench(seen, photons, 0.8f);
        bench.run();
        films.push_back(bench.film());
    }
    test_device().set_local_size(local_size);
    CHECK(std::memcmp(films[0].data(), films[1].data(), films[0].size() * sizeof(FilmValue)) == 0);
}
