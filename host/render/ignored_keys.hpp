// What a scene gives that has no effect on its render.
#pragma once

#include <string>
#include <vector>

#include "host/scene/scene.hpp"

namespace stokes {

// Lines for the person who wrote the scene: keys that no transport takes in which their object is rendered.
std::vector<std::string> ignored_keys(const Scene& scene);

// A line that names the materials, media, fluorophores and spectra that nothing in the picture uses, or nothing.
std::string unused_objects(const Scene& scene);

// The keys of one material of the scene, its medium and its fluorophores that this transport ignores.
std::vector<std::string> ignored_keys(const Scene& scene, const Material& material, Transport transport);

}  // namespace stokes
