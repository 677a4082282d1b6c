#include "tests/support/paths.hpp"

namespace stokes {

std::string stokes_program() { return STOKES_BINARY; }

std::string source_path(const std::string& path) { return STOKES_SOURCE_DIR "/" + path; }

}  // namespace stokes
