#include <map>
#include <set>

#include "host/render/pass_spectra.hpp"
#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/known_light.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/triangle_meshes.hpp"

using namespace stokes;

namespace {

glm::dvec2 chromaticity(const glm::dvec3& xyz) { return glm::dvec2(xyz) / (xyz.x + xyz.y + xyz.z); }

double angle_about(const glm::dvec2& white, const glm::dvec2& xy) { return std::atan2(xy.y - white.y, xy.x - white.x); }

// The wavelength [nm] whose chromaticity lies on the ray from the white of D65 through xy; 0 where that ray
// ends on the line of purples.
double dominant_wavelength(const glm::dvec2& xy) {
    const glm::dvec2 white = chromaticity(xyz_of(cie_spectrum("illuminants_1nm.csv", "D65")));
    const auto locus = [](int nm) {
        return chromaticity({cie1931().x.at(nm), cie1931().y.at(nm), cie1931().z.at(nm)});
    };
    const double angle = angle_about(white, xy);
    for (int nm = 380; nm < 700; ++nm) {
        const double a = std::remainder(angle_about(white, locus(nm)) - angle, 2.0 * M_PI);
        const double b = std::remainder(angle_about(white, locus(nm + 1)) - angle, 2.0 * M_PI);
        if (a >= 0.0 && b < 0.0 && a - b < M_PI) return nm + a / (a - b);  // the locus runs clockwise
    }
    return 0.0;
}

// What the middle of each pixel sees.
struct SeenPoint {
    int shape = -1;
    glm::dvec3 normal{0.0};
};

std::vector<SeenPoint> seen_points(const Scene& scene) {
    const Device& device = test_device();
    const DeviceScene on_device(device, scene);
    CameraView view(device, make_camera_record(scene.camera, scene.film.width, scene.film.height));
    const CameraRecord& c = view.camera();
    std::vector<Ray> rays;
    for (std::uint32_t y = 0; y < c.height; ++y)
        for (std::uint32_t x = 0; x < c.width; ++x) {
            const float u = static_cast<float>(x) + 0.5f, v = static_cast<float>(y) + 0.5f;
            const glm::vec3 d = glm::normalize(glm::vec3(c.corner_x + u * c.right_x + v * c.down_x,
                                                         c.corner_y + u * c.right_y + v * c.down_y,
                                                         c.corner_z + u * c.right_z + v * c.down_z));
            rays.push_back({c.position_x, c.position_y, c.position_z, 0.0f, d.x, d.y, d.z, 1e30f});
        }
    const auto count = static_cast<std::uint32_t>(rays.size());
    const Buffer<Ray> ray_buffer(device, "rays", rays);
    const Buffer<Hit> hits(device, "hits", count);
    on_device.rays.kernels.program(device, "trace_rays.cl")
        .kernel("trace_closest_all")
        .launch(count,
                Arguments().add("n", count).add(on_device.rays.arguments()).add("rays", ray_buffer).add("hits", hits));
    const std::vector<Triangle> triangles = on_device.triangles.download();
    std::vector<SeenPoint> points;
    for (const Hit& hit : hits.download()) {
        points.emplace_back();
        if (hit.triangle == STOKES_NONE) continue;
        const Triangle& t = triangles[hit.triangle];
        points.back().shape = static_cast<int>(t.shape);
        points.back().normal = normal_of(t);
    }
    return points;
}

// Pixels whose eight neighbours see the same shape, so that every ray of theirs meets it.
std::vector<std::size_t> inside(const std::vector<SeenPoint>& points, const Scene& scene, int shape) {
    const int width = scene.film.width, height = scene.film.height;
    std::vector<std::size_t> found;
    for (int y = 1; y + 1 < height; ++y)
        for (int x = 1; x + 1 < width; ++x) {
            bool all = true;
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i)
                    all = all && points[static_cast<std::size_t>((y + j) * width + x + i)].shape == shape;
            if (all) found.push_back(static_cast<std::size_t>(y * width + x));
        }
    return found;
}

glm::dvec3 mean_of(const FilmImage& image, Layer layer, const std::vector<std::size_t>& at) {
    const std::vector<float>& xyz = image.xyz[static_cast<std::size_t>(layer)];
    glm::dvec3 sum(0.0);
    for (const std::size_t i : at) sum += glm::dvec3(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
    return sum / static_cast<double>(at.size());
}

// The light that the dots under the lamp emit in a pass, at the pass's wavelengths: eq. 1-2 with pair
// weights.
glm::dvec3 emitted_by_lamp(const Scene& scene, const Fluorophore& dots, std::uint32_t pass) {
    const WavelengthSet set = wavelengths_of(scene, pass);
    return film_xyz(scene, set, [&](std::size_t em) {
        double sum = 0.0;
        for (std::size_t ex = 0; ex < em; ++ex)
            sum += scene.lights[0].flux.at(set[ex]) * dots.excitation.at(set[ex]) * dots.emission.at(set[em]);
        return sum;
    });
}

constexpr std::uint32_t passes = 192;

Scene prisms() {
    Scene scene = read_scene(source_path("scenes/prisms.json"));
    scene.film = {96, 72, {}};
    scene.render.photons_per_pass = 12000;
    scene.render.radius_mm = 9.0;
    return scene;
}

const FilmImage& picture_of_prisms() {
    static const FilmImage picture = [] {
        Renderer renderer(test_device(), prisms());
        for (std::uint32_t pass = 0; pass < passes; ++pass) renderer.render_pass(pass);
        return renderer.image();
    }();
    return picture;
}

// Of the light that the dots give back under the lamp, and of the lamp's own, at the wavelengths of the
// passes.
glm::dvec2 glow_chromaticity(const Scene& scene, const Fluorophore& dots) {
    glm::dvec3 sum(0.0);
    for (std::uint32_t pass = 0; pass < passes; ++pass) sum += emitted_by_lamp(scene, dots, pass);
    return chromaticity(sum);
}
glm::dvec2 lamp_chromaticity(const Scene& scene) {
    glm::dvec3 sum(0.0);
    for (std::uint32_t pass = 0; pass < passes; ++pass) sum += film_xyz(scene, pass, scene.lights[0].flux);
    return chromaticity(sum);
}

}  // namespace

