#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "host/scene/mesh/mesh.hpp"
#include "host/scene/mesh/mesh_thickness.hpp"
#include "host/scene/mesh/mesh_topology.hpp"
#include "host/scene/mesh/shapes.hpp"
#include "host/scene/readers/mesh_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/file_meshes.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/test_scenes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

// Turned and moved so that no coordinate is round.
glm::dmat4 askew() {
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1.0, 2.0, -0.5)));
    return glm::translate(glm::dmat4(1.0), glm::dvec3(13.3, -7.1, 40.9)) * turned;
}

Mesh moved(Mesh mesh, const glm::dmat4& transform) {
    transform_mesh(mesh, transform);
    return mesh;
}

// Every triangle with vertices of its own.
Mesh unwelded(const Mesh& mesh) {
    Mesh result;
    for (const glm::uvec3& t : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(result.positions_mm.size());
        for (int k = 0; k < 3; ++k) result.positions_mm.push_back(mesh.positions_mm[t[k]]);
        result.triangles.push_back({first, first + 1, first + 2});
    }
    return result;
}

// All meshes in one body, translucent.
Scene scene_of(const std::vector<Mesh>& meshes) {
    Scene scene;
    scene.file = "s.json";
    scene.materials = {{"wax", TranslucentMaterial{0, {}, false}}};
    for (const Mesh& mesh : meshes) add_shape(scene, "thing " + std::to_string(scene.shapes.size()), 0, mesh).body = 0;
    scene.body_count = 1;
    return scene;
}

BodyTopology topology_of(const std::vector<Mesh>& meshes) { return body_topology(scene_of(meshes), 0); }

double thickness_of(const std::vector<Mesh>& meshes) { return median_thickness_mm(scene_of(meshes), 0); }

}  // namespace

TEST_CASE("A box is closed; its mean curvature is a quarter of pi times its twelve edges") {
    const BodyTopology box = topology_of({moved(make_box({2, 3, 4}), askew())});
    CHECK(box.kind == BodyKind::closed);
    CHECK(box.rim_edges == 0);
    CHECK(box.area_mm2 == Approx(52).epsilon(1e-5));
    CHECK(box.volume_mm3 == Approx(24).epsilon(1e-5));
    CHECK(box.mean_curvature_mm == Approx(4 * (2 + 3 + 4) * M_PI / 4).epsilon(1e-5));  // 90 degrees / 2 each
}

TEST_CASE("The mean curvature of a ball tends to 4 pi R, of a cylinder to pi h + pi^2 R") {
    CHECK(topology_of({make_sphere(10.0, 256)}).mean_curvature_mm == Approx(4 * M_PI * 10.0).epsilon(1e-3));
    // The side: h 2 pi R / (2 R); the two rims: 2 pi R each, bent by 90 degrees.
    const double cylinder = M_PI * 7.0 + M_PI * M_PI * 5.0;
    CHECK(topology_of({make_cylinder(5.0, 7.0, 512)}).mean_curvature_mm == Approx(cylinder).epsilon(1e-4));
}

TEST_CASE("Inside out, volume and mean curvature change their signs") {
    const BodyTopology ball = topology_of({turned_over(make_sphere(10.0, 256))});
    CHECK(ball.kind == BodyKind::closed);
    CHECK(ball.volume_mm3 == Approx(-4.0 / 3.0 * M_PI * 1000.0).epsilon(1e-3));
    CHECK(ball.mean_curvature_mm == Approx(-4 * M_PI * 10.0).epsilon(1e-3));
}

TEST_CASE("A hollow ball is closed: volumes and areas add up, the cavity bends the other way") {
    const BodyTopology shell = topology_of({make_sphere(10.0, 128), turned_over(make_sphere(9.0, 128))});
    CHECK(shell.kind == BodyKind::closed);
    CHECK(shell.volume_mm3 == Approx(4.0 / 3.0 * M_PI * (1000.0 - 729.0)).epsilon(5e-3));
    CHECK(shell.mean_curvature_mm == Approx(4 * M_PI * (10.0 - 9.0)).epsilon(1e-3));
}

TEST_CASE("Vertices are welded by place, in one mesh and between meshes") {
    CHECK(topology_of({unwelded(make_sphere(10.0, 32))}).kind == BodyKind::closed);
    Mesh lower = make_box({2, 3, 4}), upper = lower;
    upper.triangles.assign(lower.triangles.begin() + 5, lower.triangles.end());
    lower.triangles.resize(5);
    CHECK(topology_of({lower}).kind == BodyKind::open);
    const BodyTopology both = topology_of({lower, upper});
    CHECK(both.kind == BodyKind::closed);
    CHECK(both.volume_mm3 == Approx(24));
    CHECK(both.mean_curvature_mm == Approx(9 * M_PI));
}

