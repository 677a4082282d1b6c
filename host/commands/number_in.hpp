// Numbers on the command line.
#pragma once

#include <CLI/CLI.hpp>

namespace stokes {

// A number from low to high; unlike CLI::Range it refuses NaN.
CLI::Validator number_in(double low, double high);

}  // namespace stokes
