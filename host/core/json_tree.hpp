// A JSON text as a tree in which every value and every key knows its line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stokes {

struct JsonKey {
    std::string name;
    int line = 0;
};

struct JsonValue {
    enum class Type { null, boolean, number, string, array, object };
    Type type = Type::null;
    int line = 0;  // of its first character, from 1
    bool boolean = false;
    double number = 0.0;
    std::string text;
    std::vector<JsonKey> keys;     // of an object, in the order of the file, each once
    std::vector<JsonValue> items;  // of an array; of an object: items[i] belongs to keys[i]
};

// file only names the text in messages. Throws InputError "FILE:LINE: ..." for syntax errors, numbers too
// large for a double, an object with a key twice, and values nested deeper than 32.
JsonValue parse_json(std::string_view text, const std::string& file);

}  // namespace stokes