TEST_CASE("wavelengths are dominant in their own light", "[hue]") {
    for (const double nm : {430.0, 470.0, 500.0, 545.0, 580.0, 610.0}) {
        const Spectrum line = {{nm - 1.0, nm, nm + 1.0}, {0.0, 1.0, 0.0}, Outside::zero};
        CHECK(dominant_wavelength(chromaticity(xyz_of(line))) == Approx(nm).margin(1.0));
    }
    CHECK(dominant_wavelength({0.33, 0.15}) == 0.0);  // a purple
}

// The chromaticity of each prism's fluorescence is that of its dots' emission column in the shipped table,
// under cie1931(). In passes of sixteen wavelengths it is that of the emission where the passes sampled it:
// the expectation from the lamp's light and the passes' own wavelengths. What remains is light that was
// re-radiated more than once, by other dots too, which moves the emission's short side: 0.015 in x and y.
TEST_CASE("the prisms glow in the colours of their quantum dots", "[hue]") {
    const Scene scene = prisms();
    const FilmImage& image = picture_of_prisms();
    const std::vector<SeenPoint> points = seen_points(scene);
    std::set<std::string> checked;
    for (std::size_t s = 0; s < scene.shapes.size(); ++s) {
        const Material& material = scene.materials[static_cast<std::size_t>(scene.shapes[s].material)];
        const std::vector<std::size_t> pixels = inside(points, scene, static_cast<int>(s));
        CAPTURE(scene.shapes[s].name, pixels.size());
        if (const TranslucentMaterial* translucent = as_translucent(material)) {
            REQUIRE(pixels.size() >= 10);
            const glm::dvec2 seen = chromaticity(mean_of(image, Layer::fluorescence, pixels));
            std::map<double, std::string> by_distance;
            for (const Fluorophore& dots : scene.fluorophores)
                by_distance[glm::length(seen - chromaticity(xyz_of(dots.emission)))] = dots.name;
            const Fluorophore& own =
                scene.fluorophores[static_cast<std::size_t>(translucent->dyes.front().fluorophore)];
            const glm::dvec2 expected = glow_chromaticity(scene, own), emission = chromaticity(xyz_of(own.emission));
            CAPTURE(seen.x, seen.y, expected.x, expected.y, emission.x, emission.y, dominant_wavelength(seen),
                    dominant_wavelength(emission));
            CHECK(by_distance.begin()->second == own.name);
            CHECK(std::abs(seen.x - expected.x) < 0.015);
            CHECK(std::abs(seen.y - expected.y) < 0.015);
            CHECK(dominant_wavelength(seen) == Approx(dominant_wavelength(emission)).margin(4.0));
            checked.insert(scene.shapes[s].name);
        }
    }
    CHECK(checked.size() == 6);
}

// White things face the lamp, whose visible part is the violet end of its spectrum, and stand on prisms whose
// glow they catch: the surface layer's chromaticity lies on the line from that of the lamp to that of the
// dots below, as mixtures of two do; 0.04 aside allows for the glow of the other prisms. The spheres, which
// turn away from theirs, stay violet.
TEST_CASE("white things are violet in the lamp's light and tinted by the prism below", "[hue]") {
    const Scene scene = prisms();
    const FilmImage& image = picture_of_prisms();
    const std::vector<SeenPoint> points = seen_points(scene);
    const glm::dvec2 lamp = lamp_chromaticity(scene);
    CHECK(dominant_wavelength(lamp) < 440.0);
    std::size_t checked = 0;
    for (std::size_t s = 0; s < scene.shapes.size(); ++s) {
        const std::string& name = scene.shapes[s].name;
        if (scene.materials[static_cast<std::size_t>(scene.shapes[s].material)].name != "white") continue;
        std::vector<std::size_t> lit;
        for (const std::size_t i : inside(points, scene, static_cast<int>(s)))
            if (glm::dot(points[i].normal, -std::get<DiskBeam>(scene.lights[0].kind).direction) > 0.6) lit.push_back(i);
        CAPTURE(name, lit.size());
        REQUIRE(lit.size() >= 3);
        const bool sphere = name.find("sphere") != std::string::npos;
        const bool dragon = name.find("dragon") != std::string::npos;
        const Fluorophore& below = scene.fluorophores[sphere ? 0 : dragon ? 1 : 2];
        const glm::dvec2 seen = chromaticity(mean_of(image, Layer::surface, lit));
        const glm::dvec2 glow = glow_chromaticity(scene, below), along = glow - lamp;
        const double share = glm::dot(seen - lamp, along) / glm::dot(along, along);
        const double aside = glm::length(seen - lamp - share * along);
        CAPTURE(seen.x, seen.y, lamp.x, lamp.y, glow.x, glow.y, share, aside, dominant_wavelength(seen));
        CHECK(aside < 0.04);
        CHECK(share > -0.02);
        CHECK(share < 0.8);
        if (sphere) {
            CHECK(dominant_wavelength(seen) > 0.0);
            CHECK(dominant_wavelength(seen) < 460.0);
            CHECK(mean_of(image, Layer::fluorescence, lit) == glm::dvec3(0.0));
        }
        ++checked;
    }
    CHECK(checked == 6);
}
