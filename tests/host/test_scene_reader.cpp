#include <cmath>

#include "host/scene/mesh/mesh.hpp"
#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

const std::string base = R"({
  "format": "stokes-scene", "version": 1, "transport": "paper",
  "render": {"passes": 4, "photons_per_pass": 1000, "alpha": 0.5, "radius_mm": 2, "seed": 9},
  "film": {"width": 8, "height": 6, "exposure_ev": 1.5},
  "camera": {"position_mm": [0, 0, 50], "target_mm": [0, 0, 0], "up": [0, 2, 0], "vertical_fov_deg": 30},
  "spectra": {"lamp": {"pairs": [[300, 0], [400, 2]]}},
  "media": {"stone": {"sigma_s_per_mm": 2, "scale_sigma_s": 0.5, "sigma_a_per_mm": {"constant": 0.1}, "eta": 1.5}},
  "fluorophores": {"dye": {"excitation": {"pairs": [[300, 1], [400, 0]]}, "emission": {"pairs": [[500, 1]]}}},
  "materials": {
    "floor": {"type": "diffuse", "reflectance": {"pairs": [[400, 0.2], [500, 0.6]]}},
    "glow": {"type": "translucent", "medium": "stone", "fluorophore": "dye", "fluorescent_fraction": 0.5}
  },
  "lights": [
    {"type": "disk", "center_mm": [0, 100, 0], "normal": [0, -1, 0], "radius_mm": 10, "spectrum": "lamp", "power_W": 5}
  ],
  "shapes": [
    {"type": "sphere", "material": "glow", "radius_mm": 10, "segments": 16}
  ]
})";

std::string with(const std::string& what, const std::string& replacement) {
    const std::size_t at = base.find(what);
    if (at == std::string::npos) throw std::logic_error("not in the scene: " + what);
    return std::string(base).replace(at, what.size(), replacement);
}

Scene scene_with(const std::string& what, const std::string& replacement) {
    return parse_scene(with(what, replacement), "s.json");
}

}  // namespace

TEST_CASE("A camera shows the whole picture, or the window that the scene says") {
    const Crop whole = parse_scene(base, "s.json").camera.crop;
    CHECK((whole.left == 0.0 && whole.top == 0.0 && whole.width == 1.0 && whole.height == 1.0));
    const Crop crop =
        scene_with("\"vertical_fov_deg\": 30", R"("crop": {"left": 0.7, "top": 0.25, "width": 0.3, "height": 0.125})")
            .camera.crop;
    CHECK((crop.left == 0.7 && crop.top == 0.25 && crop.width == 0.3 && crop.height == 0.125));
}

TEST_CASE("A scene's settings, media and materials arrive as written") {
    const Scene scene = parse_scene(base, "s.json");
    CHECK(scene.file == "s.json");
    CHECK(scene.render.passes == 4);
    CHECK(scene.render.photons_per_pass == 1000);
    CHECK(scene.render.alpha == 0.5);
    CHECK(scene.render.sampling == Sampling::best);
    CHECK_FALSE(scene.render.branches);
    CHECK_FALSE(scene.render.exits);
    CHECK_FALSE(scene.render.wavelengths);
    CHECK(scene.render.radius_mm == 2.0);
    CHECK(scene.render.seed == 9);
    CHECK(scene.film.width == 8);
    CHECK(scene.film.height == 6);
    CHECK(scene.film.exposure_ev == 1.5);
    CHECK(scene.camera.position_mm == glm::dvec3(0, 0, 50));
    CHECK(scene.camera.up == glm::dvec3(0, 1, 0));
    CHECK(scene.camera.vertical_fov_deg == 30);
    REQUIRE(scene.media.size() == 1);
    CHECK(scene.media[0].sigma_s.at(777) == 1.0);
    CHECK(scene.media[0].sigma_a.at(777) == 0.1);
    CHECK(scene.media[0].eta == 1.5);
    CHECK(scene.media[0].dipole_eta == 1.0);
    REQUIRE(scene.fluorophores.size() == 1);
    CHECK(scene.fluorophores[0].conversion == 0.02);
    CHECK(scene.fluorophores[0].excitation.at(350) == Approx(0.5));
    CHECK(scene.fluorophores[0].excitation.at(299) == 0.0);
    REQUIRE(scene.materials.size() == 3);
    const auto& diffuse = std::get<DiffuseMaterial>(scene.materials[0].kind);
    CHECK(diffuse.reflectance.at(450) == Approx(0.4));
    CHECK(diffuse.reflectance.at(700) == 0.6);
    const auto& translucent = std::get<TranslucentMaterial>(scene.materials[1].kind);
    CHECK(translucent.medium == 0);
    REQUIRE(translucent.dyes.size() == 1);
    CHECK((translucent.dyes[0].fluorophore == 0 && translucent.dyes[0].fraction == 0.5));
    CHECK(std::holds_alternative<BlackMaterial>(scene.materials[2].kind));
}

