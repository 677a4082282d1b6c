// What readers of mesh files have in common.
#pragma once

#include <string>
#include <string_view>

#include "host/scene/mesh/file_mesh.hpp"

namespace stokes {

// The text without a byte order mark. InputError where it is UTF-16.
std::string_view without_mark(std::string_view text, const std::string& file);

// Line ends of old, a carriage return alone, made line feeds up to this byte.
void mend_line_ends(std::string& text, std::size_t end);
bool has_lone_returns(std::string_view text);

// "FILE:LINE: WHAT" of faces that cross themselves, the first of which is named by its place.
std::string crossing_remark(const std::string& place, std::size_t faces);

// Adds a remark where coordinates that were rounded to single precision have steps that show.
void remark_on_steps(FileMesh& mesh, const std::string& file);

}  // namespace stokes
