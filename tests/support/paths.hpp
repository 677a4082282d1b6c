// Where the tests find the program and the repository's files.
#pragma once

#include <string>

namespace stokes {

std::string stokes_program();

// path: from the root of the repository.
std::string source_path(const std::string& path);

}  // namespace stokes
