#include <algorithm>
#include <array>
#include <cstring>
#include <random>

#include "tests/support/catch.hpp"
#include "tests/support/file_meshes.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;
using Catch::Matchers::StartsWith;

namespace {

const std::string ascii_square =
    "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property double z\nproperty uchar red\nelement face 1\nproperty list uchar int "
    "vertex_indices\nend_header\n"
    "0 0 0 255\n2 0 0 255\n2 0 3.5 0\n0 0 3.5 0\n4 0 1 2 3\n";

template <typename T>
void put(std::string& text, T value, bool big_endian) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof value);
    if (big_endian) std::reverse(bytes, bytes + sizeof value);
    text.append(bytes, sizeof value);
}

// The same square, with properties and elements that a reader has to step over.
std::string binary_square(bool big_endian) {
    std::string text = "ply\r\nformat binary_" + std::string(big_endian ? "big" : "little") + "_endian 1.0\r\n" +
                       "element material 1\r\nproperty list ushort float values\r\n"
                       "element vertex 4\r\nproperty double x\r\nproperty short label\r\nproperty float y\r\n"
                       "property float z\r\nelement face 1\r\nproperty int group\r\n"
                       "property list uint ushort vertex_index\r\nelement edge 1000000\r\nproperty int a\r\n"
                       "end_header\r\n";
    put<std::uint16_t>(text, 2, big_endian);
    for (int i = 0; i < 2; ++i) put<float>(text, 1.0F, big_endian);
    const double corners[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 0, 3.5}, {0, 0, 3.5}};
    for (const auto& c : corners) {
        put<double>(text, c[0], big_endian);
        put<std::int16_t>(text, -7, big_endian);
        put<float>(text, static_cast<float>(c[1]), big_endian);
        put<float>(text, static_cast<float>(c[2]), big_endian);
    }
    put<std::int32_t>(text, 5, big_endian);
    put<std::uint32_t>(text, 4, big_endian);
    for (std::uint16_t i = 0; i < 4; ++i) put<std::uint16_t>(text, i, big_endian);
    return text;
}

void check_square(const Mesh& mesh) {
    REQUIRE(mesh.positions_mm.size() == 4);
    CHECK(mesh.positions_mm[2] == glm::vec3(2, 0, 3.5F));
    REQUIRE(mesh.triangles.size() == 2);
    CHECK(mesh.triangles[0] == glm::uvec3(0, 1, 2));
    CHECK(mesh.triangles[1] == glm::uvec3(0, 2, 3));
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    const std::size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), with);
}

}  // namespace

TEST_CASE("PLY in all three formats gives the same square") {
    check_square(as_read(parse_ply(ascii_square, "m.ply")));
    check_square(as_read(parse_ply(binary_square(false), "m.ply")));
    check_square(as_read(parse_ply(binary_square(true), "m.ply")));
}

TEST_CASE("A PLY file may have its faces before its vertices") {
    const std::string text =
        "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 3\n"
        "property float x\nproperty float y\nproperty float z\nend_header\n3 2 1 0\n0 0 0 1 0 0\n0 1 +0\n";
    const Mesh mesh = as_read(parse_ply(text, "m.ply"));
    REQUIRE(mesh.triangles.size() == 1);
    CHECK(mesh.triangles[0] == glm::uvec3(2, 1, 0));
    CHECK(input_error([&] { parse_ply(replaced(text, "3 2 1 0", "3 2 1 3"), "m.ply"); }) ==
          "m.ply: vertex index 3 out of range: the file has 3 vertices");
}

