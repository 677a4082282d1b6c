// Mesh files as other programs write them. The shapes are known by hand.
#include <cstring>

#include "host/scene/readers/mesh_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;
using Catch::Matchers::StartsWith;

namespace {

const std::string obj = "# a square\nv 0 0 0\nv 2 0 0\nv 2 0 3.5\nv 0 0 3.5\nf 1 2 3 4\n";
const std::string ply =
    "ply\nformat ascii 1.0\nobj_info made by hand\nelement vertex 4\ncomment in between\nproperty double x\n"
    "property double y\nproperty double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n2 0 0\n2 0 3.5\n0 0 3.5\n4 0 1 2 3\n";

std::string with_ends(std::string text, const std::string& end) {
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + end.size()))
        text.replace(at, 1, end);
    return text;
}

void check_square(const FileMesh& mesh) {
    REQUIRE(mesh.positions.size() == 4);
    CHECK(mesh.positions[2] == glm::dvec3(2, 0, 3.5));
    CHECK(mesh.triangles == std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}});
    CHECK(mesh.remarks.empty());
}

using Uv = std::array<glm::dvec2, 3>;

// A square with texture coordinates of the corners of its faces.
std::string wedge_ply(const std::string& list, const std::string& first, const std::string& vertex_uv = "") {
    const std::string s = vertex_uv.empty() ? "" : "property float s\nproperty float t\n";
    const std::string v = vertex_uv.empty() ? "" : " " + vertex_uv;
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" + s +
           "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float " + list +
           "\nproperty int texnumber\nend_header\n0 0 0" + v + "\n1 0 0" + v + "\n1 1 0" + v + "\n0 1 0" + v + "\n" +
           first + "\n3 0 2 3 6 0.5 0 1 0.75 0.5 1 0\n";
}

}  // namespace

TEST_CASE("Lines end in a line feed, a carriage return or both", "[mesh_dialects]") {
    for (const char* end : {"\n", "\r\n", "\r"}) {
        check_square(parse_obj(with_ends(obj, end), "m.obj"));
        check_square(parse_ply(with_ends(ply, end), "m.ply"));
        CHECK_THAT(input_error([&] { parse_obj(with_ends(obj + "f 1 2\n", end), "m.obj"); }), StartsWith("m.obj:7: "));
        CHECK_THAT(input_error([&] { parse_ply(with_ends(ply.substr(0, ply.size() - 2) + "9\n", end), "m.ply"); }),
                   StartsWith("m.ply:16: face 0: vertex index 9"));
    }
}

// The first byte of the body is a line feed, which must not be taken for part of the header's last line end.
TEST_CASE("A binary PLY file may have a header whose lines end in carriage returns", "[mesh_dialects]") {
    std::string text = with_ends(
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty int x\nproperty int y\nproperty int z\n"
        "element face 1\nproperty list uchar uchar vertex_indices\nend_header\n",
        "\r");
    const std::int32_t corners[4][3] = {{10, 13, 3338}, {12, 13, 3338}, {12, 16, 3338}, {10, 16, 3338}};
    text.append(reinterpret_cast<const char*>(corners), sizeof corners);
    text += std::string("\4\0\1\2\3", 5);
    const FileMesh mesh = parse_ply(text, "m.ply");
    CHECK(mesh.positions[0] == glm::dvec3(10, 13, 3338));
    CHECK(mesh.positions[3] == glm::dvec3(10, 16, 3338));
    CHECK(mesh.triangles == std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}});
}

TEST_CASE("A byte order mark is stepped over; UTF-16 is refused in words", "[mesh_dialects]") {
    check_square(parse_obj("\xef\xbb\xbf" + obj.substr(obj.find('v')), "m.obj"));
    check_square(parse_ply("\xef\xbb\xbf" + ply, "m.ply"));
    CHECK(input_error([&] { parse_obj(std::string("\xff\xfev\0", 4), "m.obj"); }) ==
          "m.obj: expected UTF-8 text, got UTF-16");
}

TEST_CASE("OBJ lines go on behind a backslash", "[mesh_dialects]") {
    for (const char* end : {"\n", "\r\n", "\r"}) {
        check_square(
            parse_obj(with_ends("v 0 0 \\\n0\nv 2\\\n 0 0\nv 2 0 3.5\nv 0 0 3.5\nf 1 2 \\\n  3 \\\n4\n", end), "m"));
    }
    CHECK_THAT(input_error([] { parse_obj("v 0 0 \\", "m.obj"); }), StartsWith("m.obj:1: expected 3 finite"));
    // Elsewhere a backslash is a letter.
    check_square(parse_obj("mtllib C:\\things\\\n" + obj, "m.obj"));
}

