// What a value in a scene file, or of a flag, may be.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>

#include "host/core/json_cursor.hpp"
#include "host/core/words.hpp"

namespace stokes {

struct OneWord {
    Words words;
};
struct YesNo {};
struct NumberOrAuto {
    NumberRange range;
};
struct Text {};     // not empty
struct OwnName {};  // fit for a file name
struct NameIn {     // of the names in this part of the scene: "media"
    std::string part;
};
struct Vector {  // of three numbers
    NumberRange range = place_range;
};
struct Direction {};  // of any length but zero
// What another declaration of the schema says: an object, or a value that its reader checks.
struct Declared {
    std::string kind;
};
struct SpectrumUpTo {
    double maximum;
};
struct ListOf {
    std::string kind;
    std::size_t least = 0;  // items
};
struct ByName {  // values of this kind, each with a name
    std::string kind;
};

using Domain = std::variant<NumberRange, IntegerRange, OneWord, YesNo, NumberOrAuto, Text, OwnName, NameIn, Vector,
                            Direction, Declared, SpectrumUpTo, ListOf, ByName>;

inline constexpr double largest_spectrum_value = 1e12;
inline const Domain any_spectrum = SpectrumUpTo{largest_spectrum_value};

// "number in (0, 1]", "plain|best": of a setting's domain, as --help and the documents have it.
std::string text_of(const Domain& domain);

// As JSON schema.
nlohmann::ordered_json schema_of(const Domain& domain);

// InputError where the value is out of the domain, as far as the value alone shows it: what other parts of the scene
// decide, lists and objects are left to their readers.
void check_value(const Domain& domain, const JsonCursor& where);

}  // namespace stokes
