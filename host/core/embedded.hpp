// Text files that travel inside the binary: kernels and CIE tables.
#pragma once

#include <map>
#include <string>

namespace stokes {

// Path below the project's root (for example "kernels/lib/rng.clh") -> text. Made at build time.
const std::map<std::string, std::string>& embedded_files();

}  // namespace stokes
