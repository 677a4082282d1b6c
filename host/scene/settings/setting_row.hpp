// Makes a row of the table of settings from the field that holds the setting.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "host/scene/settings/setting.hpp"

namespace stokes {

template <class T>
void read_value(const Domain& domain, const JsonCursor& where, T& value) {
    if constexpr (std::is_enum_v<T>)
        value = where.word<T>();
    else if constexpr (std::is_same_v<T, bool>)
        value = where.boolean();
    else if constexpr (std::is_integral_v<T>)
        value = static_cast<T>(where.integer(std::get<IntegerRange>(domain)));
    else
        value = where.number(std::get<NumberRange>(domain));
}

template <class T>
void read_value(const Domain& domain, const JsonCursor& where, std::optional<T>& value) {
    read_value(domain, where, value.emplace());
}

inline void read_value(const Domain& domain, const JsonCursor& where, std::optional<double>& value) {
    if (const auto* number_or_auto = std::get_if<NumberOrAuto>(&domain))
        value = where.number_or_auto(number_or_auto->range);
    else
        read_value(domain, where, value.emplace());
}

template <class T>
nlohmann::ordered_json value_as_json(const T& value) {
    if constexpr (std::is_enum_v<T>)
        return word_of(value);
    else
        return value;
}

inline nlohmann::ordered_json value_as_json(const std::optional<double>& value) {
    if (!value) return nullptr;
    return *value;
}

// A setting whose default is that of its field; void_value: what it is where it means nothing.
template <class T, class Void>
Setting row(T RenderSettings::*given, T ResolvedSettings::*field, Setting setting, Void void_value) {
    setting.read = [given, domain = setting.domain](const JsonCursor& where, Scene& scene) {
        read_value(domain, where, scene.render.*given);
    };
    setting.resolve = [=](const RenderSettings& from, ResolvedSettings& to) {
        to.*field = setting.complaint(to).empty() ? from.*given : void_value(to);
    };
    setting.fallback = [given](const ResolvedSettings&) { return value_as_json(RenderSettings().*given); };
    setting.value = [field](const ResolvedSettings& settings, const Film&) { return value_as_json(settings.*field); };
    return setting;
}

// A setting that always means something.
template <class T>
Setting row(T RenderSettings::*given, T ResolvedSettings::*field, Setting setting) {
    return row(given, field, std::move(setting), [given](const ResolvedSettings&) { return RenderSettings().*given; });
}

// A setting whose default depends on others; default_of: what it is where nobody says, and where it means nothing.
template <class T, class Default>
Setting row(std::optional<T> RenderSettings::*given, T ResolvedSettings::*field, Setting setting, Default default_of) {
    setting.read = [given, domain = setting.domain](const JsonCursor& where, Scene& scene) {
        read_value(domain, where, scene.render.*given);
    };
    setting.resolve = [=](const RenderSettings& from, ResolvedSettings& to) {
        to.*field = setting.complaint(to).empty() && from.*given ? *(from.*given) : default_of(to);
    };
    setting.fallback = [default_of](const ResolvedSettings& settings) { return value_as_json(default_of(settings)); };
    setting.value = [field](const ResolvedSettings& settings, const Film&) { return value_as_json(settings.*field); };
    return setting;
}

template <class T>
Setting row(T Film::*field, Setting setting) {
    setting.read = [field, domain = setting.domain](const JsonCursor& where, Scene& scene) {
        read_value(domain, where, scene.film.*field);
    };
    setting.resolve = [](const RenderSettings&, ResolvedSettings&) {};
    setting.fallback = [initial = Film().*field](const ResolvedSettings&) { return value_as_json(initial); };
    setting.value = [field](const ResolvedSettings&, const Film& film) { return value_as_json(film.*field); };
    return setting;
}

}  // namespace stokes