TEST_CASE("A scene names its transport, or gets the one that conserves energy") {
    CHECK(parse_scene(base, "s.json").render.transport == Transport::paper);
    CHECK(scene_with("\"paper\"", "\"conserving\"").render.transport == Transport::conserving);
    CHECK(scene_with("\"paper\"", "\"walk\"").render.transport == Transport::walk);
    CHECK(scene_with(", \"transport\": \"paper\"", "").render.transport == Transport::conserving);
}

TEST_CASE("Branches and exits are as the scene says, or by its sampling and transport") {
    const auto render = [](const std::string& settings) {
        return scene_with("\"seed\": 9", "\"seed\": 9" + settings).render;
    };
    RenderSettings none = render("");
    none.transport = Transport::conserving;
    CHECK(resolved(none).branches == Branches::both);
    CHECK(resolved(none).exits == 1);
    none.transport = Transport::paper;
    CHECK(resolved(none).branches == Branches::roulette);
    CHECK(resolved(render(R"(, "sampling": "plain")")).branches == Branches::roulette);
    RenderSettings given = render(R"(, "sampling": "plain", "branches": "both")");
    CHECK(resolved(given).branches == Branches::both);
    given.transport = Transport::conserving;
    given.exits = 5;
    CHECK(resolved(given).exits == 5);
    given.transport = Transport::paper;
    CHECK(resolved(given).branches == Branches::both);
    CHECK(resolved(given).exits == 1);  // of the distance, which is drawn without weights
    CHECK(resolved(render(R"(, "branches": "roulette")")).branches == Branches::roulette);
}

TEST_CASE("Distances of the model paper are as the scene says, or by its sampling") {
    const auto render = [](const std::string& settings) {
        return scene_with("\"seed\": 9", "\"seed\": 9" + settings).render;
    };
    CHECK(resolved(render("")).distances == Distances::importance);
    CHECK(resolved(render(R"(, "distances": "table")")).distances == Distances::table);
    CHECK(resolved(render(R"(, "sampling": "plain")")).distances == Distances::table);
    RenderSettings given = render(R"(, "sampling": "plain", "distances": "importance")");
    CHECK(resolved(given).distances == Distances::importance);
    given.tables = false;
    CHECK(resolved(given).distances == Distances::table);
    given.tables = true;
    given.transport = Transport::conserving;
    CHECK(resolved(given).distances == Distances::table);
}

TEST_CASE("Emission, direct light and radii are as the scene says, or by its sampling") {
    const auto render = [](const std::string& settings) {
        return scene_with("\"seed\": 9", "\"seed\": 9" + settings).render;
    };
    const RenderSettings best = render(""), plain = render(R"(, "sampling": "plain")");
    CHECK(resolved(best).emission == Emission::aimed);
    CHECK(resolved(best).direct == Direct::rays);
    CHECK(resolved(best).radii == Radii::one);
    CHECK(resolved(plain).emission == Emission::random);
    CHECK(resolved(plain).direct == Direct::photons);
    CHECK(resolved(plain).radii == Radii::one);
    const RenderSettings given =
        render(R"(, "sampling": "plain", "emission": "stratified", "direct": "rays", "radii": "local")");
    CHECK(resolved(given).emission == Emission::stratified);
    CHECK(resolved(given).direct == Direct::rays);
    CHECK(resolved(given).radii == Radii::local);
    CHECK(resolved(render(R"(, "direct": "photons")")).direct == Direct::photons);
}

