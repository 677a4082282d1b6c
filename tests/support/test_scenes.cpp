#include "tests/support/test_scenes.hpp"

#include <cmath>

#include "host/scene/mesh/mesh.hpp"
#include "host/scene/mesh/shapes.hpp"

namespace stokes {

namespace {

Fluorophore dot_like() {
    Fluorophore fluorophore;
    fluorophore.name = "dot";
    fluorophore.excitation = {{300.0, 400.0, 540.0}, {1.0, 0.6, 0.0}, Outside::zero};
    fluorophore.emission = {{500.0, 545.0, 600.0}, {0.0, 1.0, 0.0}, Outside::zero};
    return fluorophore;
}

Medium marble_green() {
    Medium medium;
    medium.name = "marble";
    medium.sigma_s = {{300.0, 795.0}, {1.5, 1.1}, Outside::hold};
    medium.sigma_a = Spectrum::constant(0.0041);
    medium.eta = 1.5;
    return medium;
}

Material translucent(double fraction) { return {"translucent", TranslucentMaterial{0, {{0, fraction}}, false}}; }

}  // namespace

TranslucentMaterial& translucent_of(Scene& scene, std::size_t material) {
    return std::get<TranslucentMaterial>(scene.materials[material].kind);
}

Material diffuse_material(double reflectance) {
    return {"diffuse", DiffuseMaterial{Spectrum::constant(reflectance), nullptr, Spectrum::constant(0.0)}};
}

Shape& add_shape(Scene& scene, const std::string& name, int material, const Mesh& mesh) {
    Shape& shape = scene.shapes.emplace_back();
    shape.name = name;
    shape.material = material;
    shape.body = scene.body_count++;
    shape.mesh = mesh;
    return shape;
}

Mesh moved(Mesh mesh, const glm::dvec3& by_mm) {
    for (glm::vec3& p : mesh.positions_mm) p += glm::vec3(by_mm);
    return mesh;
}

Mesh turned_over(Mesh mesh) {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    return mesh;
}

Scene empty_scene(const std::string& name) {
    Scene scene;
    scene.file = name;
    scene.render.wavelengths = Wavelengths::uniform;
    scene.render.emission = Emission::stratified;
    return scene;
}

Scene furnace_scene(double reflectance) {
    Scene scene = empty_scene("furnace");
    scene.materials = {diffuse_material(reflectance)};
    Shape& wall = add_shape(scene, "wall", 0, turned_over(make_sphere(100.0, 64)));
    wall.light = 0;
    scene.lights = {{"wall", Spectrum::constant(M_PI * mesh_area_mm2(wall.mesh) * 1e-6), SurfaceLight{0}}};
    scene.camera.position_mm = {20.0, -10.0, 5.0};
    scene.camera.target_mm = {-30.0, 40.0, 10.0};
    scene.film = {16, 16, {}};
    scene.render.photons_per_pass = 100000;
    return scene;
}

Scene slab_scene(double fluorescent_fraction, double angle_deg, Transport transport) {
    Scene scene = empty_scene("slab");
    scene.render.transport = transport;
    scene.media = {marble_green()};
    scene.fluorophores = {dot_like()};
    scene.materials = {translucent(fluorescent_fraction)};
    add_shape(scene, "slab", 0, make_rectangle(2000.0, 2000.0));
    const double angle = angle_deg * M_PI / 180.0;
    DiskBeam beam;
    beam.direction = {std::sin(angle), -std::cos(angle), 0.0};
    beam.position_mm = -50.0 * beam.direction;
    beam.half_u_mm = {0.0, 0.0, 1.0};
    beam.half_v_mm = glm::cross(beam.direction, beam.half_u_mm);
    scene.lights = {{"beam", {{300.0, 500.0, 780.0}, {3e-3, 1e-3, 2e-3}, Outside::zero}, beam}};
    scene.camera.position_mm = {0.0, 100.0, 1.0};
    scene.camera.target_mm = {0.0, 0.0, 0.0};
    scene.film = {8, 8, {}};
    scene.render.photons_per_pass = 65536;
    return scene;
}

Scene small_scene(Transport transport) {
    Scene scene = empty_scene("small");
    scene.render.transport = transport;
    scene.media = {marble_green()};
    scene.fluorophores = {dot_like()};
    scene.materials = {diffuse_material(0.7), translucent(0.5), Material{}};
    add_shape(scene, "floor", 0, make_rectangle(120.0, 120.0));
    add_shape(scene, "ball", 1, moved(make_sphere(15.0, 48), {0.0, 15.0, 0.0}));
    Mesh lamp = make_disk(20.0, 32);
    for (glm::vec3& p : lamp.positions_mm) p = {p.x, 90.0f - p.y, -p.z};
    add_shape(scene, "lamp", 2, lamp).light = 0;
    const Spectrum flux = {{300.0, 360.0, 420.0, 780.0}, {0.0, 1e-2, 1e-3, 1e-3}, Outside::zero};
    scene.lights = {{"lamp", flux, SurfaceLight{2}}};
    scene.camera.position_mm = {0.0, 60.0, 110.0};
    scene.camera.target_mm = {0.0, 12.0, 0.0};
    scene.film = {32, 24, {}};
    scene.render.photons_per_pass = 8192;
    scene.render.passes = 2;
    return scene;
}

}  // namespace stokes
