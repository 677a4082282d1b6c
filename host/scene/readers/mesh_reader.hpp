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
// PLY: ascii, binary_little_endian or binary_big_endian 1.0, any numeric type; vertices may have texture
// coordinates, u and v, s and t, or texture_u and texture_v; other elements and properties skipped.
Mesh parse_ply(std::string_view text, const std::string& file);
// OBJ: v, vt and f, indices also negative and with /vt/vn; everything else ignored. Where a corner has no vt,
// or one that does not exist, the mesh has no texture coordinates. In files (0, 0) is a picture's bottom left
// corner; in the mesh it is the top left one.
Mesh parse_obj(std::string_view text, const std::string& file);

}  // namespace stokes