TEST_CASE("A surface reflects where the scene says so") {
    const auto reflects = [](const std::string& more) {
        const std::string medium = "\"medium\": \"stone\"";
        return as_translucent(scene_with(medium, medium + more).materials[1])->fresnel;
    };
    CHECK_FALSE(reflects(""));
    CHECK(reflects(", \"fresnel\": true"));
    CHECK_FALSE(reflects(", \"fresnel\": false"));
    CHECK_FALSE(reflects(", \"fresnel\": false, \"subsurface\": false"));
}

TEST_CASE("A quantum yield is given, or follows from the conversion and the emission, and is 1 at most") {
    const auto yield = [](const std::string& emission, const std::string& more) {
        const Scene scene =
            scene_with(R"("emission": {"pairs": [[500, 1]]})", R"("emission": {"pairs": )" + emission + "}" + more);
        return scene.fluorophores[0].quantum_yield;
    };
    const std::string sums_to_10 = "[[500, 0], [510, 1], [520, 0]]";
    CHECK(yield(sums_to_10, "") == Approx(0.2));
    CHECK(yield(sums_to_10, ", \"conversion_per_nm\": 0.03") == Approx(0.3));
    CHECK(yield(sums_to_10, ", \"conversion_per_nm\": 0.5") == 1.0);
    CHECK(yield(sums_to_10, ", \"conversion_per_nm\": 0.5, \"quantum_yield\": 0.25") == 0.25);
    CHECK(yield(sums_to_10, ", \"quantum_yield\": 0") == 0.0);
    // Light from 300 to 830 nm counts, the nanometre about 830 included: 5 below 830, and half a nanometre of 0.975.
    CHECK(yield("[[820, 0], [830, 1], [840, 0]]", "") == Approx(0.02 * (5 + 0.5 * 0.975)).epsilon(2e-3));
    // PHYSICS section 4: the paper's conversion of 0.02 amounts to about 0.6.
    for (const Fluorophore& dots : read_scene(source_path("scenes/prisms.json")).fluorophores) {
        INFO(dots.name);
        CHECK(dots.quantum_yield == Approx(0.65).margin(0.15));
    }
}

TEST_CASE("An emission has no scale") {
    const auto with_emission = [](const std::string& pairs) {
        return scene_with(R"("emission": {"pairs": [[500, 1]]})", R"("emission": {"pairs": )" + pairs + "}")
            .fluorophores[0];
    };
    const Fluorophore one = with_emission("[[500, 0], [510, 1], [520, 0]]");
    for (const char* pairs : {"[[500, 0], [510, 0.0476], [520, 0]]", "[[500, 0], [510, 40000], [520, 0]]"}) {
        const Fluorophore other = with_emission(pairs);
        CHECK(other.quantum_yield == Approx(one.quantum_yield));
        for (const int lambda : {499, 505, 510, 516})
            CHECK(other.emission.at(lambda) == Approx(one.emission.at(lambda)));
    }
}