TEST_CASE("Zero and minus zero are one place, in meshes too large to be mended") {
    Mesh grid;
    const std::uint32_t n = 60;
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t k = 0; k <= n; ++k) grid.positions_mm.push_back({float(i), 0.0F, -float(k)});
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t k = 0; k < n; ++k) {
            const std::uint32_t a = i * (n + 1) + k, b = a + n + 1;
            grid.triangles.push_back({a, b, b + 1});
            grid.triangles.push_back({a, b + 1, a + 1});
        }
    }
    Mesh pieces = unwelded(grid);
    for (std::size_t i = 0; i < pieces.positions_mm.size(); i += 2) pieces.positions_mm[i].y = -0.0F;
    const BodyTopology topology = topology_of({pieces});
    CHECK(topology.kind == BodyKind::flat);
    CHECK(topology.rim_edges == 4 * n);
}

TEST_CASE("A box of six separately placed rectangles is closed, though their corners differ by roundings") {
    const glm::dmat4 x = glm::rotate(glm::dmat4(1.0), M_PI / 2, glm::dvec3(1, 0, 0));
    const glm::dmat4 z = glm::rotate(glm::dmat4(1.0), M_PI / 2, glm::dvec3(0, 0, 1));
    const glm::dmat4 side = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 1.1, 0));
    std::vector<Mesh> faces;
    for (const glm::dmat4& turn : {glm::dmat4(1.0), x, x * x, x * x * x, z, z * z * z})
        faces.push_back(moved(make_rectangle(2.2, 2.2), askew() * turn * side));
    const BodyTopology box = topology_of(faces);
    CHECK(box.kind == BodyKind::closed);
    CHECK(box.volume_mm3 == Approx(2.2 * 2.2 * 2.2).epsilon(1e-5));
    CHECK(box.mean_curvature_mm == Approx(3 * M_PI * 2.2).epsilon(1e-5));
    faces.pop_back();
    const BodyTopology five = topology_of(faces);
    CHECK(five.kind == BodyKind::open);
    CHECK(five.rim_edges == 4);
}

TEST_CASE("A gap without width, where a triangle without height was dropped, leaves a body closed") {
    Mesh box = moved(make_box({2, 3, 4}), askew());
    // A vertex in the middle of an edge that only one of its two triangles has.
    const glm::uvec3 t = box.triangles[0];
    box.positions_mm.push_back(0.5F * (box.positions_mm[t.x] + box.positions_mm[t.y]));
    const auto middle = static_cast<std::uint32_t>(box.positions_mm.size()) - 1;
    box.triangles[0] = {t.x, middle, t.z};
    box.triangles.push_back({middle, t.y, t.z});
    const BodyTopology topology = topology_of({box});
    CHECK(topology.kind == BodyKind::closed);
    CHECK(topology.mean_curvature_mm == Approx(9 * M_PI).epsilon(1e-5));
    box.positions_mm.back() += glm::vec3(0.0F, 0.01F, 0.0F);
    CHECK(topology_of({box}).kind == BodyKind::open);
}

TEST_CASE("Boxes that touch along an edge or a face are closed, each with its own edges") {
    const Mesh box = make_box({2, 2, 2});
    for (const glm::dvec3& by : {glm::dvec3(2, 2, 0), glm::dvec3(2, 0, 0)}) {
        const BodyTopology both = topology_of({box, moved(box, by)});
        CHECK(both.kind == BodyKind::closed);
        CHECK(both.mean_curvature_mm == Approx(2 * 6 * M_PI));
    }
}

TEST_CASE("Triangles without area are ignored") {
    Mesh box = make_box({2, 3, 4});
    box.triangles.push_back({0, 0, 5});
    box.positions_mm.push_back(box.positions_mm[3]);
    box.triangles.push_back({3, 5, 8});
    CHECK(topology_of({box}).kind == BodyKind::closed);
}

TEST_CASE("A triangle too few or the wrong way round opens a mesh, and the place is told") {
    Mesh box = moved(make_box({2, 2, 2}), {10, 0, 0});
    box.triangles.erase(box.triangles.begin() + 2);  // of +x: 1, 3, 7
    const BodyTopology hole = topology_of({box});
    CHECK(hole.kind == BodyKind::open);
    CHECK(hole.rim_edges == 3);
    CHECK(hole.rim_mm.x == 11.0);
    CHECK(hole.volume_mm3 == 0.0);
    Mesh twisted = make_box({2, 2, 2});
    std::swap(twisted.triangles[4].y, twisted.triangles[4].z);
    CHECK(topology_of({twisted}).kind == BodyKind::open);
}

