// The objects of a scene file: what a key may hold, and reading by what is declared.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "host/core/json_cursor.hpp"
#include "host/scene/settings/domain.hpp"
#include "host/scene/settings/limited_key.hpp"

namespace stokes {

enum class Presence { required, optional };
inline constexpr Presence required = Presence::required, optional = Presence::optional;

// What sets a key apart from most.
struct KeyTraits {
    std::vector<Transport> transports = {};  // the only ones in which it has an effect; none: all
    std::string unless = {};                 // where this other key is missing it has an effect in all transports
};

struct Key {
    std::string name;
    Domain domain;
    std::variant<Presence, bool, int, double, std::string> fallback;  // whether it must be there, or its default
    std::string help;                                                 // without its transports
    KeyTraits traits = {};

    // The help with its transports, as the schema has it.
    std::string sentence() const;
};

// An object, or a choice of objects.
struct ObjectDeclaration {
    std::string kind;  // as the schema calls it
    std::string help;
    std::vector<Key> keys = {};
    std::vector<std::string> exactly_one = {};   // of these keys
    std::string rules = {};                      // what keys alone do not say, as JSON schema
    std::vector<std::string> alternatives = {};  // of a choice: kinds, told apart by `type`, `section` or the first key
};

// One of objects(); a kind that is not there is an error of the program.
const ObjectDeclaration& declared_object(const std::string& kind);

// An object of a scene file that has the declared keys, with values in their domains.
class ObjectReader : public JsonCursor {
  public:
    // kind: of an object, or of a choice. InputError.
    ObjectReader(const JsonCursor& where, const std::string& kind);

    // "shape_box", where the kind asked for was "shape".
    const std::string& kind() const { return object_->kind; }

    // Of a kind that is declared and that the caller has no code for: an error of the program, RunError.
    [[noreturn]] void fail_unread() const;

    // The key's value, or its default. vector, direction, name: of keys that are there.
    double number(const std::string& key) const;
    int integer(const std::string& key) const;
    bool boolean(const std::string& key) const;
    glm::dvec3 vector(const std::string& key) const { return at(key).vector(key_of<Vector>(key).range); }
    glm::dvec3 direction(const std::string& key) const { return at(key).direction(); }
    // Of the keys of which exactly one may be there, that one.
    std::string exactly_one() const { return one_of(object_->exactly_one); }
    // Keys that are there, with another value than their default, and have an effect in some transports only.
    std::vector<LimitedKey> limited_keys() const;
    // Of a key whose values are spectra.
    double maximum(const std::string& key) const { return key_of<SpectrumUpTo>(key).maximum; }

  private:
    const Key& key_of(const std::string& key) const;
    template <class D>
    const D& key_of(const std::string& key) const {
        return std::get<D>(key_of(key).domain);
    }

    const ObjectDeclaration* object_;
};

}  // namespace stokes
