#include <algorithm>
#include <cmath>
#include <random>

#include "host/scene/mesh/mesh.hpp"
#include "host/scene/readers/mask.hpp"
#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/png_bytes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

// The triangles of a mask come in pairs; each is an upright rectangle.
struct Rectangle {
    double x0, x1, z0, z1;
    bool holds(double x, double z) const { return x > x0 && x < x1 && z > z0 && z < z1; }
};

std::vector<Rectangle> rectangles_of(const Mesh& mesh) {
    std::vector<Rectangle> rectangles;
    for (std::size_t i = 0; i < mesh.positions_mm.size(); i += 4) {
        const glm::vec3 low = mesh.positions_mm[i], high = mesh.positions_mm[i + 2];
        rectangles.push_back({low.x, high.x, low.z, high.z});
    }
    return rectangles;
}

Picture noise(int width, int height, double dark, unsigned seed) {
    std::mt19937 random(seed);
    Picture picture{width, height, {}, {}};
    for (int i = 0; i < width * height; ++i)
        picture.luminance.push_back(std::uniform_real_distribution<double>()(random) < dark ? 0.0f : 1.0f);
    return picture;
}

}  // namespace

TEST_CASE("A mask covers the dark texels and their common edges, and nothing of the others") {
    for (const double dark : {0.1, 0.5, 0.9}) {
        const Picture picture = noise(23, 17, dark, 7);
        const Mesh mesh = make_mask(picture, 23, 17, {});
        REQUIRE(mesh.positions_mm.size() == 2 * mesh.triangles.size());
        const auto rectangles = rectangles_of(mesh);
        const auto is_dark = [&](double x, double z) {
            return picture.luminance[static_cast<std::size_t>(std::floor(z) * 23 + std::floor(x))] == 0.0f;
        };
        // On a lattice of eighths of a texel, so that edges and corners are tried too: a place is inside a
        // rectangle where all the texels that touch it are dark, and in none where all are bright.
        int wrong = 0;
        for (int i = 1; i < 8 * 23; ++i)
            for (int j = 1; j < 8 * 17; ++j) {
                const double x = i / 8.0, z = j / 8.0, hair = 1e-3;
                int dark_around = 0;
                for (const double dx : {-hair, hair})
                    for (const double dz : {-hair, hair}) dark_around += is_dark(x + dx, z + dz) ? 1 : 0;
                const bool covered = std::any_of(rectangles.begin(), rectangles.end(),
                                                 [&](const Rectangle& r) { return r.holds(x - 11.5, z - 8.5); });
                if (dark_around == 4) wrong += !covered;
                if (dark_around < 4 && i % 8 != 0 && j % 8 != 0) wrong += covered;
                if (dark_around == 0) wrong += covered;
            }
        CHECK(wrong == 0);
    }
}

TEST_CASE("Texels of one height and width join to one rectangle") {
    Picture picture{4, 3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {}};
    const auto rectangles = rectangles_of(make_mask(picture, 8, 3, {}));
    REQUIRE(rectangles.size() == 1);
    CHECK(rectangles[0].x0 == -4.0);
    CHECK(rectangles[0].x1 == 2.0);
    CHECK((rectangles[0].z0 == -1.5 && rectangles[0].z1 == 1.5));
    CHECK(make_mask({2, 1, {0, 0}, {}}, 1, 1, {}).triangles.size() == 2);
}

TEST_CASE("The picture's top left corner is at -x and -z, as one sees it from above with -z ahead") {
    const auto rectangles = rectangles_of(make_mask({3, 2, {0, 1, 1, 1, 1, 1}, {}}, 3, 2, {}));
    REQUIRE(rectangles.size() == 1);
    CHECK(rectangles[0].holds(-1.25, -0.75));
    const auto mesh = make_mask({1, 1, {0}, {}}, 2, 2, {});
    const glm::vec3 a = mesh.positions_mm[0], b = mesh.positions_mm[1], c = mesh.positions_mm[2];
    CHECK(glm::cross(b - a, c - a).y > 0.0f);
}