TEST_CASE("Bad PLY is one line with file and place") {
    struct Case {
        std::string what, with, expected;
    };
    const Case cases[] = {
        {"ply\n", "PLY\n", "m.ply:1: expected \"ply\""},
        {"format ascii 1.0", "format text 1.0", "m.ply:2: expected format ascii, binary_little_endian or"},
        {"ascii 1.0", "ascii 2.0", "m.ply:2: expected version 1.0, got \"2.0\""},
        {"format ascii 1.0\n", "", "m.ply:10: the header has no format line"},
        {"element vertex 4", "element vertex -4", "m.ply:4: expected an element's name and count, got \"-4\""},
        {"element vertex 4", "element vertex", "m.ply:4: expected an element's name and count"},
        {"element vertex 4", "element vertex 99999999999999999999", "m.ply:4: expected an element's name"},
        {"element vertex 4", "element vertex 4000000000000000000",
         "m.ply: the header promises 4000000000000000000 of element vertex, but the file is too short"},
        {"element face 1", "element face 1000000000", "m.ply: the header promises 1000000000 of element face"},
        {"element vertex 4\n", "", "m.ply:4: a property before any element"},
        {"property float x", "property half x", "m.ply:5: unknown property type \"half\""},
        {"property float x", "property float", "m.ply:5: a property without a name"},
        {"property float x", "property float a", "m.ply: element vertex: expected the properties x, y and z"},
        {"property float x", "property list uchar float x", "m.ply: element vertex: expected the properties"},
        {"list uchar int", "list float int", "m.ply:10: expected an integer type for the length of a list"},
        {"vertex_indices", "indices", "m.ply: element face: expected a list property vertex_indices"},
        {"comment", "remark", "m.ply:3: unknown header word \"remark\""},
        {"end_header\n", "", "m.ply:11: unknown header word \"0\""},
        {"2 0 0 255", "2 x 0 255", "m.ply:13: vertex 1: expected a number, got \"x\""},
        {"2 0 0 255", "2 nan 0 255", "m.ply:13: vertex 1: expected finite coordinates"},
        {"2 0 0 255", "2 1e39 0 255", "m.ply:13: vertex 1: expected finite coordinates"},
        {"2 0 0 255", "2 0 0 2.5", "m.ply:13: vertex 1: expected a number, got \"2.5\""},
        {"4 0 1 2 3", "4 0 1 2 4", "m.ply:16: face 0: vertex index 4 out of range"},
        {"4 0 1 2 3", "4 0 -1 2 3", "m.ply:16: face 0: vertex index -1 out of range"},
        {"4 0 1 2 3", "2 0 1", "m.ply:16: face 0: expected 3 or more vertices, got 2"},
        {"4 0 1 2 3", "-4 0 1", "m.ply:16: face 0: a list of length -4"},
        {"4 0 1 2 3\n", "4 0 1 2\n", "m.ply:17: face 0: expected a number, got the end of the file"},
        {"element face 1", "element face 0", "m.ply: no triangles, only points"},
    };
    for (const Case& c : cases) {
        INFO(c.what << " -> " << c.with);
        const std::string text = replaced(ascii_square, c.what, c.with);
        CHECK_THAT(input_error([&] { parse_ply(text, "m.ply"); }), StartsWith(c.expected));
    }
    CHECK_THAT(input_error([&] { parse_ply("ply\nformat ascii 1.0\n", "m.ply"); }),
               StartsWith("m.ply:3: the header has no end_header"));
    CHECK_THAT(
        input_error([&] { parse_ply("ply\nformat ascii 1.0\nelement x 9000000000000000000\nend_header\n", "m.ply"); }),
        StartsWith("m.ply:4: element x has no properties"));
}

TEST_CASE("Binary PLY that is cut short or damaged is an error and nothing worse") {
    const std::string whole = binary_square(false);
    for (std::size_t length = 0; length < whole.size(); ++length) {
        INFO(length);
        CHECK_FALSE(input_error([&] { parse_ply(whole.substr(0, length), "m.ply"); }).empty());
    }
    std::mt19937 random(1);
    int good = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string damaged = i % 2 == 0 ? whole : ascii_square;
        for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
        const std::string text = input_error([&] {
            const FileMesh mesh = parse_ply(damaged, "m.ply");
            for (const glm::uvec3& t : mesh.triangles) {
                REQUIRE(std::max({t.x, t.y, t.z}) < mesh.positions.size());
            }
        });
        if (text.empty()) ++good;
    }
    CHECK((good > 0 && good < 20000));
}

TEST_CASE("OBJ gives vertices and fans, whatever else its lines hold") {
    const Mesh mesh = as_read(
        parse_obj("# square\nmtllib a.mtl\nv 0 0 0\nv 2 0 0 1.0\nvt 0 0\nvn 0 1 0\nv\t2 0 3.5 0.1 0.2 0.3\r\nv 0 0 "
                  "3.5\n"
                  "s off\nusemtl x\nf 1/1 2/1/1 3//1 4 # fan\nf -4 -3/2 -2\n",
                  "m.obj"));
    CHECK(mesh.positions_mm.size() == 4);
    REQUIRE(mesh.triangles.size() == 3);
    CHECK(mesh.triangles[0] == glm::uvec3(0, 1, 2));
    CHECK(mesh.triangles[1] == glm::uvec3(0, 2, 3));
    CHECK(mesh.triangles[2] == glm::uvec3(0, 1, 2));
    const FileMesh early = parse_obj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0", "m.obj");
    CHECK(early.triangles[0] == glm::uvec3(0, 1, 2));
}

