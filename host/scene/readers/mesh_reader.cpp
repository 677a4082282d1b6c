#include "host/scene/readers/mesh_reader.hpp"

#include <algorithm>
#include <cctype>

#include "host/core/error.hpp"
#include "host/core/text_input.hpp"

namespace stokes {

FileMesh read_mesh(const std::string& path) {
    std::string ending = path.size() < 4 ? std::string() : path.substr(path.size() - 4);
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    if (ending == ".ply") return parse_ply(read_file(path), path);
    if (ending == ".obj") return parse_obj(read_file(path), path);
    if (ending == ".stl") return parse_stl(read_file(path), path);
    throw InputError(path + ": expected a mesh file that ends in .ply, .obj or .stl");
}

}  // namespace stokes