TEST_CASE("Spectra of any role are means over whole nanometres, in the unit that the scene says") {
    const TemporaryFolder folder;
    // A line of area 1 nm between 505 and 506 nm on nothing, in micrometres.
    put_file(folder.file("line.csv"), "w,v\n0.3,0\n0.5054,0\n0.5055,10\n0.5056,0\n0.83,0\n");
    const std::string line = R"({"file": "line.csv", "column": "v", "unit": "um", "scale": 0.1})";
    const Scene scene = parse_scene(
        R"({"format": "stokes-scene", "version": 1, "camera": {"position_mm": [0, 9, 9], "target_mm": [0, 0, 0]},
            "spectra": {"line": )" +
            line + R"(},
            "media": {"m": {"sigma_s_per_mm": "line", "sigma_a_per_mm": {"pairs": [[2, 1], [3, 3]], "unit": "eV"}}},
            "fluorophores": {"f": {"excitation": "line", "emission": "line", "stokes_rule": "truncate"}},
            "materials": {"d": {"type": "diffuse", "reflectance": "line"}},
            "lights": [{"type": "disk", "radius_mm": 1, "center_mm": [0, 9, 0], "normal": [0, -1, 0],
                        "spectrum": "line", "power_W": 3}]})",
        folder.file("s.json"));
    // Half of the line lies on either side of 505.5 nm.
    const Fluorophore& f = scene.fluorophores[0];
    CHECK(f.stokes_rule == StokesRule::truncate);
    for (const Spectrum* spectrum :
         {&scene.media[0].sigma_s, &f.excitation, &as_diffuse(scene.materials[0])->reflectance}) {
        CHECK(spectrum->at(505) == Approx(0.05));
        CHECK(spectrum->at(506) == Approx(0.05));
        CHECK(spectrum->at(507) == Approx(0.0).margin(1e-9));
    }
    CHECK(f.emission.at(505) == Approx(f.emission.at(506)));
    CHECK(scene.lights[0].flux.at(506) == Approx(1.5));
    // 2 and 3 eV are 619.92 and 413.28 nm: half between them, not at 2.5 eV.
    CHECK(scene.media[0].sigma_a.at(700) == 1.0);
    CHECK(scene.media[0].sigma_a.at(400) == 3.0);
    CHECK(scene.media[0].sigma_a.at(516) == Approx(3.0 - 2.0 * (516 - 413.28066) / (619.92099 - 413.28066)));
}

TEST_CASE("What a scene leaves out has its default") {
    const Scene scene = scene_with(
        R"(  "render": {"passes": 4, "photons_per_pass": 1000, "alpha": 0.5, "radius_mm": 2, "seed": 9},
  "film": {"width": 8, "height": 6, "exposure_ev": 1.5},)",
        "");
    const RenderSettings defaults;
    CHECK(scene.render.passes == defaults.passes);
    CHECK(scene.render.photons_per_pass == defaults.photons_per_pass);
    CHECK(scene.render.alpha == defaults.alpha);
    CHECK_FALSE(scene.render.radius_mm);
    CHECK(scene.film.width == Film().width);
    CHECK_FALSE(scene.film.exposure_ev);
    CHECK_FALSE(scene_with("\"exposure_ev\": 1.5", "\"exposure_ev\": \"auto\"").film.exposure_ev);
}

TEST_CASE("Shapes and emitters share one list, each emitter with its surface") {
    const Scene scene = parse_scene(base, "s.json");
    REQUIRE(scene.shapes.size() == 2);
    REQUIRE(scene.lights.size() == 1);
    CHECK(scene.shapes[0].name == "shape 0");
    CHECK((scene.shapes[0].material == 1 && scene.shapes[0].light == -1 && scene.shapes[0].body == 0));
    CHECK(std::get<SurfaceLight>(scene.lights[0].kind).shape == 1);
    CHECK((scene.shapes[1].light == 0 && scene.shapes[1].material == 2 && scene.shapes[1].body == 1));
    CHECK(scene.shapes[1].name == scene.lights[0].name);
    CHECK(scene.body_count == 2);
    for (const glm::vec3& p : scene.shapes[1].mesh.positions_mm) CHECK(p.y == 100.0F);
}

TEST_CASE("Shapes of one body have one number") {
    const std::string one = R"("shapes": [)";
    const std::string sphere = R"({"type": "sphere", "material": "glow", "radius_mm": 1, "body": "b"},)";
    const std::string floor = R"({"type": "disk", "material": "floor", "radius_mm": 1},)";
    const Scene scene = scene_with(one, one + sphere + floor + sphere);
    CHECK((scene.shapes[0].body == 0 && scene.shapes[1].body == 1 && scene.shapes[2].body == 0));
    CHECK((scene.shapes[3].body == 2 && scene.body_count == 4));
}

