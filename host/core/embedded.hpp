// Files that travel inside the binary: kernels, CIE tables and Green's function tables.
#pragma once

#include <map>
#include <string>

namespace stokes {

// Path below the project's root (for example "kernels/lib/rng.clh") -> content.
// Made at build time.
const std::map<std::string, std::string>& embedded_files();

}  // namespace stokes
