// What a scene and the command line say of how it is rendered. host/scene/settings/settings.cpp declares every field:
// its key, its flag, its bounds, its default and what it does.
#pragma once

#include <cstdint>
#include <optional>

#include "host/core/words.hpp"

namespace stokes {

// Which subsurface transport the scene's translucent materials use: PHYSICS sections 3, 4 and 5.
enum class Transport { paper, conserving, walk };
template <>
inline const Words words_of<Transport> = {"paper", "conserving", "walk"};

// Which samplers a render has where it does not name them one by one: the plain ones, or those with the least noise.
enum class Sampling { plain, best };
template <>
inline const Words words_of<Sampling> = {"plain", "best"};

// How a pass draws its wavelengths: PHYSICS section 2.
enum class Wavelengths { uniform, importance };
template <>
inline const Words words_of<Wavelengths> = {"uniform", "importance"};

// Which light is stored where a photon enters a translucent material: that of the branch that was drawn, fluorescence
// or elastic scattering, or that of both.
enum class Branches { roulette, both };
template <>
inline const Words words_of<Branches> = {"roulette", "both"};

// How far from its entry light leaves is drawn as the paper has it, from the power table, or where more of it leaves,
// from the table's square, with weights; the mean is the same.
enum class Distances { table, importance };
template <>
inline const Words words_of<Distances> = {"table", "importance"};

// Where photons start: anywhere on the lights at random, evenly spread over them, or evenly and most where the camera
// sees their light.
enum class Emission { random, stratified, aimed };
template <>
inline const Words words_of<Emission> = {"random", "stratified", "aimed"};

// Where the light comes from that falls straight from the lights onto diffuse surfaces: from photons, or by shadow rays
// from what the camera sees.
enum class Direct { photons, rays };
template <>
inline const Words words_of<Direct> = {"photons", "rays"};

// The radius of the density estimate: one for the whole picture, or more where photons are few.
enum class Radii { one, local };
template <>
inline const Words words_of<Radii> = {"one", "local"};

inline constexpr std::int64_t most_photons_per_pass = 0x10000000;

// OrDefault<T> is std::optional<T> where nobody may have said it, T where every default has been put in.
template <template <class> class OrDefault>
struct SettingsOf {
    Transport transport = Transport::conserving;
    Sampling sampling = Sampling::best;
    int passes = 64;
    std::int64_t photons_per_pass = 262144;
    std::uint32_t seed = 1;
    double alpha = 2.0 / 3.0;
    std::optional<double> radius_mm;  // first radius; none: derived from the scene
    int lambda_min_nm = 300;          // inclusive
    int lambda_max_nm = 780;          // inclusive
    bool tables = true;
    bool first_collision_only = false;
    OrDefault<Wavelengths> wavelengths{};
    OrDefault<Branches> branches{};
    OrDefault<Distances> distances{};
    OrDefault<int> exits{};
    OrDefault<Emission> emission{};
    OrDefault<Direct> direct{};
    OrDefault<Radii> radii{};
};

template <class T>
using Itself = T;

using RenderSettings = SettingsOf<std::optional>;  // as given
using ResolvedSettings = SettingsOf<Itself>;       // as rendered

// With the defaults, which may depend on transport and sampling, in the place of what was not given, and of what the
// transport has not.
ResolvedSettings resolved(const RenderSettings& given);

}  // namespace stokes