TEST_CASE("Sheets in one plane that face one way are flat, anywhere and however large") {
    CHECK(topology_of({make_rectangle(4, 6)}).kind == BodyKind::flat);
    CHECK(topology_of({moved(make_disk(300.0), askew())}).kind == BodyKind::flat);
    CHECK(topology_of(
              {moved(make_rectangle(4, 6), glm::translate(glm::dmat4(1.0), glm::dvec3(9000, 7000, 100)) * askew())})
              .kind == BodyKind::flat);
    const BodyTopology two = topology_of({make_rectangle(4, 6), moved(make_disk(1.0), {10, 0, 0})});
    CHECK(two.kind == BodyKind::flat);
    CHECK(two.area_mm2 == Approx(24 + mesh_area_mm2(make_disk(1.0))));
    CHECK(two.mean_curvature_mm == 0.0);
}

TEST_CASE("Steps, bends and sheets that face both ways are not flat") {
    CHECK(topology_of({make_rectangle(4, 6), moved(make_rectangle(4, 6), {9, 0.01, 0})}).kind == BodyKind::open);
    CHECK(topology_of({make_rectangle(4, 6), moved(turned_over(make_rectangle(1, 1)), {9, 0, 0})}).kind ==
          BodyKind::open);
    Mesh bent = make_rectangle(4, 6);
    bent.positions_mm[2].y = 0.01F;
    const BodyTopology bend = topology_of({bent});
    CHECK(bend.kind == BodyKind::open);
    CHECK(bend.mean_curvature_mm != 0.0);
}

TEST_CASE("The shipped dragon and bunny are closed") {
    for (const char* file : {"dragon_48k.ply", "bunny_closed.ply"}) {
        INFO(file);
        Mesh mesh = as_read(read_mesh(source_path("scenes/meshes/") + file));
        transform_mesh(mesh, glm::scale(askew(), glm::dvec3(270.0)));
        drop_degenerate_triangles(mesh);
        const BodyTopology topology = topology_of({mesh});
        CHECK(topology.kind == BodyKind::closed);
        CHECK(topology.volume_mm3 == Approx(mesh_volume_mm3(mesh)).epsilon(1e-6));
        CHECK(topology.area_mm2 == Approx(mesh_area_mm2(mesh)).epsilon(1e-6));
    }
}

TEST_CASE("Thickness: of a sheet its own, of a ball and a rod the diameter, of a shell the wall, however turned") {
    CHECK(thickness_of({moved(make_box({40, 3, 50}), askew())}) == Approx(3).epsilon(1e-5));
    CHECK(thickness_of({moved(make_sphere(10.0), askew())}) == Approx(20).epsilon(2e-3));
    CHECK(thickness_of({moved(make_cylinder(2.0, 80.0, 128), askew())}) == Approx(4).epsilon(2e-3));
    CHECK(thickness_of({make_sphere(10.0), turned_over(make_sphere(9.0))}) == Approx(1).epsilon(0.05));
    CHECK(thickness_of({make_box({7, 7, 7})}) == Approx(7));
    const Mesh sheet = make_rectangle(4, 6);
    CHECK(thickness_of({sheet, turned_over(sheet)}) == Approx(0).margin(1e-5));
}

TEST_CASE("Thickness: without limit where there is no other side") {
    CHECK(std::isinf(thickness_of({make_rectangle(4, 6)})));
    CHECK(std::isinf(thickness_of({turned_over(make_sphere(10.0))})));
    CHECK(thickness_of({make_rectangle(4, 6), moved(turned_over(make_rectangle(4, 6)), {0, -2, 0})}) == Approx(2));
    CHECK(std::isinf(thickness_of({})));
}

TEST_CASE("Walking needs closed or flat bodies") {
    CHECK(check_walkable(scene_of({make_box({1, 2, 3})})) == std::vector<BodyKind>{BodyKind::closed});
    CHECK(check_walkable(scene_of({make_rectangle(1, 2)})) == std::vector<BodyKind>{BodyKind::flat});
    const auto error = [](const std::vector<Mesh>& meshes) {
        const Scene scene = scene_of(meshes);
        return input_error([&] { check_walkable(scene); });
    };
    const std::string expects =
        "s.json: shape \"thing 0\": transport \"walk\" expects a closed mesh or a flat sheet, got ";
    Mesh box = make_box({2, 2, 2});
    box.triangles.resize(2);  // -x
    box.triangles.push_back({1, 3, 7});
    CHECK_THAT(error({box}), Contains(expects + "7 edges without a neighbour, one at ("));
    CHECK(error({turned_over(make_sphere(3.0))}) == expects + "one that faces inward");
    CHECK(error({make_rectangle(1, 2), turned_over(make_rectangle(1, 2))}) == expects + "one without a volume");
}

TEST_CASE("Walking asks nothing of bodies without subsurface light") {
    Mesh open = make_box({2, 2, 2});
    open.triangles.pop_back();
    Scene scene = scene_of({open});
    scene.materials[0].kind = TranslucentMaterial{};
    CHECK(check_walkable(scene) == std::vector<BodyKind>{BodyKind::open});
    scene.materials[0].kind = DiffuseMaterial{};
    CHECK(check_walkable(scene) == std::vector<BodyKind>{BodyKind::open});
}
