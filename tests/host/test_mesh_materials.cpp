// Meshes of several materials in a scene, and what is said of them.
#include "host/scene/mesh/mesh.hpp"
#include "host/scene/readers/scene_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/run_stokes.hpp"

using namespace stokes;
using Catch::Matchers::Contains;

namespace {

// A box of 2 x 2 x 2 from corner (x, 0, 0) on, its top of one material, the rest of another.
std::string box(int first, int x, const std::string& sides, const std::string& top) {
    std::string text;
    for (int i = 0; i < 8; ++i)
        text += "v " + std::to_string(x + (i & 1 ? 2 : 0)) + (i & 2 ? " 2" : " 0") + (i & 4 ? " 2\n" : " 0\n");
    const auto face = [&](int a, int b, int c, int d) {
        text += "f";
        for (const int k : {a, b, c, d}) text += " " + std::to_string(first + k);
        text += "\n";
    };
    text += "usemtl " + sides + "\n";
    face(0, 4, 6, 2), face(1, 3, 7, 5), face(0, 1, 5, 4), face(0, 2, 3, 1), face(4, 5, 7, 6);
    text += "usemtl " + top + "\n";
    face(2, 6, 7, 3);
    return text;
}

struct Folder : TemporaryFolder {
    Folder() {
        put_file(file("tile.obj"), box(1, 0, "jade", "milk"));
        put_file(file("two.obj"), "o A\n" + box(1, 0, "jade", "jade") + "o B\n" + box(9, 2, "milk", "milk"));
        put_file(file("one.obj"), "o A\n" + box(1, 0, "x", "x") + "o B\n" + box(9, 2, "x", "x"));
        put_file(file("m.ply"),
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                 "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                 "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    }
    std::string text(const std::string& shape) const {
        return R"({"format": "stokes-scene", "version": 1, "camera": {"position_mm": [0, 9, 9], "target_mm": [0, 0, 0]},
"media": {"m": {"sigma_s_per_mm": 2, "sigma_a_per_mm": 0.1, "eta": 1.5}},
"materials": {"a": {"type": "translucent", "medium": "m"}, "b": {"type": "translucent", "medium": "m"},
 "c": {"type": "diffuse", "reflectance": 0.5}, "d": {"type": "diffuse", "reflectance": 0.4}},
"lights": [{"type": "sphere", "center_mm": [0, 9, 0], "radius_mm": 1, "spectrum": 1, "power_W": 1}],
"shapes": [{"type": "mesh", )" +
               shape + "}]}";
    }
    Scene scene(const std::string& shape) const { return parse_scene(text(shape), file("s.json")); }
    std::string error(const std::string& shape) const {
        const std::string found = input_error([&] { scene(shape); });
        return found.empty() ? found : found.substr(path().size() + 1);
    }
    std::string warnings(const std::string& shape) const {
        put_file(file("s.json"), text(shape));
        const Outcome outcome =
            run_stokes("render " + file("s.json") + " --quiet --png " + file("o.png") + small_render);
        CHECK(outcome.code == 0);
        return outcome.err;
    }
};

}  // namespace

// 2 of its 12 triangles are the top; both are one closed surface.
TEST_CASE("Materials of an OBJ file become materials of the scene, open parts that meet one body", "[mesh_materials]") {
    const Folder folder;
    const Scene scene = folder.scene(R"("file": "tile.obj", "materials": {"jade": "a", "milk": "b"})");
    REQUIRE(scene.shapes.size() == 3);  // and the lamp
    CHECK(scene.shapes[0].name == "shape 0 (a)");
    CHECK(scene.shapes[0].material == 0);
    CHECK(scene.shapes[0].mesh.triangles.size() == 10);
    CHECK(mesh_area_mm2(scene.shapes[0].mesh) == Approx(20));
    CHECK(scene.shapes[1].material == 1);
    CHECK(scene.shapes[1].mesh.positions_mm.size() == 4);
    CHECK(mesh_area_mm2(scene.shapes[1].mesh) == Approx(4));
    CHECK(scene.shapes[0].body == scene.shapes[1].body);
    CHECK(scene.body_count == 2);
}

TEST_CASE("Closed parts that touch, and opaque parts, are bodies of their own", "[mesh_materials]") {
    const Folder folder;
    const Scene glued = folder.scene(R"("file": "two.obj", "materials": {"jade": "a", "milk": "b"})");
    CHECK(glued.shapes[0].body != glued.shapes[1].body);
    const Scene label = folder.scene(R"("file": "tile.obj", "materials": {"jade": "a", "milk": "c"})");
    CHECK(label.shapes[0].body != label.shapes[1].body);
}

TEST_CASE("Materials of a file that are not named have the shape's material", "[mesh_materials]") {
    const Folder folder;
    const Scene scene = folder.scene(R"("file": "tile.obj", "material": "c", "materials": {"milk": "b"})");
    CHECK(scene.shapes[0].material == 2);
    CHECK(scene.shapes[1].material == 1);
    const Scene same = folder.scene(R"("file": "tile.obj", "material": "a", "materials": {"milk": "a"})");
    CHECK(same.shapes.size() == 2);
    CHECK(same.shapes[0].mesh.triangles.size() == 12);
}

TEST_CASE("Mistakes in the materials of a mesh are named", "[mesh_materials]") {
    const Folder folder;
    CHECK(folder.error(R"("file": "tile.obj", "materials": {"milk": "b"})") ==
          "s.json:6: shapes[0].materials: expected a material for \"jade\", or the key \"material\" for all that are "
          "not named");
    CHECK(folder.error(R"("file": "tile.obj", "material": "a", "materials": {"mlik": "b"})") ==
          "s.json:6: shapes[0].materials.mlik: the mesh has no material \"mlik\"; did you mean \"milk\"?");
    CHECK_THAT(folder.error(R"("file": "tile.obj", "materials": {"jade": "a", "milk": "z"})"),
               Contains("shapes[0].materials.milk: no \"z\" in materials"));
    CHECK_THAT(folder.error(R"("file": "tile.obj", "materials": {"jade": "a", "milk": 5})"), Contains("expected"));
    CHECK_THAT(folder.error(R"("file": "tile.obj", "materials": ["a", "b"])"), Contains("expected an object"));
    CHECK_THAT(folder.error(R"("file": "tile.obj")"), Contains("shapes[0]: missing key \"material\""));
    CHECK_THAT(folder.error(R"("file": "tile.obj", "body": "x", "materials": {"jade": "a", "milk": "b"})"),
               Contains("shapes[0].body: expected either this or \"materials\", got both"));
    CHECK_THAT(folder.error(R"("file": "m.ply", "materials": {"jade": "a"})"),
               Contains("shapes[0].materials: expected an OBJ file"));
}

TEST_CASE("Several materials or objects that become one body are told", "[mesh_materials]") {
    const Folder folder;
    CHECK_THAT(folder.warnings(R"("file": "two.obj", "material": "c")"),
               Contains("shapes[0] (shape 0): 2 materials (\"jade\", \"milk\") and 2 objects of the file become one "
                        "body of material \"c\"; \"materials\" gives each its own"));
    CHECK_THAT(folder.warnings(R"("file": "one.obj", "material": "a")"),
               Contains("2 objects of the file become one body of material \"a\""));
    CHECK(folder.warnings(R"("file": "one.obj", "material": "c")").empty());
    CHECK(folder.warnings(R"("file": "two.obj", "materials": {"jade": "c", "milk": "c"})").empty());
}

// Mirrored, the file's outside stays outside: it faces inward before and after.
TEST_CASE("A closed mesh that faces inward is turned over with a warning, by every transport", "[mesh_materials]") {
    const Folder folder;
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
    put_file(folder.file("in.obj"), text);
    for (const char* mirror : {"", R"(, "transform": [{"scale": [-1, 1, 1]}])"})
        for (const char* material : {"a", "c"}) {
            const std::string shape = R"("file": "in.obj", "material": ")" + std::string(material) + "\"" + mirror;
            CHECK_THAT(folder.warnings(shape),
                       Contains("shapes[0] (shape 0): its closed surface faces inward: turned over 4 triangles"));
            CHECK(mesh_volume_mm3(folder.scene(shape).shapes[0].mesh) == Approx(1.0 / 6));
        }
    put_file(folder.file("s.json"), folder.text(R"("file": "in.obj", "material": "a")"));
    for (const char* transport : {"paper", "conserving", "walk"}) {
        const Outcome outcome = run_stokes("render " + folder.file("s.json") + " --quiet --transport " + transport +
                                           " --png " + folder.file("o.png") + small_render);
        CHECK(outcome.code == 0);
        CHECK_THAT(outcome.err, Contains("faces inward: turned over 4 triangles"));
    }
}

// The camera is at (0, 9, 9). A sheet in y = 0 shows it the back where it faces -y; one that is bent shows it a part.
TEST_CASE("An open mesh that faces away from the camera as a whole is told", "[mesh_materials]") {
    const Folder folder;
    const std::string sheet = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 2 -1\nv 1 2 -1\n";
    const std::string told = "shapes[0] (shape 0): all of it faces away from the camera, which sees its black back";
    put_file(folder.file("down.obj"), sheet + "f 1 2 3 4\n");
    put_file(folder.file("up.obj"), sheet + "f 4 3 2 1\n");
    put_file(folder.file("bent.obj"), sheet + "f 1 2 3 4\nf 1 2 6 5\n");
    CHECK_THAT(folder.warnings(R"("file": "down.obj", "material": "c")"), Contains(told));
    CHECK(folder.warnings(R"("file": "up.obj", "material": "c")").empty());
    CHECK_THAT(folder.warnings(R"("file": "bent.obj", "material": "c")"), !Contains(told));
}

// The box of 2 x 2 x 2 faces inward; its top has a material of its own, and is open by itself as the rest is.
TEST_CASE("A closed mesh of opaque materials that faces inward is turned over as a whole", "[mesh_materials]") {
    const Folder folder;
    std::string text = box(1, 0, "jade", "milk");
    for (std::size_t at = text.find("\nf "); at != std::string::npos; at = text.find("\nf ", at + 1)) {
        const std::size_t end = text.find('\n', at + 1);
        std::string turned;
        for (const char c : text.substr(at + 3, end - at - 3)) turned.insert(turned.begin(), c);
        text.replace(at + 3, turned.size(), turned);
    }
    put_file(folder.file("in.obj"), text);
    for (const char* file : {"tile.obj", "in.obj"}) {
        const std::string shape = "\"file\": \"" + std::string(file) + R"(", "materials": {"jade": "c", "milk": "d"})";
        const Scene scene = folder.scene(shape);
        Mesh whole = scene.shapes[0].mesh;
        for (const glm::uvec3& t : scene.shapes[1].mesh.triangles)
            whole.triangles.push_back(t + static_cast<std::uint32_t>(whole.positions_mm.size()));
        for (const glm::vec3& p : scene.shapes[1].mesh.positions_mm) whole.positions_mm.push_back(p);
        CHECK(mesh_volume_mm3(whole) == Approx(8));
        const bool inward = file == std::string("in.obj");
        CHECK(Contains("faces inward: turned over 12 triangles").match(folder.warnings(shape)) == inward);
    }
}