TEST_CASE("Bad OBJ is one line with file and line") {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    struct Case {
        std::string text, expected;
    };
    const Case cases[] = {
        {"", "m.obj: no triangles"},
        {vertices, "m.obj: no triangles, only points"},
        {"v 0 0\n", "m.obj:1: expected 3 finite coordinates, got \"\""},
        {"v 0 0 zero\n", "m.obj:1: expected 3 finite coordinates, got \"zero\""},
        {"v 0 0 inf\n", "m.obj:1: expected 3 finite coordinates, got \"inf\""},
        {vertices + "f 1 2\n", "m.obj:4: expected a face of 3 or more vertices, got 2"},
        {vertices + "f 1 2 4\nf 1 2 3\n", "m.obj:4: vertex index 4 out of range: the file has 3 vertices"},
        {vertices + "\nf 1 2 0\n", "m.obj:5: expected a vertex index, got \"0\""},
        {vertices + "f 1 2 -4\n", "m.obj:4: vertex index -4 out of range"},
        {vertices + "f 1 2 9999999999\n", "m.obj:4: vertex index 9999999999 out of range"},
        {vertices + "f 1 2 99999999999999999999\n", "m.obj:4: expected a vertex index"},
        {vertices + "f 1 2 x/3\n", "m.obj:4: expected a vertex index, got \"x/3\""},
        {vertices + "f 1 2 1.5\n", "m.obj:4: expected a vertex index, got \"1.5\""},
    };
    for (const Case& c : cases) {
        INFO(c.text);
        CHECK_THAT(input_error([&] { parse_obj(c.text, "m.obj"); }), StartsWith(c.expected));
    }
}

TEST_CASE("Mesh files are read by their ending") {
    const TemporaryFolder folder;
    put_file(folder.file("a.ply"), ascii_square);
    put_file(folder.file("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    put_file(folder.file("a.step"), "");
    check_square(as_read(read_mesh(folder.file("a.ply"))));
    CHECK(read_mesh(folder.file("a.obj")).triangles.size() == 1);
    CHECK(input_error([&] { read_mesh(folder.file("a.step")); }) ==
          folder.file("a.step") + ": expected a mesh file that ends in .ply, .obj or .stl");
    CHECK(input_error([&] { read_mesh(folder.file("b.ply")); }) ==
          folder.file("b.ply") + ": cannot read: No such file or directory");
}

TEST_CASE("The shipped meshes are what their README says") {
    const Mesh bunny = as_read(read_mesh(source_path("scenes/meshes/bunny_closed.ply")));
    CHECK(bunny.positions_mm.size() == 34839);
    CHECK(bunny.triangles.size() == 69674);
    CHECK(mesh_volume_mm3(bunny) > 0.0);
    const Mesh dragon = as_read(read_mesh(source_path("scenes/meshes/dragon_48k.ply")));
    CHECK(dragon.positions_mm.size() == 22447);
    CHECK(dragon.triangles.size() == 44894);
    CHECK(mesh_volume_mm3(dragon) > 0.0);
}

namespace {

using Uv = std::array<glm::vec2, 3>;

}  // namespace

TEST_CASE("OBJ texture coordinates follow the corners, v counted from the top") {
    const Mesh mesh =
        as_read(parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 0.75\nvt 0 1 0\n"
                          "f 1/1 2/2/1 3/3 4/-1\n",
                          "m.obj"));
    REQUIRE(mesh.uv.size() == 2);
    CHECK(mesh.uv[0] == Uv{glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(1, 0.25)});
    CHECK(mesh.uv[1] == Uv{glm::vec2(0, 1), glm::vec2(1, 0.25), glm::vec2(0, 0)});
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 nan\n";
    for (const char* face :
         {"f 1 2 3\n", "f 1/1 2/1 3\n", "f 1/1 2/3 3/1\n", "f 1//1 2//1 3//1\n", "f 1/1 2/-3 3/1\n"}) {
        INFO(face);
        CHECK(parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\n" + std::string(face), "m.obj").uv.empty());
    }
    CHECK(parse_obj(vertices + "f 1/1 2/1 3/1\n", "m.obj").uv.empty());
}

TEST_CASE("PLY texture coordinates belong to the vertices, by any of their usual names") {
    for (const auto& [u, v] : {std::pair("u", "v"), std::pair("s", "t"), std::pair("texture_u", "texture_v")}) {
        const auto text = [&](const std::string& last) {
            return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float " + std::string(v) +
                   "\nproperty float y\nproperty float z\nproperty float " + u +
                   "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                   "0 0 0 0 0\n1 0.25 0 0 1\n1 1 1 0 " +
                   last + "\n3 0 1 2\n";
        };
        const Mesh mesh = as_read(parse_ply(text("0.5"), "m.ply"));
        CHECK(mesh.positions_mm[2] == glm::vec3(1, 1, 0));
        REQUIRE(mesh.uv.size() == 1);
        CHECK(mesh.uv[0] == Uv{glm::vec2(0, 1), glm::vec2(1, 0.75), glm::vec2(0.5, 0)});
        CHECK(parse_ply(text("nan"), "m.ply").uv.empty());
    }
    CHECK(parse_ply(ascii_square, "m.ply").uv.empty());
}
