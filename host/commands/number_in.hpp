// Numbers and words on the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <vector>

namespace stokes {

// A number from low to high; unlike CLI::Range it refuses NaN.
CLI::Validator number_in(double low, double high);

// One of some words.
CLI::Validator word_of(const std::vector<std::string>& words);
// The place among words of one that word_of() let through.
std::size_t index_of_word(const std::string& word, const std::vector<std::string>& words);

}  // namespace stokes
