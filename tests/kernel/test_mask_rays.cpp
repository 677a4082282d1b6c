// Masks against rays: opaque texels stop every one, open ones none, from both sides.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "host/render/device_scene.hpp"
#include "host/scene/mesh/mesh.hpp"
#include "host/scene/readers/mask.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/file_meshes.hpp"
#include "tests/support/traced_scene.hpp"

using namespace stokes;

namespace {

constexpr int columns = 96, rows = 64;

Picture noise(double dark) {
    std::mt19937 random(21);
    std::uniform_real_distribution<double> uniform;
    Picture picture{columns, rows, {}, {}};
    for (int i = 0; i < columns * rows; ++i) picture.luminance.push_back(uniform(random) < dark ? 0.0f : 1.0f);
    return picture;
}

// Turned and moved at will: edges that met on one line before meet there to rounding only.
glm::dmat4 placement() {
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(0.3, 1.0, -0.4)));
    return glm::translate(glm::dmat4(1.0), glm::dvec3(31.0, -17.0, 55.0)) * turned;
}

struct Aim {
    std::vector<Ray> rays;
    std::vector<bool> opaque;  // what the ray meets
};

// Rays of random directions from both sides to random places of the mask, every other one to the seams
// between texels; places within 1e-3 texels of both kinds of texel are left out.
Aim aim_at(const Picture& picture, int count) {
    std::mt19937 random(22);
    std::uniform_real_distribution<double> uniform;
    std::normal_distribution<double> normal;
    Aim aim;
    const glm::dmat4 to_world = placement();
    while (static_cast<int>(aim.rays.size()) < count) {
        double x = uniform(random) * columns, z = uniform(random) * rows;
        if (aim.rays.size() % 2) (random() % 2 ? x : z) = std::round(random() % 2 ? x : z);
        int dark = 0, bright = 0;
        for (const double dx : {-1e-3, 1e-3})
            for (const double dz : {-1e-3, 1e-3}) {
                const double i = std::floor(x + dx), j = std::floor(z + dz);
                const bool outside = i < 0 || j < 0 || i >= columns || j >= rows;
                const bool is_bright = outside || picture.luminance[static_cast<std::size_t>(j * columns + i)] > 0.5f;
                ++(is_bright ? bright : dark);
            }
        if (dark != 0 && bright != 0) continue;
        const glm::dvec3 at(to_world * glm::dvec4(x - 0.5 * columns, 0, z - 0.5 * rows, 1));
        const glm::dvec3 d = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        if (std::abs(glm::dot(d, glm::dvec3(to_world[1]))) < 0.02) continue;
        aim.rays.push_back(make_ray(glm::vec3(at - d * (20.0 + 60.0 * uniform(random))), glm::vec3(d)));
        aim.opaque.push_back(dark != 0);
    }
    return aim;
}

std::vector<Triangle> triangles_of(const Picture& picture) {
    Scene scene;
    Shape shape;
    shape.body = shape.material = 0;
    scene.body_count = 1;
    scene.materials = {{"black", BlackMaterial{}}};
    shape.two_sided = true;
    shape.mesh = make_mask(picture, columns, rows, {});
    transform_mesh(shape.mesh, placement());
    scene.shapes = {shape};
    return scene_triangles(scene, find_contacts(scene, 0.0));
}

}  // namespace

TEST_CASE("Of a million rays none slips between the rectangles of a mask, and none is stopped in the open") {
    for (const double dark : {0.45, 0.9}) {
        const Picture picture = noise(dark);
        const Aim aim = aim_at(picture, 500000);
        Traced traced(triangles_of(picture));
        const auto hits = traced.closest(aim.rays);
        int opaque = 0, slipped = 0, stopped = 0;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            const bool hit = hits[i].triangle != STOKES_NONE;
            opaque += aim.opaque[i];
            slipped += aim.opaque[i] && !hit;
            stopped += !aim.opaque[i] && hit;
        }
        CHECK(opaque > 100000);
        CHECK(slipped == 0);
        CHECK(stopped == 0);
    }
}
