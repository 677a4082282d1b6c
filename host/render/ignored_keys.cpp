#include "host/render/ignored_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "host/render/transport/transport_model.hpp"

namespace stokes {

namespace {

using Transports = std::set<Transport>;

// The transports of the bodies that have each object, by index; none: nothing has it.
struct Uses {
    std::map<int, Transports> materials, media, fluorophores;

    void add(const Scene& scene, int material, Transport transport) {
        materials[material].insert(transport);
        const auto* translucent = as_translucent(scene.materials[static_cast<std::size_t>(material)]);
        if (translucent == nullptr) return;
        if (translucent->medium) media[*translucent->medium].insert(transport);
        for (const Dye& dye : translucent->dyes) fluorophores[dye.fluorophore].insert(transport);
    }
};

Uses uses_of(const Scene& scene) {
    Uses uses;
    for (const Shape& shape : scene.shapes) uses.add(scene, shape.material, transport_of_body(scene, shape.body));
    return uses;
}

std::string quoted(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", name);
    return text;
}

std::string words_of_all(const Transports& transports) {
    std::string text;
    for (const Transport transport : transports)
        text += fmt::format("{}\"{}\"", text.empty() ? "" : " and ", word_of(transport));
    return text;
}

// A line for each key and the transports that ignore it, with the names of its objects.
template <class Object>
void add_ignored(const std::string& part, const std::vector<Object>& objects, const std::map<int, Transports>& uses,
                 std::vector<std::string>& lines) {
    std::map<std::pair<std::string, Transports>, std::vector<std::string>> found;
    for (const auto& [index, transports] : uses) {
        const Object& object = objects[static_cast<std::size_t>(index)];
        for (const LimitedKey& key : object.limited_keys) {
            const auto takes = [&](Transport t) {
                return std::find(key.transports.begin(), key.transports.end(), t) != key.transports.end();
            };
            if (std::none_of(transports.begin(), transports.end(), takes))
                found[{key.name, transports}].push_back(object.name);
        }
    }
    for (const auto& [key, names] : found)
        lines.push_back(
            fmt::format("{}: transport {} ignores {} of {}", part, words_of_all(key.second), key.first, quoted(names)));
}

std::vector<std::string> ignored(const Scene& scene, const Uses& uses) {
    std::vector<std::string> lines;
    add_ignored("media", scene.media, uses.media, lines);
    add_ignored("fluorophores", scene.fluorophores, uses.fluorophores, lines);
    add_ignored("materials", scene.materials, uses.materials, lines);
    return lines;
}

template <class Object>
std::vector<std::string> unused(const std::vector<Object>& objects, const std::map<int, Transports>& uses) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < objects.size(); ++i)
        if (uses.count(static_cast<int>(i)) == 0) names.push_back(objects[i].name);
    return names;
}

}  // namespace

std::vector<std::string> ignored_keys(const Scene& scene) {
    const Uses uses = uses_of(scene);
    std::vector<std::string> lines = ignored(scene, uses);
    for (std::string& line : lines) line = fmt::format("{}: {}", scene.file, line);
    return lines;
}

std::string unused_objects(const Scene& scene) {
    const Uses uses = uses_of(scene);
    std::string parts;
    const auto add_unused = [&](const char* part, const std::vector<std::string>& names) {
        if (!names.empty()) parts += fmt::format("{}{} {}", parts.empty() ? "" : "; ", part, quoted(names));
    };
    add_unused("materials", unused(scene.materials, uses.materials));
    add_unused("media", unused(scene.media, uses.media));
    add_unused("fluorophores", unused(scene.fluorophores, uses.fluorophores));
    add_unused("spectra", scene.unused_spectra);
    return parts.empty() ? "" : fmt::format("{}: nothing in the picture uses {}", scene.file, parts);
}

std::vector<std::string> ignored_keys(const Scene& scene, const Material& material, Transport transport) {
    Uses uses;
    uses.add(scene, static_cast<int>(&material - scene.materials.data()), transport);
    std::vector<std::string> lines = ignored(scene, uses);
    for (std::string& line : lines) line = fmt::format("{}: {}", scene.file, line);
    return lines;
}

}  // namespace stokes
