// The words by which scene files and the command line spell the values of an enum.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace stokes {

using Words = std::vector<std::string>;

// In the order of the enum's values; specialised beside each enum that has words.
template <class Enum>
extern const Words words_of;

template <class Enum>
const std::string& word_of(Enum value) {
    return words_of<Enum>[static_cast<std::size_t>(value)];
}

template <class Enum>
std::optional<Enum> value_of_word(const std::string& word) {
    const auto found = std::find(words_of<Enum>.begin(), words_of<Enum>.end(), word);
    if (found == words_of<Enum>.end()) return std::nullopt;
    return static_cast<Enum>(found - words_of<Enum>.begin());
}

}  // namespace stokes
