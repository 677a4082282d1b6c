// STL files. The tetrahedron has the corners (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1): volume 1/6.
#include <cstring>

#include "tests/support/catch.hpp"
#include "tests/support/file_meshes.hpp"
#include "tests/support/input_error.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stokes;

namespace {

const float tetrahedron[4][3][3] = {{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}},
                                    {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},
                                    {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

std::string ascii(const std::string& end, bool capitals) {
    std::string text = std::string(capitals ? "SOLID" : "solid") + " a thing" + end;
    for (const auto& triangle : tetrahedron) {
        text += "  facet normal 0 0 0" + end + "    outer loop" + end;
        for (const auto& corner : triangle) {
            text += capitals ? "      VERTEX" : "      vertex";
            for (const float x : corner) text += x > 0 ? " 1.0e+00" : " 0";
            text += end;
        }
        text += "    endloop" + end + "  endfacet" + end;
    }
    return text + "endsolid a thing" + end;
}

std::string binary(const std::string& head) {
    std::string text = head;
    text.resize(80, ' ');
    const std::uint32_t count = 4;
    text.append(reinterpret_cast<const char*>(&count), 4);
    for (const auto& triangle : tetrahedron) {
        text.append(12, '\0');
        text.append(reinterpret_cast<const char*>(triangle), 36);
        text.append(2, '\0');
    }
    return text;
}

void check_tetrahedron(const FileMesh& mesh) {
    REQUIRE(mesh.triangles.size() == 4);
    CHECK(mesh_volume_mm3(as_read(mesh)) == Approx(1.0 / 6));
    CHECK(mesh.remarks.empty());
}

}  // namespace

TEST_CASE("STL is read, ascii with any line ends and binary, also where its head says solid", "[mesh_stl]") {
    for (const char* end : {"\n", "\r\n", "\r"})
        for (const bool capitals : {false, true}) check_tetrahedron(parse_stl(ascii(end, capitals), "m.stl"));
    check_tetrahedron(parse_stl(binary("made by hand"), "m.stl"));
    check_tetrahedron(parse_stl(binary("solid made by a program"), "m.stl"));
    const TemporaryFolder folder;
    put_file(folder.file("A.STL"), binary(""));
    check_tetrahedron(read_mesh(folder.file("A.STL")));
}

TEST_CASE("Bad STL is one line with file and place", "[mesh_stl]") {
    const auto error = [](const std::string& text) { return input_error([&] { parse_stl(text, "m.stl"); }); };
    const auto with = [](const std::string& what, const std::string& instead) {
        std::string text = ascii("\n", false);
        return text.replace(text.find(what), what.size(), instead);
    };
    CHECK(error("") == "m.stl:1: expected \"solid\", the first word of an ascii STL file");
    CHECK(error("solid\nendsolid\n") == "m.stl: no triangles");
    CHECK(error(with("vertex 0 0 0", "vertex 0 nan 0")) == "m.stl:4: expected 3 finite coordinates, got \"nan\"");
    CHECK(error(with("vertex 0 0 0", "vertex 0 0")) == "m.stl:4: expected 3 finite coordinates, got \"\"");
    CHECK(error(with("      vertex 0 0 0\n", "")) == "m.stl:6: expected a triangle, got 2 vertices");
    CHECK(error(ascii("\n", false).substr(0, 80)) == "m.stl:5: the file ends within a triangle");
    const std::string whole = binary("");
    CHECK(error(whole.substr(0, whole.size() - 1)) ==
          "m.stl: the header promises 4 triangles, but the file is too short for them");
    std::string infinite = whole;
    const float inf = INFINITY;
    infinite.replace(84 + 50 + 12, 4, reinterpret_cast<const char*>(&inf), 4);
    CHECK(error(infinite) == "m.stl: triangle 1: expected finite coordinates");
}