TEST_CASE("Transforms apply in order, and mirroring keeps the outside out") {
    const std::string sphere = R"({"type": "sphere", "material": "glow", "radius_mm": 10, "segments": 16})";
    const std::string box = R"({"type": "box", "material": "glow", "size_mm": [2, 4, 6], "transform": [)";
    const Scene scene = scene_with(sphere, box + R"({"translate_mm": [1, 0, 0]}, {"scale": 2},
        {"rotate_axis": [0, 0, 5], "angle_deg": 90}, {"scale": [-1, 1, 1]}]})");
    const Bounds bounds = mesh_bounds(scene.shapes[0].mesh);
    // x in 0..2 -> 0..4 -> becomes y; y in -4..4 -> becomes x, mirrored.
    CHECK(bounds.low_mm.x == Approx(-4).margin(1e-6));
    CHECK(bounds.high_mm.x == Approx(4).margin(1e-6));
    CHECK(bounds.low_mm.y == Approx(0).margin(1e-6));
    CHECK(bounds.high_mm.y == Approx(4).margin(1e-6));
    CHECK(mesh_volume_mm3(scene.shapes[0].mesh) == Approx(48 * 8));
}

TEST_CASE("The flux of an emitter sums to its power, or to pi area radiance") {
    const Scene power = parse_scene(base, "s.json");
    CHECK(power.lights[0].flux.sum_1nm(300, 780) == Approx(5.0));
    CHECK(power.lights[0].flux.at(325) == Approx(power.lights[0].flux.at(375) / 3));

    const Scene radiance = scene_with("\"power_W\": 5", "\"radiance_W_m2_sr\": 7");
    const double area_m2 = mesh_area_mm2(radiance.shapes[1].mesh) * 1e-6;
    CHECK(area_m2 == Approx(M_PI * 1e-4).epsilon(1e-3));
    CHECK(radiance.lights[0].flux.sum_1nm(300, 780) == Approx(M_PI * area_m2 * 7));

    const Scene absolute = scene_with("\"power_W\": 5", "\"radiance_scale_W_m2_sr_nm\": 3");
    CHECK(absolute.lights[0].flux.at(350) == Approx(M_PI * area_m2 * 3 * 1));

    const Scene narrow = scene_with("\"seed\": 9", "\"seed\": 9, \"lambda_min_nm\": 380, \"lambda_max_nm\": 399");
    CHECK(narrow.lights[0].flux.sum_1nm(380, 399) == Approx(5.0));
}

TEST_CASE("Emitters: a rectangle faces along its normal, a sphere outward") {
    const std::string disk = R"("type": "disk", "center_mm": [0, 100, 0], "normal": [0, -1, 0], "radius_mm": 10)";
    const Scene wall =
        scene_with(disk, R"("type": "rectangle", "center_mm": [5, 6, 7], "normal": [0, 0, -2], "up": [1, 1, 0],
                 "width_mm": 2, "height_mm": 4)");
    const Mesh& mesh = wall.shapes[1].mesh;
    CHECK(mesh_area_mm2(mesh) == Approx(8));
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 a = mesh.positions_mm[t.x];
        const glm::vec3 n = glm::normalize(glm::cross(mesh.positions_mm[t.y] - a, mesh.positions_mm[t.z] - a));
        CHECK(n.z == Approx(-1));
    }
    // Half the height along up and half the width across it: the farthest corner along (1, 1, 0) is 2 away.
    float along_up = 0;
    for (const glm::vec3& p : mesh.positions_mm) along_up = std::max(along_up, (p.x - 5 + p.y - 6) / std::sqrt(2.0F));
    CHECK(along_up == Approx(2));

    const Scene ball = scene_with(disk, R"("type": "sphere", "center_mm": [0, 100, 0], "radius_mm": 10)");
    CHECK(mesh_volume_mm3(ball.shapes[1].mesh) > 0.0);
    CHECK(mesh_bounds(ball.shapes[1].mesh).low_mm.y == Approx(90));
    CHECK(ball.lights[0].flux.sum_1nm(300, 780) == Approx(5.0));
}