TEST_CASE("The threshold is on the linear luminance, and inversion keeps what is transparent open") {
    const Picture picture{4, 1, {0.49f, 0.5f, 0.0f, 1.0f}, {1, 1, 0, 0}};
    const auto opaque = [&](const MaskTexels& texels) {
        const auto rectangles = rectangles_of(make_mask(picture, 4, 1, texels));
        std::string result;
        for (int i = 0; i < 4; ++i)
            result += std::any_of(rectangles.begin(), rectangles.end(),
                                  [&](const Rectangle& r) { return r.holds(i - 1.5, 0); })
                          ? '#'
                          : '.';
        return result;
    };
    CHECK(opaque({}) == "#...");
    CHECK(opaque({0.6, false}) == "##..");
    CHECK(opaque({0.5, true}) == ".#..");
    CHECK(opaque({0.1, true}) == "##..");
}

TEST_CASE("Masks without an opaque texel or of too many triangles are refused") {
    CHECK(input_error([] {
              make_mask({1, 1, {1}, {}}, 1, 1, {});
          }) == "expected a picture with an opaque texel, found none");
    const Picture checker = [] {
        Picture p{2048, 2048, {}, {}};
        for (int i = 0; i < 2048 * 2048; ++i) p.luminance.push_back(static_cast<float>((i + i / 2048) % 2));
        return p;
    }();
    CHECK_THAT(input_error([&] { make_mask(checker, 1, 1, {}); }), Contains("more than 2000000 triangles"));
}

TEST_CASE("A scene's mask: read, two-sided, and its mistakes named") {
    const TemporaryFolder folder;
    put_file(folder.file("m.png"), drawn_png({"#..", "##."}));
    put_file(folder.file("bright.png"), drawn_png({".."}));
    const auto scene = [&](const std::string& rest, const std::string& material = "black") {
        const std::string text =
            R"({"format": "stokes-scene", "version": 1, "camera": {"position_mm": [0, 9, 9], "target_mm": [0, 0, 0]},
"materials": {"black": {"type": "black"}, "glow": {"type": "translucent", "medium": "m"}},
"media": {"m": {"sigma_s_per_mm": 1, "sigma_a_per_mm": 1}},
"lights": [{"type": "sphere", "center_mm": [0, 9, 0], "radius_mm": 1, "spectrum": 1, "power_W": 1}],
"shapes": [{"type": "mask", "material": ")" +
            material + R"(", "width_mm": 3, "height_mm": 2, )" + rest + "}]}";
        return parse_scene(text, folder.file("s.json"));
    };
    const Scene good = scene(R"("file": "m.png", "transform": [{"translate_mm": [5, 0, 0]}])");
    CHECK(good.shapes[0].two_sided);
    CHECK_FALSE(good.shapes[1].two_sided);
    CHECK(mesh_bounds(good.shapes[0].mesh).low_mm == glm::dvec3(3.5, 0, -1));
    const auto error = [&](const std::string& rest, const std::string& material = "black") {
        return input_error([&] { scene(rest, material); }).substr(folder.path().size() + 1);
    };
    CHECK_THAT(error(R"("file": "no.png")"),
               Contains("s.json:5: shapes[0].file: ") && Contains("cannot read: No such file"));
    CHECK(error(R"("file": "s.png", "treshold": 1)") ==
          "s.json:5: shapes[0]: unknown key \"treshold\"; did you mean \"threshold\"?");
    CHECK(error(R"("file": "m.png", "threshold": 0)") ==
          "s.json:5: shapes[0].threshold: expected a number in (0, 1], got 0");
    CHECK(error(R"("file": "bright.png")") ==
          "s.json:5: shapes[0].file: expected a picture with an opaque texel, found none");
    CHECK(error(R"("file": "m.png")", "glow") ==
          "s.json:5: shapes[0].material: expected a black or diffuse material for a mask, got a translucent "
          "one");
}
