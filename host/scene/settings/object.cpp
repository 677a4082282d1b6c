#include "host/scene/settings/object.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "host/core/error.hpp"
#include "host/scene/settings/objects.hpp"

namespace stokes {
namespace {

const Key* find_key(const ObjectDeclaration& object, const std::string& name) {
    const auto found =
        std::find_if(object.keys.begin(), object.keys.end(), [&](const Key& key) { return key.name == name; });
    return found == object.keys.end() ? nullptr : &*found;
}

// The words that a key has in each of some objects: their types, or their sections.
Words words_at(const std::string& key, const std::vector<const ObjectDeclaration*>& objects) {
    Words words;
    for (const ObjectDeclaration* object : objects) {
        const Key* found = find_key(*object, key);
        if (!found) return {};
        const std::string& word = std::get<OneWord>(found->domain).words.front();
        if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
    }
    return words;
}

const ObjectDeclaration& alternative_at(const JsonCursor& where, const ObjectDeclaration& choice) {
    if (choice.alternatives.empty()) return choice;
    std::vector<const ObjectDeclaration*> left;
    for (const std::string& kind : choice.alternatives) left.push_back(&declared_object(kind));
    if (!find_key(*left.front(), "type")) {
        std::vector<std::string> first_keys;
        for (const ObjectDeclaration* object : left) first_keys.push_back(object->keys.front().name);
        const std::string key = where.one_of(first_keys);
        return *left[static_cast<std::size_t>(std::find(first_keys.begin(), first_keys.end(), key) -
                                              first_keys.begin())];
    }
    for (const char* key : {"type", "section"}) {
        const Words words = words_at(key, left);
        if (left.size() == 1 || words.empty()) break;
        const std::string& word = words[where.at(key).choice(words)];
        const auto other = [&](const ObjectDeclaration* object) { return words_at(key, {object}).front() != word; };
        left.erase(std::remove_if(left.begin(), left.end(), other), left.end());
    }
    return *left.front();
}

}  // namespace

const ObjectDeclaration& declared_object(const std::string& kind) {
    for (const ObjectDeclaration& object : scene_objects())
        if (object.kind == kind) return object;
    throw std::logic_error("no object of a scene is declared as " + kind);
}

ObjectReader::ObjectReader(const JsonCursor& where, const std::string& kind)
    : JsonCursor(where), object_(&alternative_at(where, declared_object(kind))) {
    std::vector<std::string> known, needed;
    for (const Key& key : object_->keys) {
        known.push_back(key.name);
        const auto* presence = std::get_if<Presence>(&key.fallback);
        if (presence && *presence == required) needed.push_back(key.name);
    }
    expect_keys(known, needed);
    for (const Key& key : object_->keys)
        if (const auto value = find(key.name)) check_value(key.domain, *value);
}

const Key& ObjectReader::key_of(const std::string& key) const {
    if (const Key* found = find_key(*object_, key)) return *found;
    throw std::logic_error(object_->kind + " declares no key " + key);
}

double ObjectReader::number(const std::string& key) const {
    const auto value = find(key);
    return value ? value->number(key_of<NumberRange>(key)) : std::get<double>(key_of(key).fallback);
}

std::string Key::sentence() const {
    std::string words;
    for (const Transport transport : traits.transports)
        words += fmt::format("{}{}", words.empty() ? "" : " and ", word_of(transport));
    return words.empty() ? help : fmt::format("{} For transport {}.", help, words);
}

std::vector<LimitedKey> ObjectReader::limited_keys() const {
    std::vector<LimitedKey> limited;
    for (const Key& key : object_->keys) {
        if (key.traits.transports.empty() || !has(key.name)) continue;
        if (!key.traits.unless.empty() && !has(key.traits.unless)) continue;
        const auto* number_default = std::get_if<double>(&key.fallback);
        if (number_default && number(key.name) == *number_default) continue;
        const auto* yes_default = std::get_if<bool>(&key.fallback);
        if (yes_default && boolean(key.name) == *yes_default) continue;
        limited.push_back({key.name, key.traits.transports});
    }
    return limited;
}

void ObjectReader::fail_unread() const { throw RunError(kind() + " is declared, but nothing reads it"); }

int ObjectReader::integer(const std::string& key) const {
    const auto value = find(key);
    return value ? static_cast<int>(value->integer(key_of<IntegerRange>(key))) : std::get<int>(key_of(key).fallback);
}

bool ObjectReader::boolean(const std::string& key) const {
    const auto value = find(key);
    return value ? value->boolean() : std::get<bool>(key_of(key).fallback);
}

}  // namespace stokes