TEST_CASE("Beams carry irradiance times their cross-section") {
    const std::string light =
        R"({"type": "disk", "center_mm": [0, 100, 0], "normal": [0, -1, 0], "radius_mm": 10, "spectrum": "lamp", "power_W": 5})";
    const Scene disk = scene_with(light, R"({"name": "sun", "type": "beam", "section": "disk", "position_mm": [0, 9, 0],
        "direction": [0, -3, 0], "radius_mm": 20, "spectrum": "lamp", "irradiance_W_m2": 10})");
    CHECK(disk.lights[0].name == "sun");
    const auto& round = std::get<DiskBeam>(disk.lights[0].kind);
    CHECK(disk.shapes.size() == 1);
    CHECK(round.direction == glm::dvec3(0, -1, 0));
    CHECK(disk.lights[0].flux.sum_1nm(300, 780) == Approx(10 * M_PI * 4e-4));
    CHECK(glm::length(round.half_u_mm) == Approx(20));
    CHECK(glm::length(round.half_v_mm) == Approx(20));

    const Scene rectangle =
        scene_with(light, R"({"type": "beam", "section": "rectangle", "position_mm": [0, 9, 0], "up": [1, 5, 0],
        "direction": [0, -3, 0], "width_mm": 20, "height_mm": 30, "spectrum": "lamp", "irradiance_W_m2": 10})");
    const auto& flat = std::get<RectangleBeam>(rectangle.lights[0].kind);
    CHECK(rectangle.lights[0].flux.sum_1nm(300, 780) == Approx(10 * 6e-4));
    CHECK(glm::length(flat.half_v_mm - glm::dvec3(15, 0, 0)) == Approx(0).margin(1e-9));
    CHECK(std::abs(flat.half_u_mm.z) == Approx(10));
    CHECK(glm::dot(flat.half_u_mm, flat.direction) == Approx(0).margin(1e-9));
}

TEST_CASE("Spectra come from files, illuminants, pairs and constants, with the ends each use asks for") {
    const TemporaryFolder folder;
    put_file(folder.file("t.csv"), "# header\nnm,a\n400,0.25\n500,0.5\n");
    const auto reflectance = [&](const std::string& spectrum) {
        const std::string text = with(R"({"pairs": [[400, 0.2], [500, 0.6]]})", spectrum);
        return as_diffuse(parse_scene(text, folder.file("s.json")).materials[0])->reflectance;
    };
    CHECK(reflectance("0.3").at(555) == 0.3);
    CHECK(reflectance(R"({"constant": 0.3})").at(900) == 0.3);
    CHECK(reflectance(R"({"file": "t.csv", "column": "a", "scale": 2})").at(450) == Approx(0.75));
    CHECK(reflectance(R"({"file": "t.csv", "column": "a"})").at(700) == 0.5);
    CHECK(reflectance(R"({"file": "t.csv", "column": "a", "outside": "zero"})").at(700) == 0.0);
    CHECK(reflectance(R"({"file": "../)" + folder.path().substr(folder.path().rfind('/') + 1) +
                      R"(/t.csv", "column": "a"})")
              .at(399) == 0.25);

    const Scene lit = scene_with("\"spectrum\": \"lamp\"", R"("spectrum": {"illuminant": "D65"})");
    // CIE D65 at 450 and 560 nm: 117.008 and 100.
    CHECK(lit.lights[0].flux.at(450) / lit.lights[0].flux.at(560) == Approx(1.17008).epsilon(1e-5));
    CHECK(lit.lights[0].flux.at(831) == 0.0);
    const Scene held = scene_with(R"([[300, 0], [400, 2]]})", R"([[300, 0], [400, 2]], "outside": "hold"})");
    CHECK(held.lights[0].flux.at(700) == held.lights[0].flux.at(401));
}

TEST_CASE("Surface fluorescence needs no medium") {
    const Scene scene = scene_with(R"("medium": "stone", "fluorophore")", R"("subsurface": false, "fluorophore")");
    CHECK_FALSE(medium_of(scene.materials[1]));
    CHECK(as_translucent(scene.materials[1])->dyes.front().fluorophore == 0);
}

