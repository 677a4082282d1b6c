// Messages for the person at the terminal, on standard error.
#pragma once

#include <string>

namespace stokes {

// "stokes: warning: TEXT", once per distinct text in the life of the process.
void warn(const std::string& text);

}  // namespace stokes
