// Media, fluorophores and materials of a scene file. All throw InputError.
#pragma once

#include <vector>

#include "host/core/json_cursor.hpp"
#include "host/scene/readers/spectrum_reader.hpp"
#include "host/scene/scene.hpp"

namespace stokes {

// The item with the name that stands at where; part is "media", "materials", ...
template <typename Named>
int index_of_name(const JsonCursor& where, const char* part, const std::vector<Named>& list);

std::vector<Medium> read_media(const JsonCursor& media, SpectrumReader& spectra);
std::vector<Fluorophore> read_fluorophores(const JsonCursor& fluorophores, SpectrumReader& spectra);
// scene.media and scene.fluorophores are read already.
std::vector<Material> read_materials(const JsonCursor& materials, SpectrumReader& spectra, const Scene& scene);

template <typename Named>
int index_of_name(const JsonCursor& where, const char* part, const std::vector<Named>& list) {
    const std::string& name = where.text();
    std::vector<std::string> names;
    for (const Named& item : list) {
        if (item.name == name) return static_cast<int>(names.size());
        names.push_back(item.name);
    }
    where.fail_undefined(part, names);
}

}  // namespace stokes