TEST_CASE("A material may hold several fluorophores") {
    const std::string one = R"("fluorophore": "dye", "fluorescent_fraction": 0.5)";
    const auto dyes = [&](const std::string& text) {
        std::string scene = base;
        scene.replace(scene.find("\"fluorophores\": {"), 17,
                      R"("fluorophores": {"ink": {"excitation": 1, "emission": 1}, )");
        return as_translucent(parse_scene(scene.replace(scene.find(one), one.size(), text), "s.json").materials[1])
            ->dyes;
    };
    const std::vector<Dye> both =
        dyes(R"("fluorophores": [{"fluorophore": "dye", "fraction": 0.3}, {"fluorophore": "ink", "fraction": 0.7}])");
    REQUIRE(both.size() == 2);
    CHECK((both[0].fluorophore == 1 && both[0].fraction == 0.3));
    CHECK((both[1].fluorophore == 0 && both[1].fraction == 0.7));
    CHECK_THROWS_WITH(
        dyes(R"("fluorophores": [{"fluorophore": "dye", "fraction": 0.3}, {"fluorophore": "ink", "fraction": 0.8}])"),
        Catch::Contains("materials.glow.fluorophores: expected fractions that add up to 1 at most, got 1.1"));
}

TEST_CASE("An emitter may have a material of its own") {
    const Scene scene = scene_with("\"power_W\": 5", "\"power_W\": 5, \"material\": \"floor\"");
    CHECK(scene.shapes[1].material == 0);
    CHECK(scene.materials.size() == 2);
}

TEST_CASE("The exhibit: three dyes in two rows, each object standing on its prism") {
    const Scene scene = read_scene(source_path("scenes/prisms.json"));
    REQUIRE(scene.shapes.size() == 13);
    const auto find = [&](const std::string& name) -> const Shape& {
        for (const Shape& shape : scene.shapes) {
            if (shape.name == name) return shape;
        }
        throw std::logic_error("no shape " + name);
    };
    for (const std::string row : {"front ", "back "}) {
        const std::string pairs[][2] = {{"green prism", "sphere"}, {"yellow prism", "dragon"}, {"red prism", "bunny"}};
        for (const auto& [prism_name, object_name] : pairs) {
            INFO(row << prism_name);
            const Shape& prism = find(row + prism_name);
            const auto& material =
                std::get<TranslucentMaterial>(scene.materials[static_cast<std::size_t>(prism.material)].kind);
            CHECK(material.medium.has_value() == (row == "front "));
            CHECK(fluorescent_fraction(material.dyes) == (row == "front " ? 0.5 : 1.0));
            const Bounds below = mesh_bounds(prism.mesh);
            const Bounds above = mesh_bounds(find(row + object_name).mesh);
            CHECK(above.low_mm.y == Approx(below.high_mm.y).margin(0.01));
            CHECK((above.low_mm.x > below.low_mm.x - 1 && above.high_mm.x < below.high_mm.x + 1));
            CHECK((above.low_mm.z > below.low_mm.z - 1 && above.high_mm.z < below.high_mm.z + 1));
        }
    }
    CHECK(scene.media[0].sigma_s.at(300) == Approx(1.5));
    CHECK(scene.media[0].sigma_a.at(300) == Approx(0.0071));
    CHECK((scene.media[0].eta == 1.5 && scene.media[0].dipole_eta == 1.0));
    CHECK(scene.render.transport == Transport::paper);
    // 20 W/m^2 over the beam's disk
    CHECK(scene.lights[0].flux.sum_1nm(300, 780) == Approx(20.0 * 3.14159265 * 0.27 * 0.27));
}

TEST_CASE("The small scene reads") {
    const Scene scene = read_scene(source_path("scenes/sphere.json"));
    CHECK(scene.shapes.size() == 3);
    CHECK(scene.render.transport == Transport::conserving);
    CHECK(mesh_bounds(scene.shapes[1].mesh).low_mm.y == Approx(0).margin(1e-5));
}
