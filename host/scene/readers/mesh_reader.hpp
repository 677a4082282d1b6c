// Triangle meshes from PLY, OBJ and STL files.
#pragma once

#include <string>
#include <string_view>

#include "host/scene/mesh/file_mesh.hpp"

namespace stokes {

// Reads the mesh in a file by its ending, .ply, .obj or .stl in letters of either case, in the file's own units and
// without cleaning it. Polygons are cut into triangles. Throws InputError "FILE:LINE: ..." (binary parts: "FILE: vertex
// N:
// ...") for a file that cannot be read or is cut short, coordinates that are not finite, indices out of range, and a
// mesh without triangles.
FileMesh read_mesh(const std::string& path);

// The same from text in memory; file only names it in messages. Lines end in a line feed, a carriage return or both.
// PLY: ascii, binary_little_endian or binary_big_endian 1.0, any numeric type; vertices may have texture
// coordinates, u and v, s and t, or texture_u and texture_v, and so may the corners of faces, as lists texcoord or
// texcoords, which go before; other elements and properties skipped.
FileMesh parse_ply(std::string_view text, const std::string& file);
// OBJ: v, vt and f, indices also negative and with /vt/vn, and the names of usemtl and o; everything else ignored.
// Where a corner has no vt, or one that does not exist, the mesh has no texture coordinates. In files (0, 0) is a
// picture's bottom left corner; in the mesh it is the top left one.
FileMesh parse_obj(std::string_view text, const std::string& file);
// STL: ascii, or binary as its size tells; every triangle has corners of its own, and the order of these says where the
// outside is, not the normals.
FileMesh parse_stl(std::string_view text, const std::string& file);

}  // namespace stokes