TEST_CASE("OBJ lines of other kinds, blanks at their ends and numbers of any form", "[mesh_dialects]") {
    check_square(
        parse_obj("g\no thing\ns 1\nl 1 2\np 1\nvp 0.5\nv 0 0 0 \nv +2.0 0E0 -0\t\nv 2e0 0 3.5e+0\n"
                  "vn 0 1 0\nv 0 .0 35e-1\nf 1//1 2//1 3//1 4//1  \n",
                  "m.obj"));
    check_square(parse_obj("v 0 0 0\nv 2 0 0\nv 2 0 3.5\nv 0 0 3.5\nfo -4 -3 -2 -1", "m.obj"));
    CHECK(input_error([] { parse_obj("v 0 0 0\np 1\n", "m.obj"); }) == "m.obj: no triangles, only points");
}

TEST_CASE("Endings of mesh files may be in capitals", "[mesh_dialects]") {
    const TemporaryFolder folder;
    put_file(folder.file("A.PLY"), ply);
    put_file(folder.file("A.Obj"), obj);
    check_square(read_mesh(folder.file("A.PLY")));
    check_square(read_mesh(folder.file("A.Obj")));
}

TEST_CASE("Coordinates are read as doubles", "[mesh_dialects]") {
    CHECK(parse_obj("v 4080928.0166 0 0\nv 4080929 0 0\nv 4080928 1 0\nf 1 2 3\n", "m").positions[0].x == 4080928.0166);
    const std::string far = std::string(ply).replace(ply.find("2 0 3.5"), 7, "4080928.0166 0 1");
    CHECK(parse_ply(far, "m.ply").positions[2].x == 4080928.0166);
}

TEST_CASE("PLY faces have texture coordinates of their corners, which go before those of vertices", "[mesh_dialects]") {
    for (const char* list : {"texcoord", "texcoords"})
        for (const char* vertex_uv : {"", "0.125 0.125"}) {
            const FileMesh mesh = parse_ply(wedge_ply(list, "3 0 1 2 6 0 0 1 0 1 1 0", vertex_uv), "m.ply");
            REQUIRE(mesh.uv.size() == 2);
            CHECK(mesh.uv[0] == Uv{glm::dvec2(0, 1), glm::dvec2(1, 1), glm::dvec2(1, 0)});
            CHECK(mesh.uv[1] == Uv{glm::dvec2(0.5, 1), glm::dvec2(1, 0.25), glm::dvec2(0.5, 0)});
            CHECK(mesh.remarks.empty());
        }
    // A quadrilateral has eight.
    const FileMesh quad = parse_ply(wedge_ply("texcoord", "4 0 1 2 3 8 0 0 1 0 1 1 0 1 -1"), "m.ply");
    REQUIRE(quad.uv.size() == 3);
    CHECK(quad.uv[1] == Uv{glm::dvec2(0, 1), glm::dvec2(1, 0), glm::dvec2(0, 0)});
}

TEST_CASE("PLY texture coordinates of corners that do not fit leave those of vertices, or a reason",
          "[mesh_dialects]") {
    const FileMesh short_list = parse_ply(wedge_ply("texcoord", "3 0 1 2 4 0 0 1 0 0"), "m.ply");
    CHECK(short_list.uv.empty());
    CHECK(short_list.uv_fault == "m.ply:16: face 0: expected 2 texture coordinates for each of 3 corners, got 4");
    CHECK(parse_ply(wedge_ply("texcoord", "3 0 1 2 6 0 0 1 nan 0 0 0"), "m.ply").uv.empty());
    const FileMesh vertices = parse_ply(wedge_ply("texcoord", "3 0 1 2 0 0", "0.125 0.25"), "m.ply");
    CHECK(vertices.uv_fault.empty());
    REQUIRE(vertices.uv.size() == 2);
    CHECK(vertices.uv[0][1] == glm::dvec2(0.125, 0.75));
}

TEST_CASE("PLY faces of several pictures are told", "[mesh_dialects]") {
    const FileMesh mesh = parse_ply(wedge_ply("texcoord", "3 0 1 2 6 0 0 1 0 1 1 1"), "m.ply");
    REQUIRE(mesh.remarks.size() == 1);
    CHECK(mesh.remarks[0] == "m.ply: its faces have 2 pictures (texnumber); a texture lies on all of them");
}

// The U has an area of 32; a fan from its first corner would fill the notch, 16 more, and cover parts of it twice.
TEST_CASE("Concave faces are cut so that they cover what they enclose, with their texture coordinates",
          "[mesh_dialects]") {
    const int u[8][2] = {{0, 0}, {8, 0}, {8, 6}, {6, 6}, {6, 2}, {2, 2}, {2, 6}, {0, 6}};
    std::string in_obj, in_ply =
                            "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
                            "property list uchar float texcoord\nelement vertex 8\nproperty float x\n"
                            "property float y\nproperty float z\nend_header\n8 0 1 2 3 4 5 6 7 16";
    std::string face = "f", vertices;
    for (int i = 0; i < 8; ++i) {
        const std::string x = std::to_string(u[i][0]), y = std::to_string(u[i][1]);
        in_obj += "v " + x + " " + y + " 0\nvt " + x + " " + y + "\n";
        face += " " + std::to_string(i + 1) + "/" + std::to_string(i + 1);
        in_ply += " " + x + " " + y;
        vertices += x + " " + y + " 0\n";
    }
    for (const FileMesh& mesh : {parse_obj(in_obj + face, "m.obj"), parse_ply(in_ply + "\n" + vertices, "m.ply")}) {
        REQUIRE(mesh.triangles.size() == 6);
        REQUIRE(mesh.uv.size() == 6);
        double area = 0.0;
        for (std::size_t i = 0; i < 6; ++i) {
            const glm::uvec3& t = mesh.triangles[i];
            const double part =
                0.5 *
                glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]).z;
            CHECK(part > 0.0);
            area += part;
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3& p = mesh.positions[t[k]];
                CHECK(mesh.uv[i][static_cast<std::size_t>(k)] == glm::dvec2(p.x, 1.0 - p.y));
            }
        }
        CHECK(area == 32.0);
        CHECK(mesh.remarks.empty());
    }
}

