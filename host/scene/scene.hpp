// The scene as plain data, already checked, in world space about Scene::origin_mm. Lengths are millimetres, wavelengths
// nanometres.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "host/core/spectrum.hpp"
#include "host/scene/readers/picture.hpp"
#include "host/scene/settings/limited_key.hpp"
#include "host/scene/settings/render_settings.hpp"

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

// sigma_s and sigma_a [1/mm] with the scene's scale factors already applied.
struct Medium {
    std::string name;
    Spectrum sigma_s;
    Spectrum sigma_a;
    double eta = 1.0;         // refractive index
    double dipole_eta = 1.0;  // refractive index in the dipole's A; 1 where the Fresnel factor is taken as 1
    std::vector<LimitedKey> limited_keys = {};
};

// What becomes of an emission of which Stokes' law cuts off what lies at the exciting wavelength and below: what is
// left is brought back to the whole, so that the yield is the same at every exciting wavelength (Vavilov's law), or it
// is not.
enum class StokesRule { keep_yield, truncate };
template <>
inline const Words words_of<StokesRule> = {"keep_yield", "truncate"};

struct Fluorophore {
    std::string name;
    Spectrum excitation;         // probability, in [0, 1]
    Spectrum emission;           // relative, of any scale for a quantum yield; of a table whose maximum is 1 for paper
    double conversion = 2.0e-2;  // paper: eta of eq. 1 [1/nm]
    double quantum_yield = 1.0;  // conserving, walk: photons emitted for each taken up, in [0, 1]
    std::optional<StokesRule> stokes_rule;  // none: as the transport has it
    std::vector<LimitedKey> limited_keys = {};
};

struct BlackMaterial {};

// Where texture coordinates of a mesh are beyond 0 to 1.
enum class TextureWrap { repeat, clamp };
template <>
inline const Words words_of<TextureWrap> = {"repeat", "clamp"};

struct DiffuseMaterial {
    Spectrum reflectance = Spectrum::constant(0.0);  // in [0, 1]
    // A picture without opacity, or none: reflectance + luminance (white - reflectance) where it lies.
    std::shared_ptr<const Picture> texture;
    Spectrum white = Spectrum::constant(0.0);  // in [0, 1]
    TextureWrap wrap = TextureWrap::repeat;
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
    std::variant<BlackMaterial, DiffuseMaterial, TranslucentMaterial> kind = {};
    std::vector<LimitedKey> limited_keys = {};
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
    // Its texture is laid again and again, and filtered across its edges; else it ends at them.
    bool texture_repeats = false;
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
    std::string file;           // as given on the command line
    glm::dvec3 origin_mm{0.0};  // where in the file's coordinates all places below start from
    RenderSettings render;
    Film film;
    Camera camera;
    std::vector<Medium> media;
    std::vector<Fluorophore> fluorophores;
    std::vector<Material> materials;
    std::vector<Light> lights;
    std::vector<Shape> shapes;
    int body_count = 0;
    std::map<int, Transport> body_transports;  // of bodies whose light travels otherwise than the render says
    std::vector<std::string> unused_spectra;   // names that the file defines and nothing there uses
};

}  // namespace stokes
