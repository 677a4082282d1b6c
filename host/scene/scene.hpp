// The scene as plain data, already checked, in world space. Lengths are millimetres, wavelengths nanometres.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "host/core/spectrum.hpp"
#include "host/scene/picture.hpp"

namespace stokes {

// A window of the picture, in fractions of its width and height from the top left corner.
struct Crop {
    double left = 0.0, top = 0.0;
    double width = 1.0, height = 1.0;
};

struct Camera {  // pinhole
    glm::dvec3 position_mm{0.0};
    glm::dvec3 target_mm{0.0, 0.0, -1.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
    double vertical_fov_deg = 40.0;  // of the whole picture
    Crop crop;                       // what the film shows of it
};

struct Film {
    int width = 512;                    // pixels
    int height = 512;                   // pixels
    std::optional<double> exposure_ev;  // of the PNG; none: automatic
};

// Which subsurface transport the scene's translucent materials use: PHYSICS sections 3, 4 and 5.
enum class Transport { paper, conserving, walk };
// As scene files and the command line spell them, in the order of Transport.
inline const std::vector<std::string> transport_words = {"paper", "conserving", "walk"};

// How a pass draws its wavelengths: PHYSICS section 2. As scene files and the command line spell them, in order.
enum class Wavelengths { uniform, importance };
inline const std::vector<std::string> wavelengths_words = {"uniform", "importance"};

// Which light is stored where a photon enters a translucent material: that of the branch that was drawn, fluorescence
// or elastic scattering, or that of both. As scene files and the command line spell them, in order.
enum class Branches { roulette, both };
inline const std::vector<std::string> branches_words = {"roulette", "both"};

// Where photons start: anywhere on the lights at random, evenly spread over them, or evenly and most where the camera
// sees their light. As scene files and the command line spell them, in order.
enum class Emission { random, stratified, aimed };
inline const std::vector<std::string> emission_words = {"random", "stratified", "aimed"};

// Where the light comes from that falls straight from the lights onto diffuse surfaces: from photons, or by shadow rays
// from what the camera sees. As scene files and the command line spell them, in order.
enum class Direct { photons, rays };
inline const std::vector<std::string> direct_words = {"photons", "rays"};

// Model `paper`: how far from its entry light leaves is drawn as the paper has it, from the power table, or where more
// of it leaves, from the table's square, with weights; the mean is the same. As scene files and the command line spell
// them, in order.
enum class Distances { table, importance };
inline const std::vector<std::string> distances_words = {"table", "importance"};

// The radius of the density estimate: one for the whole picture, or more where photons are few. As scene files and the
// command line spell them, in order.
enum class Radii { one, local };
inline const std::vector<std::string> radii_words = {"one", "local"};

// Which samplers a render has where it does not name them one by one: the plain ones, or those with the least noise.
enum class Sampling { plain, best };
inline const std::vector<std::string> sampling_words = {"plain", "best"};

inline constexpr std::int64_t most_photons_per_pass = 0x10000000;
inline constexpr int most_exits = 64;

struct RenderSettings {
    int passes = 64;
    std::int64_t photons_per_pass = 262144;
    double alpha = 2.0 / 3.0;
    std::optional<double> radius_mm;  // first radius; none: derived from the scene
    std::uint32_t seed = 1;
    int lambda_min_nm = 300;  // inclusive
    int lambda_max_nm = 780;  // inclusive
    Transport transport = Transport::conserving;
    bool tables = true;                 // paper: false: no power tables, every photon integrates eq. 3-5 itself
    bool first_collision_only = false;  // walk: fluorophores take light up at its first collision only
    Sampling sampling = Sampling::best;
    std::optional<Wavelengths> wavelengths;  // none: by sampling and transport
    std::optional<Branches> branches;        // none: by sampling and transport; void for walk
    std::optional<Emission> emission;        // none: by sampling
    std::optional<Direct> direct;            // none: by sampling
    std::optional<Radii> radii;              // none: by sampling
    std::optional<Distances> distances;      // paper, with tables; none: by sampling
    std::optional<int> exits;                // conserving: exit points an entry and component; none: by sampling
};

// By importance, unless plain samplers are asked for, or the model `paper`, whose wavelengths are uniform.
inline Wavelengths chosen_wavelengths(const RenderSettings& render) {
    const bool plain = render.sampling == Sampling::plain || render.transport == Transport::paper;
    return render.wavelengths.value_or(plain ? Wavelengths::uniform : Wavelengths::importance);
}

// Both with the model `conserving`, unless plain samplers are asked for.
inline Branches chosen_branches(const RenderSettings& render) {
    const bool plain = render.sampling == Sampling::plain || render.transport != Transport::conserving;
    return render.branches.value_or(plain ? Branches::roulette : Branches::both);
}

// Aimed, unless plain samplers are asked for.
inline Emission chosen_emission(const RenderSettings& render) {
    return render.emission.value_or(render.sampling == Sampling::plain ? Emission::random : Emission::aimed);
}

// By rays, unless plain samplers are asked for.
inline Direct chosen_direct(const RenderSettings& render) {
    return render.direct.value_or(render.sampling == Sampling::plain ? Direct::photons : Direct::rays);
}

// By importance, unless plain samplers are asked for; `table` where no power tables are.
inline Distances chosen_distances(const RenderSettings& render) {
    if (render.transport != Transport::paper || !render.tables) return Distances::table;
    return render.distances.value_or(render.sampling == Sampling::plain ? Distances::table : Distances::importance);
}

// One, unless others are asked for.
inline Radii chosen_radii(const RenderSettings& render) { return render.radii.value_or(Radii::one); }

// One but for the model `conserving`.
inline int chosen_exits(const RenderSettings& render) {
    return render.transport == Transport::conserving ? render.exits.value_or(1) : 1;
}

// sigma_s and sigma_a [1/mm] with the scene's scale factors already applied.
struct Medium {
    std::string name;
    Spectrum sigma_s;
    Spectrum sigma_a;
    double eta = 1.0;         // refractive index
    double dipole_eta = 1.0;  // refractive index in the dipole's A; 1 where the Fresnel factor is taken as 1
};

struct Fluorophore {
    std::string name;
    Spectrum excitation;         // relative
    Spectrum emission;           // relative
    double conversion = 2.0e-2;  // paper: eta of eq. 1 [1/nm]
    double quantum_yield = 1.0;  // conserving, walk: photons emitted for each taken up, in [0, 1]
};

struct BlackMaterial {};

struct DiffuseMaterial {
    Spectrum reflectance = Spectrum::constant(0.0);  // in [0, 1]
    // A picture without opacity, or none: reflectance + luminance (white - reflectance) where it lies.
    std::shared_ptr<const Picture> texture;
    Spectrum white = Spectrum::constant(0.0);  // in [0, 1]
};

// A fluorophore in a material.
struct Dye {
    int fluorophore = -1;   // index into Scene::fluorophores
    double fraction = 0.0;  // share of collisions that meet it, where its excitation is 1
};

struct TranslucentMaterial {
    std::optional<int> medium;  // index into Scene::media; none: light leaves where it came in
    std::vector<Dye> dyes;      // each fluorophore once; their fractions add up to c of PHYSICS section 3, at most 1
    bool fresnel = false;       // the surface reflects, outside and within; conserving, walk, with a medium
};

struct Material {
    std::string name;
    std::variant<BlackMaterial, DiffuseMaterial, TranslucentMaterial> kind;
};

inline const DiffuseMaterial* as_diffuse(const Material& material) {
    return std::get_if<DiffuseMaterial>(&material.kind);
}
inline const TranslucentMaterial* as_translucent(const Material& material) {
    return std::get_if<TranslucentMaterial>(&material.kind);
}

// The medium that light goes into below the surface, or none.
inline std::optional<int> medium_of(const Material& material) {
    const TranslucentMaterial* translucent = as_translucent(material);
    return translucent != nullptr ? translucent->medium : std::nullopt;
}
inline double fluorescent_fraction(const std::vector<Dye>& dyes) {
    return std::accumulate(dyes.begin(), dyes.end(), 0.0,
                           [](double sum, const Dye& dye) { return sum + dye.fraction; });
}
inline const Picture* texture_of(const Material& material) {
    const DiffuseMaterial* diffuse = as_diffuse(material);
    return diffuse != nullptr ? diffuse->texture.get() : nullptr;
}

struct Mesh {
    std::vector<glm::vec3> positions_mm;
    std::vector<glm::uvec3> triangles;  // counter-clockwise seen from outside
    // Of each triangle's corners, the picture's top left corner at (0, 0), bottom right at (1, 1); empty:
    // none.
    std::vector<std::array<glm::vec2, 3>> uv = {};
    std::string uv_fault =
        {};  // why the texture coordinates of its file cannot be used; empty: they can, or there are none
};

// Shapes with the same body exchange light below their surfaces: an exit point may lie on any of them.
struct Shape {
    std::string name;
    int material = -1;
    int body = -1;
    int light = -1;          // index into Scene::lights when this shape is the surface of an emitter
    bool two_sided = false;  // the back is like the front, else black; opaque materials only
    Mesh mesh;
};

// Diffuse emission from the front of a shape.
struct SurfaceLight {
    int shape = -1;  // index into Scene::shapes
};

// Parallel light through a flat cross-section at right angles to its direction.
struct Beam {
    glm::dvec3 position_mm{0.0};  // centre of the cross-section
    glm::dvec3 direction{0.0, -1.0, 0.0};
    glm::dvec3 half_u_mm{0.0}, half_v_mm{0.0};  // half-axes of the cross-section
};
struct DiskBeam : Beam {};       // the half-axes are two of its radii
struct RectangleBeam : Beam {};  // the half-axes are half of its sides

struct Light {
    std::string name;
    Spectrum flux;  // absolute spectral flux [W/nm], over the whole light
    std::variant<SurfaceLight, DiskBeam, RectangleBeam> kind;
};

struct Scene {
    std::string file;  // as given on the command line
    RenderSettings render;
    Film film;
    Camera camera;
    std::vector<Medium> media;
    std::vector<Fluorophore> fluorophores;
    std::vector<Material> materials;
    std::vector<Light> lights;
    std::vector<Shape> shapes;
    int body_count = 0;
};

}  // namespace stokes