TEST_CASE("Faces that cross themselves are told, the first by its place", "[mesh_dialects]") {
    const std::string corners = "v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 2 0\n";
    CHECK(parse_obj(corners + "f 1 2 3 4\n", "m.obj").remarks ==
          std::vector<std::string>{
              "m.obj:5: this face crosses itself, so parts of it may overlap or be seen from behind"});
    CHECK_THAT(parse_obj(corners + "f 1 3 2 4\nf 1 2 3 4\nf 4 3 2 1\n", "m.obj").remarks[0],
               StartsWith("m.obj:6: this face and 1 more cross themselves"));
}

TEST_CASE("The materials and objects of an OBJ file are known by name", "[mesh_dialects]") {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    const FileMesh mesh = parse_obj(
        vertices +
            "f 1 2 3\no A\nusemtl red glass \t\nf 1 2 3 4\no B\nusemtl b.001\r\nf 2 3 4\nusemtl red glass\nf 1 3 4\n"
            "o C\nusemtl never\n",
        "m.obj");
    CHECK(mesh.materials == std::vector<std::string>{"", "red glass", "b.001"});
    CHECK(mesh.material == std::vector<std::uint32_t>{0, 1, 1, 2, 1});
    CHECK(mesh.objects == 2);
}

// Singles have steps of 0.5 at 4e6, doubles of 5e-10.
TEST_CASE("PLY coordinates that single precision has made coarse are told", "[mesh_dialects]") {
    const auto text = [](const std::string& type, const std::string& x) {
        std::string xyz;
        for (const char* axis : {"x", "y", "z"}) xyz += "property " + type + " " + axis + "\n";
        return "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz +
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + x + " 0 0\n" + x + " 100 0\n" +
               x + " 0 50\n3 0 1 2\n";
    };
    CHECK_THAT(
        parse_ply(text("float", "4080928"), "m.ply").remarks.at(0),
        StartsWith("m.ply: its coordinates are in single precision (float) with steps of 0.49, far from their origin"));
    CHECK(parse_ply(text("double", "4080928"), "m.ply").remarks.empty());
    CHECK(parse_ply(text("float", "4080"), "m.ply").remarks.empty());
}

TEST_CASE("What a mesh file has beside its faces is told where it is not read", "[mesh_dialects]") {
    const auto remark = [](const FileMesh& mesh) {
        REQUIRE(mesh.remarks.size() == 1);
        return mesh.remarks[0];
    };
    CHECK(remark(parse_obj(obj + "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nend\ncurv 0 1 1 2\nend\n", "m.obj")) ==
          "m.obj:9: 2 free forms are not read (curv, surf ..), only faces");
    const std::string tail = "end_header";
    std::string strips = ply;
    strips.insert(strips.find(tail), "element tristrips 1\nproperty list int int vertex_indices\n");
    CHECK(remark(parse_ply(strips + "3 0 1 2\n", "m.ply")) == "m.ply: its element tristrips is not read, only faces");
    std::string edges = ply;
    edges.insert(edges.find(tail), "element edge 1\nproperty int a\nproperty int b\n");
    check_square(parse_ply(edges + "0 1\n", "m.ply"));
    check_square(parse_ply(ply + "\n \n", "m.ply"));
    CHECK(remark(parse_ply(ply + "3 0 1 2\n", "m.ply")) ==
          "m.ply: it goes on after all that its header promises, which is not read");
    CHECK_THAT(remark(parse_ply(edges, "m.ply")), StartsWith("m.ply: the header promises 1 of element edge"));
}

TEST_CASE("Faces of a PLY file that have several materials are told", "[mesh_dialects]") {
    const auto text = [](const std::string& second) {
        return "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
               "element face 2\nproperty list uchar int vertex_indices\nproperty int material_index\nend_header\n"
               "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0\n3 0 2 1 " +
               second + "\n";
    };
    CHECK(parse_ply(text("0"), "m.ply").remarks.empty());
    const FileMesh two = parse_ply(text("3"), "m.ply");
    REQUIRE(two.remarks.size() == 1);
    CHECK(two.remarks[0] == "m.ply: its faces have 2 materials (material_index), which are not told apart");
}
