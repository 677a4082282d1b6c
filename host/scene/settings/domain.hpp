// What a value in a scene file, or of a flag, may be.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "host/core/words.hpp"
#include "host/scene/json_cursor.hpp"

namespace stokes {

struct OneWord {
    Words words;
};
struct YesNo {};
struct NumberOrAuto {
    NumberRange range;
};

using Domain = std::variant<NumberRange, IntegerRange, OneWord, YesNo, NumberOrAuto>;

// "number in (0, 1]", "plain|best": as --help and the documents have it.
std::string text_of(const Domain& domain);

}  // namespace stokes
