// Triangle meshes from PLY and OBJ files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/scene.hpp"

namespace stokes {

// Reads the mesh in a file by its ending, .ply or .obj, in the file's own units and without cleaning it.
// Polygons become fans of triangles. Throws InputError "FILE:LINE: ..." (binary parts: "FILE: vertex N: ...")
// for a file that cannot be read or is cut short, coordinates that are not finite, indices out of range, and
// a mesh without triangles.
Mesh read_mesh(const std::string& path);

// The same from text in memory; file only names it in messages.
// PLY: ascii, binary_little_endian or binary_big_endian 1.0, any numeric type; other elements and properties
// skipped.
Mesh parse_ply(std::string_view text, const std::string& file);
// OBJ: v and f, indices also negative and with /vt/vn; everything else ignored.
Mesh parse_obj(std::string_view text, const std::string& file);

}  // namespace stokes