// A sheet of two triangles, and each once more from behind.
TEST_CASE("A mesh whose faces are all there twice, facing both ways, has two sides", "[mesh_materials]") {
    const Folder folder;
    const std::string sheet = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 2 -1\nv 1 2 -1\nf 4 3 2\nf 4 2 1\n";
    put_file(folder.file("both.obj"), sheet + "f 2 3 4\nf 1 2 4\n");
    put_file(folder.file("half.obj"), sheet + "f 2 3 4\n");
    const std::string both = R"("file": "both.obj", "material": "c")", half = R"("file": "half.obj", "material": "c")";
    const Shape shape = folder.scene(both).shapes[0];
    CHECK(shape.two_sided);
    CHECK(shape.mesh.triangles == std::vector<glm::uvec3>{{3, 2, 1}, {3, 1, 0}});
    CHECK_THAT(folder.warnings(both), Contains("each of its faces is there twice, facing both ways: it has 2 triangles "
                                               "that look alike from both sides"));
    CHECK_FALSE(folder.scene(half).shapes[0].two_sided);
    CHECK(folder.scene(half).shapes[0].mesh.triangles.size() == 3);
    CHECK_THAT(folder.warnings(half), Contains("2 triangles lie in one place with others that face the other way"));
    // Polygons: a square that begins at another corner from behind, and a pentagon with a notch.
    put_file(folder.file("ngon.obj"),
             "v 0 0 0\nv 2 0 0\nv 2 0 2\nv 0 0 2\nv 1 0 1\nv 3 0 0\nv 5 0 0\nv 5 0 2\nv 3 0 2\n"
             "f 9 8 7 6\nf 7 8 9 6\nf 5 4 3 2 1\nf 1 2 3 4 5\n");
    const Shape ngon = folder.scene(R"("file": "ngon.obj", "material": "c")").shapes[0];
    CHECK(ngon.two_sided);
    CHECK(ngon.mesh.triangles.size() == 5);
    CHECK(mesh_area_mm2(ngon.mesh) == Approx(4 + 3));
    const Scene milk = folder.scene(R"("file": "both.obj", "material": "a")");
    CHECK_FALSE(milk.shapes[0].two_sided);
    CHECK(milk.shapes[0].mesh.triangles.size() == 4);
}

// Groups on one surface share vertices, and are one thing.
TEST_CASE("Groups of a file that become one translucent body are told", "[mesh_materials]") {
    const Folder folder;
    put_file(folder.file("g.obj"), "g A\n" + box(1, 0, "x", "x") + "g B\n" + box(9, 5, "x", "x"));
    std::string skin = box(1, 0, "x", "x");
    skin.insert(skin.rfind("f "), "g top\n");
    put_file(folder.file("skin.obj"), skin);
    CHECK_THAT(folder.warnings(R"("file": "g.obj", "material": "a")"),
               Contains("2 groups of the file become one body of material \"a\""));
    CHECK(folder.warnings(R"("file": "g.obj", "material": "c")").empty());
    CHECK_THAT(folder.warnings(R"("file": "skin.obj", "material": "a")"), !Contains("groups"));
}
