// Numbers, words and names on the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <vector>

namespace stokes {

// A number from low to high; unlike CLI::Range it refuses NaN.
CLI::Validator number_in(double low, double high);

// One of some words.
CLI::Validator one_of_words(const std::vector<std::string>& words);

// The name of an output: not empty, which a script's variable may be.
CLI::Validator output_name();

}  // namespace stokes
