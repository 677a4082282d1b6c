// A place in a JSON tree that knows its file, line and key path, so that every complaint names them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/core/json_tree.hpp"
#include "host/core/words.hpp"

namespace stokes {

// Bounds of a number; the open ends are excluded.
struct NumberRange {
    double low;
    double high;
    bool low_open = false;
    bool high_open = false;

    bool contains(double x) const;
    std::string text() const;  // "in (0, 1]"
};

struct IntegerRange {
    std::int64_t low;
    std::int64_t high;
};

// Any length or coordinate [mm] of a scene about its own origin: up to 10 km. Single precision has steps of 1 mm there.
inline constexpr NumberRange coordinate_range{-1e7, 1e7};
// A place [mm] in the coordinates of a scene's file: up to 100,000 km.
inline constexpr NumberRange place_range{-1e11, 1e11};
inline constexpr NumberRange length_range{0.0, 1e7, true};

// All readers below throw InputError "FILE:LINE: KEY.PATH: expected ..., got ...", or without a file, for a flag,
// "PATH: expected ..., got ...".
// The tree and the file name must outlive the cursor.
class JsonCursor {
  public:
    JsonCursor(const JsonValue& value, const std::string& file, std::string path = {})
        : value_(&value), file_(&file), path_(std::move(path)) {}

    const std::string& file() const { return *file_; }
    const std::string& path() const { return path_; }
    bool is(JsonValue::Type type) const { return value_->type == type; }

    [[noreturn]] void fail(const std::string& what) const;
    // The same words for a warning: "FILE:LINE: KEY.PATH: WHAT".
    std::string at_place(const std::string& what) const;
    // what: "a number in [0, 1]"; the text adds what is there instead.
    [[noreturn]] void fail_expected(const std::string& what) const;
    // The text here is no name in this part of the scene ("media"), which has these names.
    [[noreturn]] void fail_undefined(const std::string& part, const std::vector<std::string>& names) const;

    // Objects. expect_keys: unknown and missing keys are errors.
    void expect_object() const;
    void expect_keys(const std::vector<std::string>& known, const std::vector<std::string>& needed) const;
    bool has(const std::string& key) const { return find(key).has_value(); }
    std::optional<JsonCursor> find(const std::string& key) const;
    JsonCursor at(const std::string& key) const;
    // The one key of the list that the object has; none or several are errors.
    std::string one_of(const std::vector<std::string>& keys) const;
    // Members with their names, whatever these are.
    std::vector<std::pair<std::string, JsonCursor>> members() const;
    // Members with their names, which must be fit for file names.
    std::vector<std::pair<std::string, JsonCursor>> named_members() const;

    // Arrays.
    std::vector<JsonCursor> items() const;

    // Values.
    bool boolean() const;
    double number(const NumberRange& range) const;
    // None for the word "auto".
    std::optional<double> number_or_auto(const NumberRange& range) const;
    std::int64_t integer(std::int64_t low, std::int64_t high) const;
    std::int64_t integer(const IntegerRange& range) const { return integer(range.low, range.high); }
    const std::string& text() const;
    // A name that may become part of a file name: letters, digits, space, _ - and . inside, at most 64.
    const std::string& name() const;
    // One of these words; returns its index.
    std::size_t choice(const std::vector<std::string>& words) const;
    // count numbers; any number of them where it is 0.
    std::vector<double> numbers(const NumberRange& range, std::size_t count = 0) const;
    template <class Enum>
    Enum word() const {
        return static_cast<Enum>(choice(words_of<Enum>));
    }
    glm::dvec3 vector(const NumberRange& range = place_range) const;
    // A vector scaled to length 1; a zero vector is an error.
    glm::dvec3 direction() const;

  private:
    std::string got() const;
    JsonCursor member(std::size_t index) const;
    std::string at_line(int line, const std::string& what) const;
    [[noreturn]] void fail_at(int line, const std::string& what) const;

    const JsonValue* value_;
    const std::string* file_;
    std::string path_;
};

}  // namespace stokes
